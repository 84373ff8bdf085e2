// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/sequence_encoding.hpp"

#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <utility>

namespace aims {
namespace {

enum class Kind : std::uint8_t { kImu = 1, kLegs = 2, kScan = 3 };

/// Of a return: x, y, z, intensity, time offset, ring.
constexpr std::size_t kPointSize = 4 * sizeof(float) + sizeof(std::int32_t) + sizeof(std::uint16_t);
constexpr std::size_t kTruthSampleSize = sizeof(Time) + (13 + kLegCount) * sizeof(double);
constexpr std::size_t kLeastSnapshotSize = sizeof(Time) + sizeof(std::uint64_t);
constexpr std::size_t kScanInformationSize =
    sizeof(Time) + 37 * sizeof(double) + sizeof(std::int32_t);

void append_numbers(std::vector<std::byte>& out, std::span<const double> numbers) {
  append(out, std::as_bytes(numbers));
}

template <class Matrix>
void append_matrix(std::vector<std::byte>& out, const Matrix& matrix) {
  append_numbers(out, {matrix.data(), static_cast<std::size_t>(matrix.size())});
}

/// Copies numbers that lie at the cursor; false when there are fewer.
template <class T>
bool take_numbers(ByteCursor& cursor, T* numbers, std::size_t count) {
  const auto bytes = cursor.take(count * sizeof(T));
  if (!bytes) return false;
  std::memcpy(numbers, bytes->data(), bytes->size());
  return true;
}

template <class T>
bool take_number(ByteCursor& cursor, T& number) {
  return take_numbers(cursor, &number, 1);
}

template <class Matrix>
bool take_matrix(ByteCursor& cursor, Matrix& matrix) {
  return take_numbers(cursor, matrix.data(), static_cast<std::size_t>(matrix.size()));
}

/// A count of things of `size` bytes each that are all there; false otherwise.
bool take_count(ByteCursor& cursor, std::size_t size, std::size_t& count) {
  std::uint64_t given = 0;
  if (!take_number(cursor, given) || given > cursor.left() / size) return false;
  count = static_cast<std::size_t>(given);
  return true;
}

/// Without orientation: the simulated IMU reports none.
void append_imu(std::vector<std::byte>& out, const ImuSample& sample) {
  append_number(out, sample.stamp);
  append_matrix(out, sample.angular_velocity);
  append_matrix(out, sample.specific_force);
}

bool take_imu(ByteCursor& cursor, ImuSample& sample) {
  return take_number(cursor, sample.stamp) && take_matrix(cursor, sample.angular_velocity) &&
         take_matrix(cursor, sample.specific_force);
}

void append_legs(std::vector<std::byte>& out, const LegOdometrySample& sample) {
  append_number(out, sample.stamp);
  append_pose(out, sample.T_odom_base);
  append_matrix(out, sample.linear_velocity);
  append_matrix(out, sample.angular_velocity);
  for (const bool contact : sample.contact) append_number(out, std::uint8_t{contact});
  append_numbers(out, sample.joint_position);
  append_numbers(out, sample.joint_velocity);
  append_number(out, std::uint8_t{sample.contact_force.has_value()});
  if (sample.contact_force) append_numbers(out, *sample.contact_force);
}

/// Forces of the feet, if there are any.
bool take_force(ByteCursor& cursor, std::optional<FootLoads>& force) {
  std::uint8_t present = 0;
  if (!take_number(cursor, present)) return false;
  if (present == 0) return true;
  force.emplace();
  return take_numbers(cursor, force->data(), force->size());
}

bool take_legs(ByteCursor& cursor, LegOdometrySample& sample) {
  std::array<std::uint8_t, kLegCount> contact{};
  const bool complete =
      take_number(cursor, sample.stamp) && take_pose(cursor, sample.T_odom_base) &&
      take_matrix(cursor, sample.linear_velocity) && take_matrix(cursor, sample.angular_velocity) &&
      take_numbers(cursor, contact.data(), contact.size()) &&
      take_numbers(cursor, sample.joint_position.data(), sample.joint_position.size()) &&
      take_numbers(cursor, sample.joint_velocity.data(), sample.joint_velocity.size()) &&
      take_force(cursor, sample.contact_force);
  for (std::size_t i = 0; i < contact.size(); ++i) sample.contact[i] = contact[i] != 0;
  return complete;
}

void append_scan(std::vector<std::byte>& out, const LidarScan& scan) {
  append_number(out, scan.stamp);
  append_number(out, scan.end);
  append_number(out, std::uint64_t{scan.points.size()});
  std::size_t at = out.size();
  out.resize(at + scan.points.size() * kPointSize);
  const auto put = [&](const void* from, std::size_t size) {
    std::memcpy(out.data() + at, from, size);
    at += size;
  };
  for (const LidarPoint& point : scan.points) {
    put(point.position.data(), 3 * sizeof(float));
    put(&point.intensity, sizeof(float));
    put(&point.time_offset_ns, sizeof(std::int32_t));
    put(&point.ring, sizeof(std::uint16_t));
  }
}

LidarPoint point_at(const std::byte* bytes) {
  LidarPoint point;
  std::memcpy(point.position.data(), bytes, 3 * sizeof(float));
  point.intensity = load_number<float>(bytes + 12);
  point.time_offset_ns = load_number<std::int32_t>(bytes + 16);
  point.ring = load_number<std::uint16_t>(bytes + 20);
  return point;
}

bool take_scan(ByteCursor& cursor, LidarScan& scan, const ScanFilter& with_points) {
  std::size_t count = 0;
  if (!take_number(cursor, scan.stamp) || !take_number(cursor, scan.end) ||
      !take_count(cursor, kPointSize, count)) {
    return false;
  }
  const std::byte* bytes = cursor.take(count * kPointSize)->data();
  if (!with_points(scan)) return true;
  scan.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) scan.points.push_back(point_at(bytes + i * kPointSize));
  return true;
}

void append_outcome(std::vector<std::byte>& out, const WalkOutcome& walk) {
  append_number(out, static_cast<std::uint8_t>(walk.end));
  append_number(out, std::uint8_t{walk.touched_wall});
  append_number(out, walk.wall_contact_fraction);
}

bool take_outcome(ByteCursor& cursor, WalkOutcome& walk) {
  std::uint8_t end = 0;
  std::uint8_t touched_wall = 0;
  if (!take_number(cursor, end) || !take_number(cursor, touched_wall) ||
      end > static_cast<std::uint8_t>(WalkEnd::kUnstablePhysics)) {
    return false;
  }
  walk.end = static_cast<WalkEnd>(end);
  walk.touched_wall = touched_wall != 0;
  return take_number(cursor, walk.wall_contact_fraction);
}

bool take_sample(ByteCursor& cursor, TruthSample& sample) {
  return take_number(cursor, sample.stamp) && take_pose(cursor, sample.T_world_body) &&
         take_matrix(cursor, sample.velocity) && take_matrix(cursor, sample.angular_velocity) &&
         take_numbers(cursor, sample.slip_speed.data(), sample.slip_speed.size());
}

bool take_snapshot(ByteCursor& cursor, RobotSnapshot& snapshot) {
  std::size_t count = 0;
  if (!take_number(cursor, snapshot.stamp) || !take_count(cursor, sizeof(double), count)) {
    return false;
  }
  snapshot.qpos.resize(count);
  return take_numbers(cursor, snapshot.qpos.data(), count);
}

bool take_information(ByteCursor& cursor, ScanInformation& scan) {
  std::int32_t returns = 0;
  if (!take_number(cursor, scan.stamp) || !take_matrix(cursor, scan.information) ||
      !take_number(cursor, returns) || !take_number(cursor, scan.range_sigma)) {
    return false;
  }
  scan.returns = returns;
  return true;
}

bool take_waypoint_time(ByteCursor& cursor, WaypointTime& waypoint_time) {
  return take_text(cursor, waypoint_time.point) && take_number(cursor, waypoint_time.stamp);
}

/// A count and as many entries of at least `size` bytes.
template <class Entry>
bool take_entries(ByteCursor& cursor, std::size_t size, std::vector<Entry>& entries,
                  bool (*take)(ByteCursor&, Entry&)) {
  std::size_t count = 0;
  if (!take_count(cursor, size, count)) return false;
  entries.resize(count);
  for (Entry& entry : entries) {
    if (!take(cursor, entry)) return false;
  }
  return true;
}

}  // namespace

