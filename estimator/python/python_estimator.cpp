// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/python/python_estimator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/measurement_members.hpp"
#include "core/measurements.hpp"
#include "estimator/python/python_class.hpp"
#include "estimator/python/python_process.hpp"

namespace aims {
namespace {

/// Measurements on their way to a Python process, sorted by kind, and their order.
class PythonBatch {
 public:
  void add(Time arrival, const ImuSample& sample);
  void add(Time arrival, const LegOdometrySample& sample);
  /// A scan whose points lie in `part` of the memory shared with the process.
  void add(Time arrival, const LidarScan& scan, const SharedMemory::Part& part);

  std::size_t size() const { return order_.size(); }

  /// The message of what was added; then empty.
  PipeMessage take();

 private:
  enum class Event : std::uint8_t { kImu = 1, kLegs = 2, kScan = 3 };

  std::vector<Event> order_;
  PipeMessage imu_;
  PipeMessage legs_;
  PipeMessage scans_;
};

/// Writes values as cells of eight bytes.
class Cells {
 public:
  explicit Cells(PipeMessage& out) : out_(out) {}

  template <class... Values>
  bool operator()(const Values&... values) {
    (write(values), ...);
    return true;
  }

 private:
  template <class Sample>
  void write(const Sample& sample) {
    visit_members(*this, sample);
  }
  void write(Time time) { out_.add(time); }
  void write(double value) { out_.add(value); }
  void write(bool value) { out_.add(value ? 1.0 : 0.0); }
  void write(const Pose& pose) { out_.add_pose(pose); }
  void write(const Eigen::Vector3d& vector) {
    for (const double value : vector) write(value);
  }
  template <class T, std::size_t kSize>
  void write(const std::array<T, kSize>& values) {
    for (const T& value : values) write(value);
  }
  void write(const std::optional<Eigen::Quaterniond>& rotation) {
    write(rotation.has_value());
    const Eigen::Quaterniond given = rotation.value_or(Eigen::Quaterniond::Identity());
    for (const double value : given.coeffs()) write(value);
  }
  void write(const std::optional<FootLoads>& loads) {
    write(loads.has_value());
    write(loads.value_or(FootLoads{}));
  }

  PipeMessage& out_;
};

void PythonBatch::add(Time arrival, const ImuSample& sample) {
  order_.push_back(Event::kImu);
  Cells{imu_}(arrival, sample);
}

void PythonBatch::add(Time arrival, const LegOdometrySample& sample) {
  order_.push_back(Event::kLegs);
  Cells{legs_}(arrival, sample);
}

void PythonBatch::add(Time arrival, const LidarScan& scan, const SharedMemory::Part& part) {
  order_.push_back(Event::kScan);
  Cells{scans_}(arrival, scan.stamp, scan.end);
  for (const std::uint64_t number : {scan.points.size(), part.offset, part.capacity}) {
    scans_.add(number);
  }
}

PipeMessage PythonBatch::take() {
  PipeMessage message;
  for (const Event kind : {Event::kImu, Event::kLegs, Event::kScan}) {
    message.add(static_cast<std::uint64_t>(std::ranges::count(order_, kind)));
  }
  message.add(std::uint64_t{order_.size()});
  for (const Event each : order_) message.add(each);
  message.pad_to_eight();
  for (PipeMessage* part : {&imu_, &legs_, &scans_}) {
    message.append(part->bytes());
    part->clear();
  }
  order_.clear();
  return message;
}

/// Measurements that wait for the next scan, at most: bounds what a gap between scans collects.
constexpr std::size_t kMaxWaiting = 2'000;
/// Deviation of R^T R from identity up to which a matrix is taken for a rotation, as in files.
constexpr double kRotationTolerance = 1e-3;
/// A pose may be stamped so much before or after all measurements [ns].
constexpr double kStampMargin = 10e9;

/// A pose of the process; none when its matrix is no rigid transform.
std::optional<Pose> pose_in(MessageCursor& cursor) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int at = 0; at < 4; ++at) matrix(row, at) = cursor.take<double>();
  }
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  const Eigen::RowVector4d last_row(0.0, 0.0, 0.0, 1.0);
  const bool rigid = matrix.allFinite() && R.determinant() > 0.0 &&
                     (matrix.row(3) - last_row).norm() < kRotationTolerance &&
                     (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < kRotationTolerance;
  if (!rigid) return std::nullopt;
  return Pose{Eigen::Quaterniond(R).normalized(), matrix.topRightCorner<3, 1>()};
}

class PythonEstimator final : public Estimator {
 public:
  PythonEstimator(const PythonConfig& config, const SensorRig& rig)
      : name_(config.name()),
        limit_s_(config.call_timeout()),
        takes_imu_(config.has("add_imu")),
        takes_legs_(config.has("add_legs")),
        takes_scans_(config.has("add_scan")) {
    auto ready = import_class(process_, name_, limit_s_);
    if (ready) ready = ask(PythonRequest::kCreate, creation(config, rig).bytes());
    if (!ready) fail(ready.error());
  }

  void consume(const Delivery& delivery) override {
    if (result_.failure) return;
    note_times(delivery);
    std::visit([&](const auto& measurement) { add(delivery.arrival, measurement); },
               delivery.measurement);
    if (batch_.size() >= kMaxWaiting) flush();
  }

