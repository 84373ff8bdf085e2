// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"
#include "recordings/event_counts.hpp"
#include "recordings/legs/foot_differences.hpp"
#include "recordings/legs/joint_rates.hpp"
#include "recordings/legs/leg_check.hpp"
#include "recordings/legs/leg_messages.hpp"
#include "recordings/legs/twist_check.hpp"

namespace aims {

/// The upward direction from an IMU: propagated by its gyro, corrected towards the specific force.
class UpDirection {
 public:
  void add(const ImuSample& sample);
  /// Unit vector in body axes; nothing before the first sample.
  const std::optional<Eigen::Vector3d>& in_body() const { return up_; }

 private:
  std::optional<Eigen::Vector3d> up_;
  Time stamp_ = 0;
};

/// Source of leg odometry.
enum class LegSource { kNone, kOdometry, kTwist, kKinematics, kFeet };

struct LegStreamConfig {
  LegSource source = LegSource::kNone;
  Duration half_period = 0;  ///< messages no farther apart than this belong to one instant
  /// Joints wait so long for contacts of their instant that arrive later, by their own stamps.
  Duration contact_wait = 0;
  bool contacts_on_change = false;  ///< contacts hold until the next ones, however long
  Pose T_body_base;
  LegGeometry geometry;
  FootModel foot_model = FootModel::kPoint;
  std::array<bool, kLegCount> without_contacts{};  ///< feet whose loads tell none, as is said
};

/// Converts the messages of a robot's legs to leg odometry samples. Messages come in the order of
/// the recording; each call returns the sample that it completes.
class LegStream {
 public:
  explicit LegStream(const LegStreamConfig& config);

  void add_imu(const ImuSample& sample);
  LegOdometrySample add_odometry(LegOdometrySample sample, EventCounts& counts);
  /// A sample without a pose: the pose is integrated.
  LegOdometrySample add_twist(LegOdometrySample sample);
  std::optional<LegOdometrySample> add_joints(JointReading reading, EventCounts& counts);
  /// Feet without joints; contacts of the same instant come first.
  std::optional<LegOdometrySample> add_feet(FeetReading reading, EventCounts& counts);
  std::optional<LegOdometrySample> add_contacts(const ContactReading& reading, EventCounts& counts);
  /// A further sample that the last call of these completed: of joints that waited with others.
  std::optional<LegOdometrySample> next(EventCounts& counts);
  /// How legs and IMU contradict each other so far.
  std::vector<ReadingWarning> warnings() const;

 private:
  /// Joints of an instant whose contacts may still come.
  struct WaitingJoints {
    JointReading reading;
    std::optional<ImuSample> imu;  ///< the last one when they came
    Time before = 0;               ///< stamp of the joints before them
  };
  bool same_instant(Time a, Time b) const;
  void attach(LegOdometrySample& sample) const;
  void fill_twist(LegOdometrySample& sample, EventCounts& counts);
  void integrate(LegOdometrySample& sample);
  void fill_pose(LegOdometrySample& sample, EventCounts& counts);
  bool lacks_rates(const JointReading& reading) const;
  void keep_unknown(JointReading& reading, EventCounts& counts) const;
  void differentiate(JointReading& reading, EventCounts& counts);
  bool difference_feet(FeetReading& reading, std::array<bool, kLegCount>& contact,
                       EventCounts& counts);
  const ContactReading* contacts_at(Time stamp) const;
  bool is_due(const JointReading& joints) const;
  std::array<bool, kLegCount> usable_contacts(const JointReading& joints,
                                              const ContactReading& contacts, Time before) const;
  std::optional<LegOdometrySample> forward_kinematics(const WaitingJoints& waiting,
                                                      EventCounts& counts);
  std::optional<LegOdometrySample> finish(LegOdometrySample sample, const Eigen::Vector3d& sum,
                                          int feet, EventCounts& counts);
  void check_imu(const ImuSample& sample);
  bool has_contacts(const std::optional<ImuSample>& imu, const ContactReading* contacts, Time stamp,
                    EventCounts& counts) const;
  std::optional<Eigen::Vector3d> up_in_base() const;

  LegStreamConfig config_;
  UpDirection up_;
  TwistCheck twist_check_;
  JointRateCheck rate_check_;
  LegCheck check_;
  FootDifferences differences_;
  std::optional<ImuSample> imu_;
  std::optional<JointReading> joints_;
  std::optional<std::pair<FeetReading, std::array<bool, kLegCount>>> feet_;  ///< the last ones
  std::optional<ContactReading> contacts_;
  std::deque<ContactReading> recent_contacts_;     ///< in the order of the recording
  Time stamp_before_ = 0;                          ///< of the joints before the last ones
  std::deque<WaitingJoints> waiting_;              ///< for contacts of the same instant
  std::optional<std::pair<Time, Pose>> odometry_;  ///< the last one
  std::optional<Eigen::Vector3d> first_position_;  ///< of the odometry
  bool pose_moves_ = false;
  std::optional<Time> pose_by_twist_;                  ///< since when
  Eigen::Vector3d unmoved_ = Eigen::Vector3d::Zero();  ///< by the twist until then [m]
  bool rates_seen_ = false;                            ///< of joints, other than 0
  bool speeds_seen_ = false;                           ///< of feet, likewise
  std::optional<Time> integrated_;
  Pose T_odom_base_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< from the last feet in contact [m/s]
  std::optional<Time> last_contact_;                    ///< of any foot
};

}  // namespace aims
