// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/surface_relief.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aims {
namespace {

constexpr int kWaves = 160;
/// At smaller angles between ray and surface the relief would shade itself; hits then move as at
/// this cosine of the incidence.
constexpr float kLeastCosine = 0.03F;
constexpr double kTurn = 2.0 * std::numbers::pi;

/// sin and cos of 2 pi `cycles` i / n at the nodes i, times `amplitude`, shifted by `phase`.
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

}  // namespace

PeriodicField::PeriodicField(double deviation, double shortest, double longest,
                             RandomStream random) {
  if (deviation == 0.0) return;
  nodes_.resize(static_cast<std::size_t>(kColumns) * kRows, 0.0F);
  double variance = 0.0;
  for (int wave = 0; wave < kWaves; ++wave) {
    const double length = shortest * std::pow(longest / shortest, random.uniform());
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
      float* node = nodes_.data() + static_cast<std::size_t>(row) * kColumns;
      for (int i = 0; i < kColumns; ++i) {
        node[i] += columns.cosine[i] * rows.cosine[row] - columns.sine[i] * rows.sine[row];
      }
    }
  }
  const auto scale = static_cast<float>(deviation / std::sqrt(variance));
  for (float& node : nodes_) node *= scale;
}

PeriodicField::Sample PeriodicField::at(float u, float v) const {
  if (nodes_.empty()) return {};
  static_assert((kColumns & (kColumns - 1)) == 0 && (kRows & (kRows - 1)) == 0);
  const float x = u / kCell;
  const float y = v / kCell;
  const float left = std::floor(x);
  const float below = std::floor(y);
  const float s = x - left;
  const float t = y - below;
  const int i = static_cast<int>(left) & (kColumns - 1);
  const int j = static_cast<int>(below) & (kRows - 1);
  const float* lower = nodes_.data() + static_cast<std::size_t>(j) * kColumns;
  const float* upper = nodes_.data() + static_cast<std::size_t>((j + 1) & (kRows - 1)) * kColumns;
  const int next = (i + 1) & (kColumns - 1);
  const float a = lower[i], b = lower[next], c = upper[i], d = upper[next];
  return {(1.0F - t) * (a + s * (b - a)) + t * (c + s * (d - c)),
          ((1.0F - t) * (b - a) + t * (d - c)) / kCell,
          ((1.0F - s) * (c - a) + s * (d - b)) / kCell};
}

SurfaceRelief::SurfaceRelief(const SurfaceConfig& config, const Scene& scene, std::uint64_t seed)
    : heights_(config.relief, config.shortest, config.longest, rng(seed, "scene.relief")),
      texture_(config.texture, config.shortest, config.longest, rng(seed, "scene.texture")) {
  RandomStream offsets = rng(seed, "scene.relief.offsets");
  const auto add = [&](const Eigen::Matrix3d& R, const Eigen::Vector3d& half_extents, bool smooth) {
    Box box;
    box.smooth = smooth;
    box.axes = R.cast<float>();
    for (int normal = 0; normal < 3; ++normal) {
      int u = (normal + 1) % 3;
      int v = (normal + 2) % 3;
      if (half_extents[v] > half_extents[u]) std::swap(u, v);  // u is the longer side
      box.faces[normal] = {
          box.axes.col(u), box.axes.col(v),
          static_cast<float>(offsets.uniform(0.0, PeriodicField::kColumns) * PeriodicField::kCell),
          static_cast<float>(offsets.uniform(0.0, PeriodicField::kRows) * PeriodicField::kCell)};
    }
    boxes_.push_back(box);
  };
  for (const Solid& solid : scene.solids) {
    add(solid.T_world_solid.R(), solid.half_extents,
        solid.shape != Shape::kBox || solid.material.return_cosine > 0.0);
  }
  const Eigen::Vector2d size = scene.floor.max_corner - scene.floor.min_corner;
  add(Eigen::Matrix3d::Identity(), {size.x(), size.y(), 0.0}, false);
}

const SurfaceRelief::Face& SurfaceRelief::face_of(const Box& box,
                                                  const Eigen::Vector3f& normal) const {
  Eigen::Index face = 0;
  (box.axes.transpose() * normal).cwiseAbs().maxCoeff(&face);
  return box.faces[static_cast<std::size_t>(face)];
}

SurfaceRelief::Moved SurfaceRelief::moved(const Hit& hit) const {
  const Box& box = boxes_[static_cast<std::size_t>(hit.surface)];
  if (box.smooth) return {0.0F, hit.normal, 1.0F};
  const Face& face = face_of(box, hit.normal);
  const float u = face.u.dot(hit.point) + face.offset_u;
  const float v = face.v.dot(hit.point) + face.offset_v;
  // A step along the ray changes the distance to the relief by cosine and slope.
  const PeriodicField::Sample first = heights_.at(u, v);
  const float along_u = face.u.dot(hit.direction);
  const float along_v = face.v.dot(hit.direction);
  const float cosine = -hit.normal.dot(hit.direction);
  const auto step_of = [&](float height, const PeriodicField::Sample& at) {
    return -height / std::max(cosine + at.slope_u * along_u + at.slope_v * along_v, kLeastCosine);
  };
  float farther = step_of(first.value, first);
  const PeriodicField::Sample at = heights_.at(u + farther * along_u, v + farther * along_v);
  farther += step_of(at.value + farther * cosine, at);
  const Eigen::Vector3f tilted =
      (hit.normal - at.slope_u * face.u - at.slope_v * face.v).normalized();
  const bool faces_ray = -tilted.dot(hit.direction) > kLeastCosine;
  return {farther, faces_ray ? tilted : hit.normal, std::exp(texture_.at(u, v).value)};
}

}  // namespace aims
