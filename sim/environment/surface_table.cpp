// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
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

/// sin and cos of 2 pi `cycles` i / n + `phase` at the nodes i, times `amplitude`.
struct Harmonic {
  Harmonic(int cycles, int n, double amplitude, double phase) : cosine(n), sine(n) {
    for (int i = 0; i < n; ++i) {
      const double angle = kTurn * cycles * i / n + phase;
      cosine[i] = static_cast<float>(amplitude * std::cos(angle));
      sine[i] = static_cast<float>(amplitude * std::sin(angle));
    }
  }
  std::vector<float> cosine;
  std::vector<float> sine;
};

/// Nodes of a Gaussian field of zero mean, row by row.
std::vector<float> gaussian_field(double deviation, const SurfaceConfig& config,
                                  RandomStream random) {
  std::vector<float> nodes(static_cast<std::size_t>(kColumns) * kRows, 0.0F);
  if (deviation == 0.0) return nodes;
  double variance = 0.0;
  for (int wave = 0; wave < kWaves; ++wave) {
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
    const Harmonic columns(along, kColumns, amplitude, phase);
    const Harmonic rows(up, kRows, 1.0, 0.0);
    for (int row = 0; row < kRows; ++row) {
      float* node = nodes.data() + static_cast<std::size_t>(row) * kColumns;
      for (int i = 0; i < kColumns; ++i) {
        node[i] += columns.cosine[i] * rows.cosine[row] - columns.sine[i] * rows.sine[row];
      }
    }
  }
  const auto scale = static_cast<float>(deviation / std::sqrt(variance));
  for (float& node : nodes) node *= scale;
  return nodes;
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
