// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/lio_sam.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <variant>

#include "estimator/baselines/features/scan_estimator.hpp"

namespace aims::lio_sam {

void describe(Fields& f, TimingConfig& c) {
  f.integer("held_scans", c.held_scans,
            {"-", in_range(0, 10), "a scan is processed when this many later ones have ended"});
  f.number("delay", c.delay,
           {"s", in_range(0.0, 10.0), "until a registered scan reaches the IMU odometry"});
}

void describe(Fields& f, Config& c) {
  f.group("image", c.image);
  f.group("features", c.features);
  f.group("mapping", c.mapping);
  f.group("imu", c.imu);
  f.group("timing", c.timing);
  f.group("queue", c.queue);
}

Requirements requirements_of(const Config&) {
  return {.lidar = true, .imu = true, .rings = true, .point_times = true, .orientation = true};
}

Config corridor() {
  Config config;
  config.image.min_range = 0.5;
  config.features.surface_voxel = 0.2;
  config.mapping.edge_voxel = 0.1;
  config.mapping.surface_voxel = 0.2;
  config.mapping.loop.voxel = 0.2;
  return config;
}

namespace {

using Series = ReportedSeries<ScanReport>;

/// The value of a registered scan, else NaN.
template <class Value>
double of_registered(const ScanReport& scan, Value value) {
  return scan.registered ? double(value(*scan.registered))
                         : std::numeric_limits<double>::quiet_NaN();
}

constexpr std::array kOwnSeries = {
    Series{"points_in", "-", "returns in range",
           [](const ScanReport& s) { return double(s.points_in); }},
    Series{"edges", "-", "edges after averaging; NaN: scan not registered",
           [](const ScanReport& s) {
             return of_registered(s, [](const RegisteredScan& r) { return r.edges; });
           }},
    Series{"surface_points", "-", "surface points after averaging",
           [](const ScanReport& s) {
             return of_registered(s, [](const RegisteredScan& r) { return r.surface; });
           }},
    Series{"iterations", "-", "iterations; 0: scan not registered",
           [](const ScanReport& s) {
             return s.registered ? double(s.registered->solver.iterations) : 0.0;
           }},
    Series{"matches", "-", "lines and planes of the map",
           [](const ScanReport& s) {
             return of_registered(
                 s, [](const RegisteredScan& r) { return r.solver.lines + r.solver.planes; });
           }},
    Series{"smallest_eigenvalue", "-", "smallest eigenvalue of A^T A in the first iteration",
           [](const ScanReport& s) {
             return of_registered(
                 s, [](const RegisteredScan& r) { return smallest_eigenvalue(r.solver); });
           }},
    Series{"removed_directions", "-", "degenerate directions that do not move",
           [](const ScanReport& s) {
             return of_registered(
                 s, [](const RegisteredScan& r) { return r.solver.directions.removed; });
           }},
    Series{"is_degenerate", "-", "1: a direction is degenerate; its pose weighs less",
           [](const ScanReport& s) {
             return of_registered(s, [](const RegisteredScan& r) { return r.degenerate; });
           }},
    Series{"is_keyframe", "-", "1: the scan became a keyframe",
           [](const ScanReport& s) {
             return of_registered(s, [](const RegisteredScan& r) { return r.keyframe; });
           }},
    Series{"imu_guess", "-", "1: the IMU odometry gave the guess",
           [](const ScanReport& s) { return double(s.guessed); }},
    Series{"imu_resets", "-", "failures of the IMU odometry so far",
           [](const ScanReport& s) { return double(s.resets); }},
    Series{"imu_speed", "m/s", "speed at the newest key of the IMU odometry",
           [](const ScanReport& s) { return s.speed; }},
    Series{"accelerometer_bias", "m/s^2", "norm at the newest key of the IMU odometry",
           [](const ScanReport& s) { return s.accelerometer_bias; }},
    Series{"gyro_bias", "rad/s", "norm at the newest key of the IMU odometry",
           [](const ScanReport& s) { return s.gyro_bias; }},
};

constexpr std::array kSeries = joined(kOwnSeries, features::loop_series<ScanReport>());

/// Samples and poses kept while no scan arrives.
constexpr std::size_t kMaxKept = 20000;

template <class Item>
void keep(std::deque<Item>& items, const Item& item) {
  items.push_back(item);
  if (items.size() > kMaxKept) items.pop_front();
}

template <class Item>
void drop_before(std::deque<Item>& items, Time stamp) {
  while (!items.empty() && items.front().stamp < stamp) items.pop_front();
}

/// The last firing that the scan holds.
Time last_firing(const LidarScan& scan) {
  return scan.points.empty() ? scan.stamp : scan.stamp + scan.points.back().time_offset_ns;
}

}  // namespace

LioSam::LioSam(const Config& config, const SensorRig& rig)
    : QueuedEstimator(config.queue, rig, series_of(kSeries)),
      config_(config),
      mapping_(config.mapping),
      imu_odometry_(config.imu, rig.T_body_lidar.inverse().translation) {}

void LioSam::finish() {
  QueuedEstimator::finish();
  const Time clock = held_.empty() ? 0 : held_.back()->end;
  for (const LidarScanPtr& scan : std::exchange(held_, {})) process(*scan, clock);
  set_counts();
}

void LioSam::process_scan(const LidarScanPtr& scan) {
  const Time clock = scan->end;
  add_samples(clock);
  held_.push_back(scan);
  if (static_cast<int>(held_.size()) <= config_.timing.held_scans) return;
  const LidarScanPtr next = held_.front();
  held_.pop_front();
  process(*next, clock);
}

void LioSam::add_samples(Time until) {
  for (const ImuSample& sample : queue_.imu().samples()) {
    if (last_sample_ && sample.stamp <= *last_sample_) continue;
    if (sample.stamp > until) break;
    while (!pending_.empty() && pending_.front().arrival < sample.stamp) {
      imu_odometry_.correct(pending_.front().scan);
      pending_.pop_front();
    }
    add_sample(in_lidar_axes(sample));
    last_sample_ = sample.stamp;
  }
  if (last_sample_) queue_.imu().forget_before(*last_sample_);
}

void LioSam::add_sample(const ImuSample& sample) {
  keep(samples_, sample);
  const std::optional<StampedPose> pose = imu_odometry_.add(sample);
  if (!pose) return;
  keep(odometry_, *pose);
  keep(since_scan_, *pose);
}

/// An IMU without orientation gets that of a filter on its samples.
ImuSample LioSam::in_lidar_axes(const ImuSample& sample) {
  const Eigen::Quaterniond& R_body_lidar = rig_.T_body_lidar.rotation;
  const Eigen::Quaterniond filtered = attitude_filter_.update(sample);
  if (!sample.orientation) ++without_orientation_;
  return {sample.stamp, R_body_lidar.conjugate() * sample.angular_velocity,
          R_body_lidar.conjugate() * sample.specific_force,
          sample.orientation.value_or(filtered) * R_body_lidar};
}

bool LioSam::covered_by_imu(const LidarScan& scan, Time last_firing) const {
  return !samples_.empty() && samples_.front().stamp <= scan.stamp &&
         samples_.back().stamp >= last_firing;
}

/// The pose of the IMU odometry at the begin of a scan: the first one from then on, unless the
/// first one within the margin before is later.
std::optional<Pose> LioSam::odometry_at(Time begin) {
  drop_before(odometry_, begin - kSampleMargin);
  if (odometry_.empty() || odometry_.front().stamp > begin) return std::nullopt;
  const auto at = std::find_if(odometry_.begin(), odometry_.end(),
                               [&](const StampedPose& each) { return each.stamp >= begin; });
  return at == odometry_.end() ? odometry_.back().pose : at->pose;
}

ScanPrior LioSam::prior_of(const LidarScan& scan, const GyroRotation& rotation) {
  for (const ImuSample& sample : samples_) {
    if (sample.stamp > scan.stamp) break;
    attitude_ = angles_of(*sample.orientation);
  }
  return {rotation.available(), attitude_, odometry_at(scan.stamp)};
}

/// The pose of the last registered scan, moved as the IMU odometry has moved since.
Pose LioSam::between_scans(Time stamp) {
  drop_before(since_scan_, registered_->stamp + 1);
  if (since_scan_.empty() || since_scan_.front().stamp > stamp) return registered_->pose;
  auto last = since_scan_.begin();
  while (std::next(last) != since_scan_.end() && std::next(last)->stamp <= stamp) ++last;
  return registered_->pose * since_scan_.front().pose.inverse() * last->pose;
}

/// `clock`: end of the newest scan that has ended by now.
void LioSam::process(const LidarScan& scan, Time clock) {
  const Time end = last_firing(scan);
  if (!covered_by_imu(scan, end)) {
    ++without_imu_;
    return;
  }
  drop_before(samples_, scan.stamp - kSampleMargin);
  const GyroRotation rotation({samples_.begin(), samples_.end()}, end);
  const ScanPrior prior = prior_of(scan, rotation);
  const auto rings = deskewed_rings(scan, rotation, config_.image);
  ScanReport diagnostics;
  for (const features::RangeRing& ring : rings) diagnostics.points_in += ring.size();
  diagnostics.guessed = prior.odometry.has_value();
  if (mapping_.is_due(scan.stamp)) {
    const RegisteredScan registered =
        mapping_.update(scan.stamp, scan_features(rings, config_.features), prior);
    rejected_ += registered.rejected ? 1 : 0;
    registered_ = {scan.stamp, registered.T_map_lidar};
    pending_.push_back({clock + from_seconds(config_.timing.delay), registered.odometry});
    diagnostics.registered = registered;
    report(scan, registered.T_map_lidar, diagnostics);
  } else if (registered_) {
    report(scan, between_scans(scan.stamp), diagnostics);
  }
}

void LioSam::report(const LidarScan& scan, const Pose& T_map_lidar, const ScanReport& diagnostics) {
  Trajectory& trajectory = result_.trajectory;
  if (!trajectory.empty() && scan.stamp <= trajectory.back().stamp) return;
  const Pose T_map_body = T_map_lidar * rig_.T_body_lidar.inverse();
  if (trajectory.empty()) {
    const Eigen::Quaterniond heading = yaw_rotation(yaw_of(T_map_body.rotation));
    T_odom_map_ = Pose{heading, T_map_body.translation}.inverse();
  }
  trajectory.push_back({scan.stamp, T_odom_map_ * T_map_body});
  ScanReport complete = diagnostics;
  for (const auto& [kind, count] : imu_odometry_.failures()) complete.resets += count;
  complete.loops = mapping_.loops();
  complete.speed = imu_odometry_.state().velocity.norm();
  complete.accelerometer_bias = imu_odometry_.bias().accelerometer.norm();
  complete.gyro_bias = imu_odometry_.bias().gyro.norm();
  result_.diagnostics.scans.push_back({scan.end, std::nullopt, values_of(kSeries, complete)});
}

void LioSam::set_counts() {
  result_.counts = queue_.counts();
  for (const auto& [kind, count] : imu_odometry_.failures()) result_.counts[kind] = count;
  if (without_orientation_ > 0) result_.counts["imu.without_orientation"] = without_orientation_;
  if (without_imu_ > 0) result_.counts["lidar.without_imu"] = without_imu_;
  if (rejected_ > 0) result_.counts["lidar.rejected_result"] = rejected_;
}

std::vector<Eigen::Vector3f> LioSam::map_points() const {
  std::vector<Eigen::Vector3f> points = mapping_.map().points();
  for (Eigen::Vector3f& point : points) {
    point = (T_odom_map_ * point.cast<double>()).cast<float>();
  }
  return points;
}

}  // namespace aims::lio_sam
