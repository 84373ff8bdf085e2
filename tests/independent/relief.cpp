// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/relief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace aims::independent {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kStep =
    0.1 * Relief::kShortest;          ///< along a ray, within which heights hardly bend
constexpr double kResolution = 1e-9;  ///< of a hit, across the surface [m]

/// Share of the height at the next node, without a kink at either.
double blend(double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); }

/// Largest slope of `blend`, along both axes at once.
constexpr double kSteepestOfCell = 1.875 * std::numbers::sqrt2;

/// Mean over a cell of (1 - blend)^2 + blend^2: what interpolation leaves of a variance, per axis.
constexpr double kLeft = 181.0 / 231.0;

/// Cell of a coordinate and the place in it, 0 to 1; beyond the nodes heights stay as they are.
std::pair<Eigen::Index, double> cell_of(double coordinate, Eigen::Index nodes) {
  const auto cell = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(coordinate), 0, nodes - 2);
  return {cell, std::clamp(coordinate - static_cast<double>(cell), 0.0, 1.0)};
}

int first_axis(Side side) { return (side.axis + 1) % 3; }
int second_axis(Side side) { return (side.axis + 2) % 3; }

/// A place along a ray and how far before the surface it is, across it [m].
struct Place {
  double t = 0.0;
  double air = 0.0;
};

/// Where `air` falls through zero between a place in the air and one behind the surface.
template <typename Function>
double root(const Function& air, Place before, Place behind) {
  double t = behind.t;
  for (int i = 0; i < 20; ++i) {
    t = before.t + (behind.t - before.t) * before.air / (before.air - behind.air);
    const Place here{t, air(t)};
    if (std::abs(here.air) < kResolution) break;
    (here.air > 0.0 ? before : behind) = here;
  }
  return t;
}

}  // namespace

Relief::Relief(const Eigen::AlignedBox3d& room, double deviation, std::uint64_t seed)
    : room_(room) {
  RandomStream random(seed, "independent.relief");
  const double sum_of_spacings = kShortest * (1 + 2 + 4 + 8);
  for (int i = 0; i < 6; ++i) {
    const Side side{i / 2, i % 2 == 1};
    const Eigen::Vector2d corner(room.min()[first_axis(side)], room.min()[second_axis(side)]);
    const Eigen::Vector2d sizes(room.sizes()[first_axis(side)], room.sizes()[second_axis(side)]);
    double highest = 0.0;
    double steepest = 0.0;
    double spacing = kShortest;
    for (Lattice& lattice : sides_[i]) {
      lattice = Lattice(corner, sizes, spacing, random);
      const double most = lattice.scale(deviation * std::sqrt(spacing / sum_of_spacings) / kLeft);
      highest += most;
      steepest += kSteepestOfCell * 2.0 * most / spacing;
      spacing *= 2.0;
    }
    bound_ = std::max(bound_, highest);
    steepest_ = std::max(steepest_, steepest);
  }
}

Relief::Lattice::Lattice(const Eigen::Vector2d& corner, const Eigen::Vector2d& sizes,
                         double spacing, RandomStream& random)
    : spacing_(spacing) {
  origin_.x() = corner.x() - spacing * random.uniform();
  origin_.y() = corner.y() - spacing * random.uniform();
  const auto nodes = [&](double size) {
    return static_cast<Eigen::Index>(std::ceil(size / spacing)) + 2;
  };
  columns_ = nodes(sizes.x());
  heights_.resize(static_cast<std::size_t>(columns_ * nodes(sizes.y())));
  random.normal(heights_);
}

double Relief::Lattice::scale(double factor) {
  double most = 0.0;
  for (double& each : heights_) most = std::max(most, std::abs(each *= factor));
  return most;
}

double Relief::Lattice::height(double u, double v) const {
  const auto rows = static_cast<Eigen::Index>(heights_.size()) / columns_;
  const auto [column, along] = cell_of((u - origin_.x()) / spacing_, columns_);
  const auto [row, across] = cell_of((v - origin_.y()) / spacing_, rows);
  const double* node = heights_.data() + row * columns_ + column;
  const double a = blend(along);
  const double first = node[0] + a * (node[1] - node[0]);
  const double second = node[columns_] + a * (node[columns_ + 1] - node[columns_]);
  return first + blend(across) * (second - first);
}

double Relief::height(Side side, const Eigen::Vector3d& point) const {
  double sum = 0.0;
  for (const Lattice& each : of(side)) {
    sum += each.height(point[first_axis(side)], point[second_axis(side)]);
  }
  return sum;
}

/// The side whose plane is met first is tried first, so that the others are rarely searched.
double Relief::distance(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                        double reach) const {
  std::array<std::pair<double, Side>, 3> sides;
  for (int axis = 0; axis < 3; ++axis) {
    const bool upper = direction[axis] > 0.0;
    const double gap = (upper ? room_.max()[axis] : room_.min()[axis]) - origin[axis];
    sides[axis] = {direction[axis] == 0.0 ? kFar : gap / direction[axis], {axis, upper}};
  }
  std::ranges::sort(sides, {}, &std::pair<double, Side>::first);
  double nearest = reach;
  for (const auto& [unused, side] : sides) {
    nearest = std::min(nearest, distance_to(side, origin, direction, nearest));
  }
  return nearest < reach ? nearest : kFar;
}

/// A grazing ray may pass behind a hill, so all of the way within the bound is searched, in steps
/// that cannot pass through a hill or are short.
double Relief::distance_to(Side side, const Eigen::Vector3d& origin,
                           const Eigen::Vector3d& direction, double limit) const {
  const double rate = std::abs(direction[side.axis]);
  if (rate == 0.0) return kFar;
  const double gap = side.upper ? room_.max()[side.axis] - origin[side.axis]
                                : origin[side.axis] - room_.min()[side.axis];
  const auto air = [&](double t) { return gap - rate * t + height(side, origin + t * direction); };
  const double first = std::max(0.0, (gap - bound_) / rate);
  if (!(first < limit)) return kFar;
  Place here{first, air(first)};
  while (here.t < limit) {
    const double t = here.t + std::max(kStep, here.air / (rate + steepest_));
    const Place next{t, air(t)};
    if (next.air <= 0.0) return root(air, here, next);
    here = next;
  }
  return kFar;
}

}  // namespace aims::independent
