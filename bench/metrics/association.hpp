// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/trajectory.hpp"

namespace aims {

/// Estimated and true pose of the body at one instant, each in its own fixed frame.
struct PosePair {
  Time stamp = 0;  ///< of the estimated pose
  Pose estimate;   ///< T_odom_body
  Pose truth;      ///< T_world_body
};

/// Rule for pairs of estimated and true poses.
enum class Association {
  kInterpolated,  ///< truth interpolated at the estimate's stamps (inside the truth's span)
  kNearest,       ///< evo's rule: each stamp of the shorter takes the nearest of the longer
  kAtTruth,       ///< estimate interpolated at the truth's stamps, for a truth of few points
};

/// Pairs of poses in order of time. With `kNearest`, `tolerance` is the largest difference of
/// stamps, a tie goes to the earlier pose, trajectories of equal length let the estimate choose,
/// and a pose of the longer trajectory may serve twice, all as in evo. With `kAtTruth`, it is the
/// longest time between the estimated poses that are interpolated.
std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth,
                                Association association, Duration tolerance);

/// A stretch of time without truth.
struct TruthGap {
  Time begin = 0;
  Time end = 0;
};

/// The intervals between consecutive true poses that are longer than `longest`, in order.
std::vector<TruthGap> gaps_in(const Trajectory& truth, Duration longest);

/// How much of the time from `begin` to `end` lies in the gaps.
Duration time_in(std::span<const TruthGap> gaps, Time begin, Time end);

/// The pairs that do not lie inside a gap, where the truth is no measurement.
std::vector<PosePair> outside(std::span<const TruthGap> gaps, std::vector<PosePair> pairs);

/// Median distance in time from the estimate's poses inside the truth's span to the nearest true
/// pose; none when there is no such pose. Stamps of both increase.
std::optional<Duration> median_stamp_difference(const Trajectory& estimate,
                                                const Trajectory& truth);

/// Whether the pose is finite, within 1000 km of the origin and its quaternion of unit norm (1e-3).
bool is_valid(const Pose& pose);

/// The valid poses whose stamps increase; the others are left out.
Trajectory valid_part(const Trajectory& trajectory);

/// The same without a copy where all of them are; the trajectory must outlive it.
class ValidPart {
 public:
  explicit ValidPart(const Trajectory& trajectory);
  const Trajectory& poses() const { return whole_ != nullptr ? *whole_ : part_; }

 private:
  const Trajectory* whole_ = nullptr;
  Trajectory part_;
};

}  // namespace aims
