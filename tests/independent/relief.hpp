// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "core/random.hpp"

namespace aims::independent {

/// A side of a room: where `axis` has its least or its largest value.
struct Side {
  int axis = 0;
  bool upper = false;
};

/// Uneven plaster on the six sides of a room. On each, heights at the nodes of four lattices of its
/// own are drawn and interpolated; the deviation of a lattice grows with the root of its spacing.
class Relief {
 public:
  static constexpr double kShortest = 0.2;  ///< spacing of nodes [m]; the others: twice the former

  /// Standard deviation of the heights [m].
  Relief(const Eigen::AlignedBox3d& room, double deviation, std::uint64_t seed);

  /// How far behind the plane of that side, seen from the room, its surface is at a point [m].
  double height(Side side, const Eigen::Vector3d& point) const;

  /// No height is larger [m].
  double bound() const { return bound_; }

  /// Distance [m] from `origin` in the air of the room along the unit `direction` to the first
  /// surface; infinite when that is beyond `reach`.
  double distance(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  double reach) const;

 private:
  /// Square cells with a height at each node.
  class Lattice {
   public:
    Lattice() = default;
    /// Over a rectangle, with heights of deviation 1.
    Lattice(const Eigen::Vector2d& corner, const Eigen::Vector2d& sizes, double spacing,
            RandomStream& random);

    /// Returns the largest that is left.
    double scale(double factor);
    double height(double u, double v) const;

   private:
    Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
    double spacing_ = 1.0;
    Eigen::Index columns_ = 0;
    std::vector<double> heights_;  ///< row by row
  };
  using Lattices = std::array<Lattice, 4>;

  const Lattices& of(Side side) const { return sides_[2 * side.axis + (side.upper ? 1 : 0)]; }
  double distance_to(Side side, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                     double limit) const;

  Eigen::AlignedBox3d room_;
  std::array<Lattices, 6> sides_;
  double bound_ = 0.0;
  double steepest_ = 0.0;  ///< no slope is larger
};

}  // namespace aims::independent
