// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/mount_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "bench/estimate/stream.hpp"
#include "core/lie.hpp"
#include "core/median.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr Duration kInterval = 500 * kMillisecond;
constexpr std::size_t kMostScans = 200;  ///< of turns
constexpr int kLastSamples = 1000;       ///< of the IMU, kept between turns
constexpr double kTurning = 0.1;         ///< mean of the gyro over kShort [rad/s]
constexpr Duration kShort = 250 * kMillisecond;
constexpr Duration kAfterTurn = 3 * kInterval;
constexpr double kFullTurns = 3.0;  ///< of another unit, whose multiples of a turn count [rad]

/// The rotation from the gyro between two stamps.
Eigen::Vector3d gyro_rotation(std::span<const ImuSample> samples, Time begin, Time end) {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  auto next = std::ranges::upper_bound(samples, begin, {}, &ImuSample::stamp);
  Time at = begin;
  for (; next != samples.end() && at < end; ++next) {
    const Time until = std::min(next->stamp, end);
    const Eigen::Vector3d turned = next->angular_velocity * to_seconds(until - at);
    sum += turned;
    rotation = rotation * so3_exp(turned);
    at = until;
  }
  return sum.norm() > kFullTurns ? sum : so3_log(rotation.normalized());
}

/// The usual time between poses.
Duration usual_step(const Trajectory& poses) {
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    steps.push_back(poses[i].stamp - poses[i - 1].stamp);
  }
  return upper_median(steps).value_or(0);
}

/// Adds the rotations over intervals of `kInterval` between poses without a scan missing in
/// between: LiDAR odometry, which knows no gyro, may lose a turn there.
void add_pairs(const Trajectory& poses, std::span<const ImuSample> samples,
               std::vector<RotationPair>& pairs) {
  const Duration usual = usual_step(poses);
  std::size_t first = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (2 * (poses[i].stamp - poses[i - 1].stamp) > 3 * usual) first = i;
    const Duration step = poses[i].stamp - poses[first].stamp;
    if (step < kInterval) continue;
    RotationPair pair;
    pair.lidar = so3_log(poses[first].pose.rotation.conjugate() * poses[i].pose.rotation);
    pair.imu = gyro_rotation(samples, poses[first].stamp, poses[i].stamp);
    const bool turns = std::max(pair.imu.norm(), pair.lidar.norm()) > kLeastRotation;
    if (step < 2 * kInterval && turns) pairs.push_back(pair);
    first = i;
  }
}

/// Adds the rates between poses, at the middle of their time.
void add_rates(const Trajectory& poses, std::vector<TurnRate>& rates) {
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Duration step = poses[i].stamp - poses[i - 1].stamp;
    if (step <= 0 || step > kInterval) continue;
    const double angle = poses[i - 1].pose.rotation.angularDistance(poses[i].pose.rotation);
    rates.push_back({poses[i - 1].stamp + step / 2, angle / to_seconds(step)});
  }
}

}  // namespace

std::optional<RotationEvidence> RotationEvidence::create(const RecordingSetup& setup,
                                                         WatchedScans watched) {
  const TopicsConfig& topics = setup.topics;
  const auto is_read = [](const std::string& topic) { return !topic.empty() && topic != "none"; };
  if (!is_read(topics.lidar) || !is_read(topics.imu)) return std::nullopt;
  return RotationEvidence(setup.rig, watched);
}

/// Whether the gyro turns at its last samples.
bool RotationEvidence::is_turning() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (auto each = samples_.rbegin(); each != samples_.rend(); ++each) {
    if (each->stamp < samples_.back().stamp - kShort) break;
    sum += each->angular_velocity;
    ++count;
  }
  return count > 0 && sum.norm() > kTurning * static_cast<double>(count);
}

bool RotationEvidence::is_wanted(const LidarScan& scan) {
  if (!first_scan_) first_scan_ = scan.stamp;
  if (watched_ == WatchedScans::kAll) return scan.stamp - *first_scan_ < kLongest;
  if (scan_times_.size() >= kMostScans) return false;
  if (is_turning()) last_turning_ = scan.stamp;
  return last_turning_ && scan.stamp - *last_turning_ < kAfterTurn;
}

void RotationEvidence::close() {
  if (!odometry_) return;
  turns_.insert(turns_.end(), odometry_->paths().begin(), odometry_->paths().end());
  odometry_.reset();
  kept_ = samples_.size();
}

