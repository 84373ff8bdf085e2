// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/environment/surface_relief.hpp"

namespace aims {
namespace {

constexpr int kWaves = 160;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kColumns = SurfaceTable::kColumns;
constexpr int kRows = SurfaceTable::kRows;
constexpr double kCell = 0.04;  ///< [m]
constexpr float kLargest = 32767.0F;
constexpr float kPerCell = 1.0F / SurfaceTable::kCell;

using Lanes = SurfaceTable::Lanes;

/// cos and sin of 2 pi k / n.
struct Circle {
  explicit Circle(int n) : cosine(n), sine(n) {
    for (int k = 0; k < n; ++k) {
      cosine[k] = std::cos(kTurn * k / n);
      sine[k] = std::sin(kTurn * k / n);
    }
  }
  std::vector<double> cosine;
  std::vector<double> sine;
};

/// amplitude cos and sin of 2 pi cycles i / n + phase at the nodes i; n is a power of two.
struct Harmonic {
  Harmonic(const Circle& circle, int cycles, double amplitude, double phase)
      : cosine(circle.cosine.size()), sine(circle.cosine.size()) {
    const double c = amplitude * std::cos(phase);
    const double s = amplitude * std::sin(phase);
    const auto n = static_cast<int>(circle.cosine.size());
    for (int i = 0; i < n; ++i) {
      const int k = (cycles * i) & (n - 1);
      cosine[i] = static_cast<float>(c * circle.cosine[k] - s * circle.sine[k]);
      sine[i] = static_cast<float>(s * circle.cosine[k] + c * circle.sine[k]);
    }
  }
  std::vector<float> cosine;
  std::vector<float> sine;
};

/// A plane wave: cos(columns + rows).
struct Wave {
  Harmonic columns;
  Harmonic rows;
};

/// Sum of the waves at the nodes, row by row; a part of the columns at a time stays in the cache.
std::vector<float> sum_of(const std::vector<Wave>& waves, float scale) {
  constexpr int kPart = 64;
  std::vector<float> nodes(static_cast<std::size_t>(kColumns) * kRows);
  for (int first = 0; first < kColumns; first += kPart) {
    for (int row = 0; row < kRows; ++row) {
      std::array<float, kPart> sum{};
      for (const Wave& wave : waves) {
        const float* cosine = wave.columns.cosine.data() + first;
        const float* sine = wave.columns.sine.data() + first;
        const float c = wave.rows.cosine[row];
        const float s = wave.rows.sine[row];
        for (int i = 0; i < kPart; ++i) sum[i] += cosine[i] * c - sine[i] * s;
      }
      float* node = nodes.data() + static_cast<std::size_t>(row) * kColumns + first;
      for (int i = 0; i < kPart; ++i) node[i] = scale * sum[i];
    }
  }
  return nodes;
}

/// Nodes of a Gaussian field of zero mean, row by row.
std::vector<float> gaussian_field(double deviation, const SurfaceConfig& config,
                                  RandomStream random) {
  if (deviation == 0.0) return std::vector<float>(static_cast<std::size_t>(kColumns) * kRows);
  const Circle around_u(kColumns);
  const Circle around_v(kRows);
  std::vector<Wave> waves;
  double variance = 0.0;
  for (int i = 0; i < kWaves; ++i) {
    const double length =
        config.shortest * std::pow(config.longest / config.shortest, random.uniform());
    const double direction = random.uniform(0.0, kTurn);
    const double phase = random.uniform(0.0, kTurn);
    // Whole waves around, so that the field is periodic.
    const auto along =
        static_cast<int>(std::lround(kColumns * kCell / length * std::cos(direction)));
    const auto up = static_cast<int>(std::lround(kRows * kCell / length * std::sin(direction)));
    const double amplitude = std::sqrt(length);
    if (along == 0 && up == 0) continue;
    variance += 0.5 * amplitude * amplitude;
    waves.push_back({{around_u, along, amplitude, phase}, {around_v, up, 1.0, 0.0}});
  }
  return sum_of(waves, static_cast<float>(deviation / std::sqrt(variance)));
}

float largest_of(const std::vector<float>& nodes) {
  float largest = 0.0F;
  for (const float node : nodes) largest = std::max(largest, std::abs(node));
  return largest;
}

/// The first nodes of the cells of sixteen points, and where the points lie in them, in [0, 1].
void cells_of(const Lanes& u, const Lanes& v, std::array<std::int32_t, kRayPacketSize>& node,
              Lanes& s, Lanes& t) {
  static_assert((kColumns & (kColumns - 1)) == 0 && (kRows & (kRows - 1)) == 0);
  for (int i = 0; i < kRayPacketSize; ++i) {
    const float x = u[i] * kPerCell;
    const float y = v[i] * kPerCell;
    auto left = static_cast<std::int32_t>(x);  // towards zero
    auto below = static_cast<std::int32_t>(y);
    left -= static_cast<float>(left) > x ? 1 : 0;
    below -= static_cast<float>(below) > y ? 1 : 0;
    s[i] = x - static_cast<float>(left);
    t[i] = y - static_cast<float>(below);
    const std::int32_t row = below & (kRows - 1);
    node[i] = row * kColumns + row + (left & (kColumns - 1));
  }
}

/// In units of the table.
float height_of(std::int32_t texel) {
  return static_cast<float>(static_cast<std::int32_t>(static_cast<std::uint32_t>(texel) << 16U) >>
                            16);
}

/// In units of the table.
float factor_of(std::int32_t texel) { return static_cast<float>(texel >> 16); }

}  // namespace

SurfaceTable::SurfaceTable(const SurfaceConfig& config, std::uint64_t seed) {
  const std::vector<float> heights =
      gaussian_field(config.relief, config, rng(seed, "scene.relief"));
  std::vector<float> factors = gaussian_field(config.texture, config, rng(seed, "scene.texture"));
  for (float& factor : factors) factor = std::exp(factor);
  height_unit_ = std::max(largest_of(heights), 1e-9F) / kLargest;
  factor_unit_ = largest_of(factors) / kLargest;
  texels_.resize(static_cast<std::size_t>(kStride) * (kRows + 1));
  for (int row = 0; row <= kRows; ++row) {
    for (int column = 0; column <= kColumns; ++column) {
      const std::size_t node = static_cast<std::size_t>(row % kRows) * kColumns + column % kColumns;
      const auto height = static_cast<std::int16_t>(std::lround(heights[node] / height_unit_));
      const auto factor = static_cast<std::uint16_t>(std::lround(factors[node] / factor_unit_));
      texels_[static_cast<std::size_t>(row) * kStride + column] =
          static_cast<std::uint32_t>(factor) << 16U | static_cast<std::uint16_t>(height);
    }
  }
}

void SurfaceTable::sample(const Lanes& u, const Lanes& v, Samples& samples) const {
  alignas(64) std::array<std::int32_t, kRayPacketSize> node, a, b, c, d;
  alignas(64) Lanes s, t;
  cells_of(u, v, node, s, t);
  for (int i = 0; i < kRayPacketSize; ++i) {
    const std::uint32_t* texel = texels_.data() + node[i];
    a[i] = static_cast<std::int32_t>(texel[0]);
    b[i] = static_cast<std::int32_t>(texel[1]);
    c[i] = static_cast<std::int32_t>(texel[kStride]);
    d[i] = static_cast<std::int32_t>(texel[kStride + 1]);
  }
  for (int i = 0; i < kRayPacketSize; ++i) {
    const float h_a = height_of(a[i]), h_c = height_of(c[i]);
    const float lower = height_of(b[i]) - h_a;
    const float upper = height_of(d[i]) - h_c;
    const float below = h_a + s[i] * lower;
    const float rise = h_c + s[i] * upper - below;
    samples.height[i] = height_unit_ * (below + t[i] * rise);
    samples.slope_u[i] = height_unit_ * kPerCell * (lower + t[i] * (upper - lower));
    samples.slope_v[i] = height_unit_ * kPerCell * rise;
    const float f_a = factor_of(a[i]), f_c = factor_of(c[i]);
    const float near = f_a + s[i] * (factor_of(b[i]) - f_a);
    const float far = f_c + s[i] * (factor_of(d[i]) - f_c);
    samples.factor[i] = factor_unit_ * (near + t[i] * (far - near));
  }
}

}  // namespace aims
