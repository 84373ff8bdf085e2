// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/python/python_batch.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "core/measurement_members.hpp"

namespace aims {
namespace {

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

}  // namespace

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

}  // namespace aims