  void finish() override {
    if (!result_.failure && batch_.size() > 0) flush();
    if (result_.failure) return;
    const auto answer = ask(PythonRequest::kFinish, {});
    if (!answer) return fail_after_poses(answer.error());
    MessageCursor cursor(*answer);
    take_poses(cursor);
    const auto count = cursor.take<std::uint64_t>();
    if (count * sizeof(Eigen::Vector3f) != cursor.left()) return fail({"answered with no map"});
    map_.resize(count);
    for (Eigen::Vector3f& point : map_) {
      for (int axis = 0; axis < 3; ++axis) point[axis] = cursor.take<float>();
    }
  }

  const EstimatorResult& result() const override { return result_; }
  std::vector<Eigen::Vector3f> map_points() const override { return map_; }

 private:
  static PipeMessage creation(const PythonConfig& config, const SensorRig& rig) {
    PipeMessage bytes;
    bytes.add_pose(rig.T_body_lidar);
    bytes.add_pose(rig.T_body_base);
    bytes.add(rig.imu_rate_hz);
    bytes.add(rig.leg_rate_hz);
    for (const PythonSetting& each : config.settings()) {
      if (each.standard == each.value) continue;
      bytes.add_text(each.key);
      bytes.add_text(python_text(each.value));
    }
    return bytes;
  }

  void note_times(const Delivery& delivery) {
    const Time stamp = stamp_of(delivery.measurement);
    first_ = std::min({first_, stamp, delivery.arrival});
    last_ = std::max({last_, stamp, delivery.arrival});
  }

  /// Whether a pose of this stamp can be one of the measurements so far. Others, as of an
  /// estimator that counts in another unit, would spoil what is written and drawn of all.
  bool is_measured(Time stamp) const {
    const auto ns = static_cast<double>(stamp);  // whose differences cannot overflow
    return ns >= static_cast<double>(first_) - kStampMargin &&
           ns <= static_cast<double>(last_) + kStampMargin;
  }

  void add(Time arrival, const ImuSample& sample) {
    if (takes_imu_) batch_.add(arrival, sample);
  }
  void add(Time arrival, const LegOdometrySample& sample) {
    if (takes_legs_) batch_.add(arrival, sample);
  }
  void add(Time arrival, const LidarScanPtr& scan) {
    if (!takes_scans_) return flush();
    const auto part = process_.memory().put(scan->points);
    if (!part) return fail(part.error());
    batch_.add(arrival, *scan, *part);
    flush();
  }

  /// Hands what waits to the process, and takes its poses.
  void flush() {
    if (batch_.size() == 0) return;
    const auto answer = ask(PythonRequest::kMeasure, batch_.take().bytes());
    if (!answer) return fail_after_poses(answer.error());
    MessageCursor cursor(*answer);
    take_poses(cursor);
    if (cursor.is_short()) fail({"answered with too few bytes"});
  }

  void take_poses(MessageCursor& cursor) {
    result_.external_cpu_s += to_seconds(cursor.take<Duration>());
    const auto poses = cursor.take<std::uint64_t>();
    const auto retained = cursor.take<std::uint64_t>();
    for (std::uint64_t i = 0; i < poses && !cursor.at_end(); ++i) {
      const auto stamp = cursor.take<Time>();
      keep(stamp, pose_in(cursor));
    }
    std::vector<std::uint64_t> offsets;
    for (std::uint64_t i = 0; i < retained && !cursor.at_end(); ++i) {
      offsets.push_back(cursor.take<std::uint64_t>());
    }
    process_.memory().keep(offsets);
  }

  void keep(Time stamp, const std::optional<Pose>& pose) {
    Trajectory& trajectory = result_.trajectory;
    if (!pose) {
      ++result_.counts["pose_not_rigid"];
      if (is_measured(stamp)) result_.invalid_poses.push_back(stamp);
    } else if (!is_measured(stamp)) {
      ++result_.counts["pose_stamp_not_measured"];
    } else if (!trajectory.empty() && stamp <= trajectory.back().stamp) {
      ++result_.counts["pose_stamp_not_increasing"];
    } else {
      trajectory.push_back({stamp, *pose});
    }
  }

  Result<std::vector<std::byte>> ask(PythonRequest request, std::span<const std::byte> content) {
    return process_.ask(request, content, limit_s_);
  }

  /// Keeps the poses of the calls before the one that failed.
  void fail_after_poses(const Error& error) {
    MessageCursor cursor(process_.yielded());
    take_poses(cursor);
    fail(error);
  }

  void fail(const Error& error) {
    result_.failure = Error{fmt::format("{}: {}", name_, error.message)};
  }

  std::string name_;
  double limit_s_;
  bool takes_imu_;
  bool takes_legs_;
  bool takes_scans_;
  PythonProcess process_;
  PythonBatch batch_;
  Time first_ = std::numeric_limits<Time>::max();  ///< of stamps and arrivals so far
  Time last_ = std::numeric_limits<Time>::min();
  EstimatorResult result_;
  std::vector<Eigen::Vector3f> map_;
};

}  // namespace

std::unique_ptr<Estimator> PythonConfig::create(const SensorRig& rig) const {
  return std::make_unique<PythonEstimator>(*this, rig);
}

}  // namespace aims