void append_pose(std::vector<std::byte>& out, const Pose& pose) {
  append_matrix(out, pose.rotation.coeffs());
  append_matrix(out, pose.translation);
}

bool take_pose(ByteCursor& cursor, Pose& pose) {
  return take_matrix(cursor, pose.rotation.coeffs()) && take_matrix(cursor, pose.translation);
}

bool take_rig(ByteCursor& cursor, SensorRig& rig) {
  LegGeometry& legs = rig.leg_geometry;
  return take_pose(cursor, rig.T_body_lidar) && take_pose(cursor, rig.T_body_base) &&
         take_number(cursor, legs.hip_x) && take_number(cursor, legs.hip_y) &&
         take_number(cursor, legs.abduction) && take_number(cursor, legs.thigh) &&
         take_number(cursor, legs.calf) && take_number(cursor, legs.foot_radius) &&
         take_number(cursor, rig.imu_rate_hz) && take_number(cursor, rig.leg_rate_hz);
}

void append_rig(std::vector<std::byte>& out, const SensorRig& rig) {
  append_pose(out, rig.T_body_lidar);
  append_pose(out, rig.T_body_base);
  const LegGeometry& legs = rig.leg_geometry;
  const std::array<double, 8> numbers = {legs.hip_x,      legs.hip_y,     legs.abduction,
                                         legs.thigh,      legs.calf,      legs.foot_radius,
                                         rig.imu_rate_hz, rig.leg_rate_hz};
  append_numbers(out, numbers);
}