void RotationEvidence::take(const LidarScan& scan) {
  if (!is_wanted(scan)) return close();
  if (!odometry_) odometry_.emplace();
  scan_times_.push_back(scan.end - scan.stamp);
  odometry_->add(scan);
}

void RotationEvidence::take(const ImuSample& sample) {
  if (!sample.angular_velocity.allFinite() || !sample.specific_force.allFinite()) return;
  if (!first_sample_) first_sample_ = sample.stamp;
  if (sample.stamp - *first_sample_ < kSecond) first_force_ += sample.specific_force;
  samples_.push_back(sample);
  // Between turns the last ones suffice.
  if (watched_ == WatchedScans::kAll || odometry_ || samples_.size() < kept_ + 2 * kLastSamples) {
    return;
  }
  const auto old = samples_.begin() + static_cast<std::ptrdiff_t>(kept_);
  samples_.erase(old, samples_.end() - kLastSamples);
}

void RotationEvidence::consume(std::span<const Delivery> deliveries) {
  for (const Delivery& each : deliveries) {
    if (const auto* imu = std::get_if<ImuSample>(&each.measurement)) take(*imu);
    if (const auto* scan = std::get_if<LidarScanPtr>(&each.measurement)) take(**scan);
  }
}

void RotationEvidence::finish() {
  close();
  std::ranges::stable_sort(samples_, {}, &ImuSample::stamp);
}

Duration RotationEvidence::half_scan() const { return upper_median(scan_times_).value_or(0) / 2; }

/// Samples with the mean rate over a scan around each, as scans see it: without vibration.
std::vector<ImuSample> RotationEvidence::seen_by_scans() const {
  const Duration half = std::max<Duration>(half_scan(), kMillisecond);
  std::vector<ImuSample> means = samples_;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t first = 0, last = 0;
  for (ImuSample& each : means) {
    for (; last < samples_.size() && samples_[last].stamp <= each.stamp + half; ++last) {
      sum += samples_[last].angular_velocity;
    }
    for (; samples_[first].stamp < each.stamp - half; ++first) {
      sum -= samples_[first].angular_velocity;
    }
    each.angular_velocity = sum / static_cast<double>(last - first);
  }
  return means;
}

MountCheck RotationEvidence::mount() const {
  std::vector<RotationPair> pairs;
  const auto samples = seen_by_scans();
  for (const Trajectory& each : turns_) {
    add_pairs(each, samples, pairs);
  }
  return check_mount(pairs, rig_.T_body_lidar.rotation, first_force_);
}

RateCheck RotationEvidence::rates() const {
  std::vector<TurnRate> lidar;
  for (const Trajectory& each : turns_) add_rates(each, lidar);
  std::vector<TurnRate> gyro;
  for (const ImuSample& each : seen_by_scans()) {
    gyro.push_back({each.stamp, each.angular_velocity.norm()});
  }
  return check_rates(lidar, gyro);
}

