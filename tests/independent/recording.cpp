// SPDX-License-Identifier: BSD-3-Clause
#include "tests/independent/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "core/files/tum.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/stream/recording_writer.hpp"
#include "tests/independent/cells.hpp"
#include "tests/independent/inertial.hpp"
#include "tests/independent/legs.hpp"
#include "tests/independent/lidar.hpp"

namespace aims::independent {
namespace {

namespace fs = std::filesystem;

constexpr Duration kTruthPeriod = 10 * kMillisecond;
constexpr Duration kImuDelay = 2 * kMillisecond;
constexpr Duration kLegDelay = 3 * kMillisecond;
constexpr Duration kLidarDelay = 12 * kMillisecond;  ///< after the end of the scan
constexpr double kMinLength = 2.0;                   ///< [m]
constexpr double kMaxLength = 1000.0;                ///< [m]

/// One recording while it is written, in order of arrival.
class Recorder {
 public:
  Recorder(RecordingWriter writer, const Walk& walk, std::vector<Delivery> deliveries)
      : writer_(std::move(writer)), walk_(walk), deliveries_(std::move(deliveries)) {}

  /// Truth, IMU and legs up to then.
  Result<void> write_until(Time arrival) {
    for (; next_ < deliveries_.size() && deliveries_[next_].arrival <= arrival; ++next_) {
      const Delivery& each = deliveries_[next_];
      if (auto ok = write_truth_until(each.arrival); !ok) return ok;
      const auto* imu = std::get_if<ImuSample>(&each.measurement);
      auto ok = imu ? writer_.write_imu(ImuOutput::kMain, each.arrival, *imu)
                    : writer_.write_leg_odometry(each.arrival,
                                                 std::get<LegOdometrySample>(each.measurement));
      if (!ok) return ok;
    }
    return write_truth_until(std::min(arrival, from_seconds(walk_.duration())));
  }

  RecordingWriter& writer() { return writer_; }
  const Trajectory& truth() const { return truth_; }

 private:
  Result<void> write_truth_until(Time until) {
    for (; truth_due_ <= until; truth_due_ += kTruthPeriod) {
      const BodyState body = walk_.state(to_seconds(truth_due_));
      truth_.push_back({truth_due_, body.T_world_body});
      auto ok = writer_.write_truth(
          {truth_due_, body.T_world_body, body.velocity, body.angular_velocity});
      if (!ok) return ok;
    }
    return {};
  }

