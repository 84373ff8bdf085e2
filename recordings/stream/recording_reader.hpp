// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/lidar_rings.hpp"
#include "core/measurements.hpp"
#include "core/trajectory.hpp"
#include "recordings/bag/chunk_reader.hpp"
#include "recordings/reading_notes.hpp"
#include "recordings/recording_config.hpp"

namespace aims {

/// How the recording is read: decided once, from its start.
struct RecordingSetup {
  TopicsConfig topics;  ///< as used; empty: none
  SensorRig rig;
  bool has_legs = false;
  bool has_joints = false;       ///< of the legs, and contacts of the feet
  bool has_point_times = false;  ///< else they are derived from the azimuths
  LidarRings rings;              ///< of the points, as rows or derived; none: lines
  bool has_orientation = false;  ///< of the IMU
  bool has_truth = false;
  std::optional<double> imu_rate_hz;  ///< from the first stamps
  std::optional<double> leg_rate_hz;  ///< as for the IMU
  /// Assumptions and conversions, one sentence each: "IMU in g: multiplied by 9.80665".
  std::vector<std::string> notes;
  /// Assumptions that decide the result, and faults that spoil it; what changes midway is added.
  std::vector<ReadingWarning> warnings;
  std::map<std::string, StampFault>
      stamp_faults;               ///< by topic, where stamps do not serve as they are
  std::string leg_lack;           ///< why there are no legs, as far as it is known
  bool contacts_unknown = false;  ///< of legs that lack: the loads of the feet tell none yet
};

/// Error when there are no legs, which `estimator` needs. `naming` is how a topic of legs is named,
/// such as "--topics leg_odometry=/...".
Result<void> check_legs(const RecordingSetup& setup, const std::string& estimator,
                        const std::string& naming);

/// A recording as the stream of an estimator: messages become deliveries, in order of record time.
/// Stamps are those of the message headers, arrivals the record times. Memory is bounded by the
/// bag's chunks, not by its length.
class RecordingReader {
 public:
  /// Decides topics, units and extrinsics from the start of the bag. Errors list the existing
  /// topics when one is missing or ambiguous.
  static Result<RecordingReader> open(const std::filesystem::path& bag,
                                      const RecordingConfig& config, BagOpenOptions options = {});
  /// The same from any source of messages.
  static Result<RecordingReader> open(std::unique_ptr<MessageSource> source,
                                      const RecordingConfig& config);
  RecordingReader(RecordingReader&&) noexcept;
  RecordingReader& operator=(RecordingReader&&) noexcept;
  ~RecordingReader();

  const RecordingSetup& setup() const;
  const BagSummary& summary() const;

  /// Appends the deliveries of the next `span` of record time. False once the bag has ended.
  /// Poor data (an empty cloud, NaN, repeated stamps) is counted; a broken bag is an error.
  Result<bool> advance(Duration span, std::vector<Delivery>& deliveries);

  /// Record time of the last message read, since the start of the bag.
  Duration position() const;

  /// True poses of the body (IMU frame) read so far; stamps as those of deliveries.
  const Trajectory& truth() const;

  /// Removes and returns them, so that they need no memory.
  Trajectory take_truth();

  /// Counts of irregularities: "cloud_points_not_finite", "imu_stamp_not_increasing", ...
  const std::map<std::string, int>& counts() const;

 private:
  struct Impl;
  explicit RecordingReader(std::unique_ptr<Impl> impl);
  /// `recorded`: not live; record times may run at another rate than the stamps.
  static Result<RecordingReader> open_source(std::unique_ptr<MessageSource> bag,
                                             const RecordingConfig& config, bool recorded);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