namespace {

constexpr double kClockOffset = 0.02;  ///< that counts: half of what scans of 10 Hz show [s]

std::vector<std::string> words(const RateCheck& check, const RecordingConfig& config) {
  if (check.is_wrong_unit()) {
    const bool degrees = check.scale > 1.0;
    return {fmt::format(
        "UNIT OF THE GYRO: it turns {:.3g} times as fast as LiDAR odometry: {}", check.scale,
        degrees ? "it is in deg/s: set recording.gyro_unit=deg/s (of a table: gyro_unit: deg/s)"
                : "it is converted to rad/s twice")};
  }
  if (!check.clock) {
    return {"clock of the LiDAR: not checked: the turns of the body do not show an offset"};
  }
  const double offset = check.clock->seconds;
  if (std::abs(offset) < kClockOffset) {
    return {fmt::format("clock of the LiDAR: within {:.0f} ms of the IMU's", 1e3 * kClockOffset)};
  }
  return {
      fmt::format("CLOCK OF THE LIDAR: stamped {:.0f} ms too {} against the IMU (correlation of "
                  "the turn rates {:.2f})",
                  1e3 * std::abs(offset), offset > 0.0 ? "late" : "early",
                  check.clock->correlation),
      fmt::format("  to try it: --set recording.lidar_delay={:.3f}", config.lidar_delay + offset)};
}

/// What the turns about each axis say of it.
std::string axes_text(const MountCheck& check) {
  std::vector<std::string> axes;
  for (std::size_t i = 0; i < 3; ++i) {
    const AxisCheck& axis = check.axes[i];
    axes.push_back(axis.observable()
                       ? fmt::format("{}: {} rotations, scale {}, correlation {}", "xyz"[i],
                                     axis.intervals, decimal_text(axis.scale, 2),
                                     decimal_text(axis.correlation, 2))
                       : fmt::format("{}: not checked, {} rotations", "xyz"[i], axis.intervals));
  }
  return fmt::format("gyro against LiDAR odometry, by axes of the IMU: {}", fmt::join(axes, "; "));
}

std::string verdict_text(const MountCheck& check) {
  if (check.contradicts) {
    return fmt::format(
        "{}: LiDAR odometry and gyro contradict it over {} rotations (residual "
        "{:.3f}; {:.3f} if {})",
        check.correctable ? "MOUNT OF THE LIDAR" : "GYRO", check.intervals, check.given_residual,
        check.best_residual, check.cause);
  }
  return fmt::format(
      "mount of the LiDAR: no contradiction between LiDAR odometry and gyro over {} "
      "rotations (residual {:.3f}){}",
      check.intervals, check.given_residual,
      check.one_axis ? ", all about one axis: the mount's angle about that axis is "
                       "not checked"
                     : "");
}

std::string correction_text(const MountCheck& check, const Pose& T_imu_lidar) {
  Eigen::Quaterniond q = check.R_imu_lidar;
  q.coeffs() = (q.coeffs().array().abs() < 1e-9).select(0.0, q.coeffs());
  const Eigen::Vector3d t = T_imu_lidar.translation.array() + 0.0;  // no negative zeros
  return fmt::format(
      "--set recording.T_imu_lidar.quaternion_xyzw=[{:.6g},{:.6g},{:.6g},{:.6g}] "
      "--set recording.T_imu_lidar.translation=[{:.6g},{:.6g},{:.6g}]",
      q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z());
}

std::vector<std::string> words(const MountCheck& check, const Pose& T_imu_lidar) {
  if (!check.checked()) {
    return {
        fmt::format("mount of the LiDAR and gyro: not checked: the body turns in {} intervals "
                    "of 0.5 s, too few",
                    check.intervals)};
  }
  std::vector<std::string> lines = {axes_text(check), verdict_text(check)};
  if (check.correctable) lines.push_back("  to try it: " + correction_text(check, T_imu_lidar));
  return lines;
}

}  // namespace

Result<std::vector<std::string>> mount_report(const EstimateConfig& config,
                                              const EstimateOptions& options) {
  auto reader = RecordingReader::open(options.bag, config.recording,
                                      {.recover = options.recover, .with = options.with});
  if (!reader) return tl::unexpected(reader.error());
  auto evidence = RotationEvidence::create(reader->setup(), WatchedScans::kAll);
  if (!evidence) {
    return std::vector<std::string>{"mount of the LiDAR: not checked: needs an IMU and a LiDAR"};
  }
  std::vector<Delivery> batch;
  for (bool more = true; more && reader->position() < RotationEvidence::kLongest;) {
    batch.clear();
    const auto next = reader->advance(kStreamBatch, batch);
    more = next && *next;
    evidence->consume(batch);
  }
  evidence->finish();
  const RateCheck rates = evidence->rates();
  std::vector<std::string> lines = words(rates, config.recording);
  if (rates.is_wrong_unit()) return lines;
  const Pose& T_imu_lidar = reader->setup().rig.T_body_lidar;
  for (std::string& line : words(evidence->mount(), T_imu_lidar)) lines.push_back(std::move(line));
  return lines;
}

std::optional<ReadingWarning> warning_of(const RotationEvidence& evidence,
                                         const Pose& T_imu_lidar) {
  const MountCheck check = evidence.mount();
  if (!check.contradicts) return std::nullopt;
  const std::string advice =
      check.correctable ? ": try " + correction_text(check, T_imu_lidar) : std::string();
  return ReadingWarning{
      "LiDAR odometry contradicts the gyro or the mount",
      fmt::format("LiDAR odometry and gyro contradict each other over {} rotations: it seems that "
                  "{}{} (aims info --mount)",
                  check.intervals, check.cause, advice)};
}

}  // namespace aims