void append_text(std::vector<std::byte>& out, std::string_view text) {
  append_number(out, std::uint64_t{text.size()});
  append(out, bytes_of(text));
}

bool take_text(ByteCursor& cursor, std::string& text) {
  std::size_t size = 0;
  if (!take_count(cursor, 1, size)) return false;
  text = as_text(*cursor.take(size));
  return true;
}

void append_delivery(std::vector<std::byte>& out, const Delivery& delivery) {
  const auto begin = [&](Kind kind) {
    append_number(out, static_cast<std::uint8_t>(kind));
    append_number(out, delivery.arrival);
  };
  if (const auto* imu = std::get_if<ImuSample>(&delivery.measurement)) {
    begin(Kind::kImu);
    append_imu(out, *imu);
  } else if (const auto* legs = std::get_if<LegOdometrySample>(&delivery.measurement)) {
    begin(Kind::kLegs);
    append_legs(out, *legs);
  } else {
    begin(Kind::kScan);
    append_scan(out, *std::get<LidarScanPtr>(delivery.measurement));
  }
}

std::optional<Delivery> take_delivery(ByteCursor& cursor, const ScanFilter& with_points) {
  std::uint8_t kind = 0;
  Delivery delivery;
  if (!take_number(cursor, kind) || !take_number(cursor, delivery.arrival)) return std::nullopt;
  if (kind == static_cast<std::uint8_t>(Kind::kImu)) {
    ImuSample sample;
    if (!take_imu(cursor, sample)) return std::nullopt;
    delivery.measurement = sample;
  } else if (kind == static_cast<std::uint8_t>(Kind::kLegs)) {
    LegOdometrySample sample;
    if (!take_legs(cursor, sample)) return std::nullopt;
    delivery.measurement = sample;
  } else if (kind == static_cast<std::uint8_t>(Kind::kScan)) {
    auto scan = std::make_shared<LidarScan>();
    if (!take_scan(cursor, *scan, with_points)) return std::nullopt;
    delivery.measurement = LidarScanPtr(std::move(scan));
  } else {
    return std::nullopt;
  }
  return delivery;
}

void append_truth(std::vector<std::byte>& out, const Truth& truth) {
  append_outcome(out, truth.walk);
  append_number(out, std::uint64_t{truth.samples.size()});
  for (const TruthSample& sample : truth.samples) {
    append_number(out, sample.stamp);
    append_pose(out, sample.T_world_body);
    append_matrix(out, sample.velocity);
    append_matrix(out, sample.angular_velocity);
    append_numbers(out, sample.slip_speed);
  }
  append_number(out, std::uint64_t{truth.snapshots.size()});
  for (const RobotSnapshot& snapshot : truth.snapshots) {
    append_number(out, snapshot.stamp);
    append_number(out, std::uint64_t{snapshot.qpos.size()});
    append_numbers(out, snapshot.qpos);
  }
  append_number(out, std::uint64_t{truth.waypoint_times.size()});
  for (const WaypointTime& waypoint_time : truth.waypoint_times) {
    append_text(out, waypoint_time.point);
    append_number(out, waypoint_time.stamp);
  }
  append_number(out, std::uint64_t{truth.scans.size()});
  for (const ScanInformation& scan : truth.scans) {
    append_number(out, scan.stamp);
    append_matrix(out, scan.information);
    append_number(out, std::int32_t{scan.returns});
    append_number(out, scan.range_sigma);
  }
}

bool take_truth(ByteCursor& cursor, Truth& truth) {
  return take_outcome(cursor, truth.walk) &&
         take_entries(cursor, kTruthSampleSize, truth.samples, take_sample) &&
         take_entries(cursor, kLeastSnapshotSize, truth.snapshots, take_snapshot) &&
         take_entries(cursor, sizeof(std::uint64_t) + sizeof(Time), truth.waypoint_times,
                      take_waypoint_time) &&
         take_entries(cursor, kScanInformationSize, truth.scans, take_information);
}

}  // namespace aims
