// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/lie.hpp"
#include "core/time.hpp"
#include "estimator/lidar/four_points.hpp"
#include "estimator/lidar/range_image.hpp"

namespace aims {

/// Finds returns on things that move, such as people, by comparing a scan with those half a second
/// and one second before it. Where something moved,
///
/// - present returns lie where an earlier scan passed (it came there), or
/// - earlier returns lie where the present scan passes (it went away).
///
/// Around such places every return is left out that the earlier scans do not confirm. Each alone
/// would not do: what walks away hides where it will be. Where nothing moves, nothing is left out.
class DynamicPoints {
 public:
  /// `lever`: the LiDAR in body axes [m].
  explicit DynamicPoints(const Eigen::Vector3d& lever);

  /// Compares a scan that ended at `stamp` with the earlier ones. `points`: its returns, evenly
  /// over its directions, in body axes at its end; `T_odom_body`: the predicted pose.
  void compare(const PointBlocks& points, Time stamp, const Pose& T_odom_body);

  /// Removes from `points` (body axes) of that scan those that may move. Returns how many.
  int remove_from(std::vector<Eigen::Vector3f>& points) const;

  /// Keeps that scan, at its corrected pose, for the comparison with later ones.
  void keep(const Pose& T_odom_body);

  /// Forgets all scans that were kept.
  void forget() { past_.clear(); }

 private:
  /// An earlier scan.
  struct Past {
    Time stamp = 0;
    RangeImage image;
    Pose T_odom_lidar;  ///< with the axes of the body
  };
  /// One that the present scan is compared with.
  struct Reference {
    const Past* past;
    Eigen::Matrix3f R_past_now;
    Eigen::Vector3f t_past_now;

    FourPoints to_past(const FourPoints& points) const {
      return points.transformed(R_past_now, t_past_now);
    }
    FourPoints to_now(const FourPoints& points) const {
      return points.minus(t_past_now).transformed(R_past_now.transpose(), Eigen::Vector3f::Zero());
    }
  };

  /// Votes of returns by upright columns around the robot, in body axes.
  class Columns {
   public:
    Columns() : cells_(static_cast<std::size_t>(kSide * kSide), 0) {}
    void clear();
    /// Those of `points` whose bits in `lanes` are set vote.
    void vote(const FourPoints& points, unsigned lanes);
    /// Marks the columns within `reach` columns of those with enough votes.
    void mark_around(int reach, Columns& marks) const;
    bool any() const { return !used_.empty(); }
    bool marked(const Eigen::Vector3f& point) const;

   private:
    static constexpr int kSide = 128;
    static float min_votes(int x, int y);
    static int cell_of(const Eigen::Vector3f& point);
    void add(int cell);
    std::vector<std::uint8_t> cells_;
    std::vector<int> used_;  ///< cells that are not zero
  };

  Pose lidar_pose(const Pose& T_odom_body) const;
  void find_references();
  unsigned came(const FourPoints& points) const;
  bool confirmed(const Eigen::Vector3f& point) const;

  Eigen::Vector3d lever_;
  std::vector<Past> past_;  ///< oldest first
  Past now_;
  std::vector<Reference> references_;
  PointBlocks from_lidar_;
  Columns came_;
  Columns went_;
  Columns marks_;  ///< around both
};

}  // namespace aims