  RecordingWriter writer_;
  const Walk& walk_;
  std::vector<Delivery> deliveries_;
  std::size_t next_ = 0;
  Time truth_due_ = 0;
  Trajectory truth_;
};

std::vector<Delivery> small_deliveries(const Walk& walk, const SensorRig& rig,
                                       const RecordingOptions& options) {
  InertialOptions inertial;
  inertial.rate_hz = options.imu_rate_hz;
  inertial.force_vibration *= options.vibration;
  inertial.rate_vibration *= options.vibration;
  inertial.seed = options.seed;
  LegOptions legs;
  legs.scale = options.legs_scale;
  legs.seed = options.seed;
  std::vector<Delivery> deliveries;
  for (const ImuSample& each : sample_inertial(walk, inertial)) {
    deliveries.push_back({each.stamp + kImuDelay, each});
  }
  for (const LegOdometrySample& each : sample_legs(walk, rig.T_body_base, legs)) {
    deliveries.push_back({each.stamp + kLegDelay, each});
  }
  std::ranges::stable_sort(deliveries, {}, &Delivery::arrival);
  return deliveries;
}

std::string waypoint_times_of(const Walk& walk) {
  return fmt::format("point,stamp_s\nstart,{}\nfar,{}\nend,{}\n", walk.start(), walk.far_end(),
                     walk.end());
}

Result<void> fill(Recorder& recorder, SpinningLidar& lidar, const Walk& walk, const World& world) {
  const Time end = from_seconds(walk.duration());
  for (Time start = 0; start + kScanPeriod <= end; start += kScanPeriod) {
    const LidarScan scan = lidar.scan(walk, world, start);
    const Time arrival = scan.end + kLidarDelay;
    if (auto ok = recorder.write_until(arrival); !ok) return ok;
    if (auto ok = recorder.writer().write_scan(arrival, scan); !ok) return ok;
  }
  const Time last = end + kLidarDelay;
  if (auto ok = recorder.write_until(last); !ok) return ok;
  return recorder.writer().write_waypoint_times(last, waypoint_times_of(walk));
}

Result<void> check(const RecordingOptions& options) {
  struct Bound {
    const char* name;
    double value;
    double low;
    double high;
  };
  for (const Bound& bound : {Bound{"--imu-rate", options.imu_rate_hz, 20.0, 2000.0},
                             Bound{"--legs-scale", options.legs_scale, 0.1, 10.0},
                             Bound{"--relief", options.relief, 0.0, 0.02},
                             Bound{"--range-noise", options.range_noise, 0.0, 1.0},
                             Bound{"--outliers", options.outliers, 0.0, 1.0},
                             Bound{"--vibration", options.vibration, 0.0, 100.0}}) {
    if (bound.value >= bound.low && bound.value <= bound.high) continue;
    return failure(fmt::format("{}: expected {} to {}", bound.name, bound.low, bound.high));
  }
  if (options.length == 0.0 || (options.length >= kMinLength && options.length <= kMaxLength)) {
    return {};
  }
  return failure(fmt::format("--length: expected {} to {} m", kMinLength, kMaxLength));
}

fs::path beside(fs::path bag, const char* extension) { return bag.replace_extension(extension); }

/// Gives the finished bag its name.
Result<void> publish(const fs::path& partial, const fs::path& bag) {
  std::error_code code;
  fs::rename(partial, bag, code);
  if (code) return failure(fmt::format("{}: cannot be written: {}", bag.string(), code.message()));
  return {};
}

}  // namespace

SensorRig rig_of(const RecordingOptions& options) {
  SensorRig rig;
  const auto tilt = Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitY());
  rig.T_body_lidar = {Eigen::Quaterniond(tilt), Eigen::Vector3d(0.10, 0.0, 0.14)};
  rig.T_body_base.translation = Eigen::Vector3d(0.05, 0.0, -0.03);
  rig.imu_rate_hz = options.imu_rate_hz;
  return rig;
}

Result<void> write_recording(const RecordingOptions& options, const fs::path& bag) {
  if (auto ok = check(options); !ok) return ok;
  auto cell = make_cell(options.cell, options.length);
  if (!cell) return tl::unexpected(cell.error());
  World& world = cell->world;
  if (options.relief > 0.0) {
    world.relief = std::make_shared<Relief>(world.room, options.relief, options.seed);
  }
  auto rings = ring_elevations_deg(options.rings);
  if (!rings) return tl::unexpected(rings.error());
  const Walk walk({.length = cell->length, .seed = options.seed});
  const SensorRig rig = rig_of(options);
  SpinningLidar lidar(rig.T_body_lidar, {.elevations_deg = std::move(*rings),
                                         .max_range = cell->range_limit,
                                         .range_noise = options.range_noise,
                                         .outliers = options.outliers,
                                         .seed = options.seed});
  fs::path partial = bag;
  partial += ".partial";
  std::error_code ignored;
  fs::remove(partial, ignored);
  auto file = create_recording(
      partial, RecordingFormat::kBag,
      {.compression = options.compress ? BagCompression::kLz4 : BagCompression::kNone});
  if (!file) return tl::unexpected(file.error());
  auto writer = RecordingWriter::create(
      std::move(*file), rig,
      fmt::format("# independent recording of {}, seed {}{}\n", options.cell, options.seed,
                  options.relief > 0.0 ? fmt::format(", relief {} m", options.relief) : ""));
  if (!writer) return tl::unexpected(writer.error());
  Recorder recorder(std::move(*writer), walk, small_deliveries(walk, rig, options));
  if (auto ok = fill(recorder, lidar, walk, world); !ok) return ok;
  if (auto ok = recorder.writer().close(); !ok) return ok;
  if (auto ok = write_tum(beside(bag, ".truth.tum"), recorder.truth()); !ok) return ok;
  const auto times = waypoint_times_of(walk);
  auto ok = write_file_atomically(beside(bag, ".waypoint_times.csv"), std::string_view(times));
  if (!ok) return ok;
  return publish(partial, bag);
}

}  // namespace aims::independent
