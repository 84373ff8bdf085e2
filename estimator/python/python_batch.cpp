// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/python/python_batch.hpp"

#include <algorithm>

namespace aims {
namespace {

void add_vector(PipeMessage& bytes, const Eigen::Vector3d& vector) {
  for (int axis = 0; axis < 3; ++axis) bytes.add(vector[axis]);
}

}  // namespace

void PythonBatch::add(Time arrival, const ImuSample& sample) {
  order_.push_back(Event::kImu);
  imu_.add(arrival);
  imu_.add(sample.stamp);
  add_vector(imu_, sample.specific_force);
  add_vector(imu_, sample.angular_velocity);
  imu_.add(sample.orientation ? 1.0 : 0.0);
  const Eigen::Quaterniond q = sample.orientation.value_or(Eigen::Quaterniond::Identity());
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) imu_.add(value);
}

void PythonBatch::add(Time arrival, const LegOdometrySample& sample) {
  order_.push_back(Event::kLegs);
  legs_.add(arrival);
  legs_.add(sample.stamp);
  legs_.add_pose(sample.T_odom_base);
  add_vector(legs_, sample.linear_velocity);
  add_vector(legs_, sample.angular_velocity);
  for (const double value : sample.joint_position) legs_.add(value);
  for (const double value : sample.joint_velocity) legs_.add(value);
  for (const bool value : sample.contact) legs_.add(value ? 1.0 : 0.0);
}

void PythonBatch::add(Time arrival, const LidarScan& scan, const SharedMemory::Part& part) {
  order_.push_back(Event::kScan);
  for (const Time time : {arrival, scan.stamp, scan.end}) scans_.add(time);
  scans_.add(std::uint64_t{scan.points.size()});
  scans_.add(part.offset);
  scans_.add(part.capacity);
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
