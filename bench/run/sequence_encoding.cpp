// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/sequence_encoding.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "core/measurement_members.hpp"

namespace aims {
namespace {

enum class Kind : std::uint8_t { kImu = 1, kLegs = 2, kScan = 3 };

/// Of a return: x, y, z, intensity, time offset, ring.
constexpr std::size_t kPointSize = 4 * sizeof(float) + sizeof(std::int32_t) + sizeof(std::uint16_t);
constexpr std::size_t kLeastEntry = 8;  ///< no entry of a list has fewer bytes

template <class Archive, MaybeConst<Pose> Value>
bool visit_members(Archive& archive, Value& pose) {
  return archive(pose.rotation.coeffs(), pose.translation);
}

template <class Archive, MaybeConst<LegGeometry> Value>
bool visit_members(Archive& archive, Value& legs) {
  return archive(legs.hip_x, legs.hip_y, legs.abduction, legs.thigh, legs.calf, legs.foot_radius);
}

template <class Archive, MaybeConst<SensorRig> Value>
bool visit_members(Archive& archive, Value& rig) {
  return archive(rig.T_body_lidar, rig.T_body_base, rig.leg_geometry, rig.imu_rate_hz,
                 rig.leg_rate_hz);
}

template <class Archive, MaybeConst<WalkOutcome> Value>
bool visit_members(Archive& archive, Value& walk) {
  return archive(walk.end, walk.touched_wall, walk.wall_contact_fraction);
}

/// Biases are not stored.
template <class Archive, MaybeConst<TruthSample> Value>
bool visit_members(Archive& archive, Value& sample) {
  return archive(sample.stamp, sample.T_world_body, sample.velocity, sample.angular_velocity,
                 sample.slip_speed);
}

template <class Archive, MaybeConst<RobotSnapshot> Value>
bool visit_members(Archive& archive, Value& snapshot) {
  return archive(snapshot.stamp, snapshot.qpos);
}

template <class Archive, MaybeConst<WaypointTime> Value>
bool visit_members(Archive& archive, Value& time) {
  return archive(time.point, time.stamp);
}

template <class Archive, MaybeConst<ScanInformation> Value>
bool visit_members(Archive& archive, Value& scan) {
  return archive(scan.stamp, scan.information, scan.returns, scan.range_sigma);
}

/// Mounts are not stored.
template <class Archive, MaybeConst<Truth> Value>
bool visit_members(Archive& archive, Value& truth) {
  return archive(truth.walk, truth.samples, truth.snapshots, truth.waypoint_times, truth.scans);
}

/// Numbers that are stored as they lie in memory.
template <class T>
concept Plain = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

/// Vectors and matrices of fixed size.
template <class T>
concept Matrix = requires(const T& matrix) {
  matrix.data();
  matrix.rows();
};

/// Writes values at the end of bytes.
class Writing {
 public:
  explicit Writing(std::vector<std::byte>& out) : out_(out) {}

  template <class... Values>
  bool operator()(const Values&... values) {
    (write(values), ...);
    return true;
  }

 private:
  template <class T>
  void write(const T& value) {
    if constexpr (Plain<T>) {
      append_number(out_, value);
    } else if constexpr (std::same_as<T, bool> || std::is_enum_v<T>) {
      append_number(out_, static_cast<std::uint8_t>(value));
    } else if constexpr (Matrix<T>) {
      append(out_, std::as_bytes(std::span(value.data(), std::size_t(value.size()))));
    } else {
      visit_members(*this, value);
    }
  }
  template <class T, std::size_t kSize>
  void write(const std::array<T, kSize>& values) {
    for (const T& value : values) write(value);
  }
  void write(const Eigen::Quaterniond& rotation) { write(rotation.coeffs()); }
  template <class T>
  void write(const std::optional<T>& value) {
    write(value.has_value());
    if (value) write(*value);
  }
  template <class T>
  void write(const std::vector<T>& values) {
    write(std::uint64_t{values.size()});
    for (const T& value : values) write(value);
  }
  void write(const std::string& text) {
    write(std::uint64_t{text.size()});
    append(out_, bytes_of(text));
  }

  std::vector<std::byte>& out_;
};

/// Reads what `Writing` wrote; false where the bytes end too early.
class Reading {
 public:
  explicit Reading(ByteCursor& cursor) : cursor_(cursor) {}

  template <class... Values>
  bool operator()(Values&&... values) {
    return (read(values) && ...);
  }

  /// A count of things of at least `size` bytes each that are all there.
  bool count_of(std::size_t size, std::size_t& count) {
    std::uint64_t given = 0;
    if (!read(given) || given > cursor_.left() / size) return false;
    count = static_cast<std::size_t>(given);
    return true;
  }

 private:
  bool copy(void* to, std::size_t size) {
    const auto bytes = cursor_.take(size);
    if (bytes) std::memcpy(to, bytes->data(), size);
    return bytes.has_value();
  }

  template <class T>
  bool read(T& value) {
    if constexpr (Plain<T>) {
      return copy(&value, sizeof(T));
    } else if constexpr (std::same_as<T, bool> || std::is_enum_v<T>) {
      const auto byte = cursor_.number<std::uint8_t>();
      value = static_cast<T>(byte.value_or(0));
      return byte.has_value();
    } else if constexpr (Matrix<T>) {
      return copy(value.data(), static_cast<std::size_t>(value.size()) * sizeof(value.data()[0]));
    } else {
      return visit_members(*this, value);
    }
  }
  template <class T, std::size_t kSize>
  bool read(std::array<T, kSize>& values) {
    return std::ranges::all_of(values, [this](T& value) { return read(value); });
  }
  bool read(Eigen::Quaterniond& rotation) { return read(rotation.coeffs()); }
  template <class T>
  bool read(std::optional<T>& value) {
    bool present = false;
    return read(present) && (!present || read(value.emplace()));
  }
  template <class T>
  bool read(std::vector<T>& values) {
    std::size_t count = 0;
    if (!count_of(kLeastEntry, count)) return false;
    values.reserve(count);
    while (values.size() < count) {
      if (!read(values.emplace_back())) return false;
    }
    return true;
  }
  bool read(std::string& text) {
    std::size_t size = 0;
    if (!count_of(1, size)) return false;
    text = as_text(*cursor_.take(size));
    return true;
  }

  ByteCursor& cursor_;
};

/// A scan, whose points are left out unless they are wanted.
bool read_scan(ByteCursor& cursor, LidarScan& scan, const ScanFilter& with_points) {
  Reading reading(cursor);
  if (!reading(scan.stamp, scan.end)) return false;
  if (with_points(scan)) return reading(scan.points);
  std::size_t count = 0;
  return reading.count_of(kPointSize, count) && cursor.take(count * kPointSize).has_value();
}

}  // namespace

void append_rig(std::vector<std::byte>& out, const SensorRig& rig) { Writing{out}(rig); }

bool take_rig(ByteCursor& cursor, SensorRig& rig) { return Reading{cursor}(rig); }

void append_text(std::vector<std::byte>& out, std::string_view text) {
  Writing{out}(std::string(text));
}

bool take_text(ByteCursor& cursor, std::string& text) { return Reading{cursor}(text); }

void append_delivery(std::vector<std::byte>& out, const Delivery& delivery) {
  Writing writing(out);
  if (const auto* imu = std::get_if<ImuSample>(&delivery.measurement)) {
    writing(Kind::kImu, delivery.arrival, *imu);
  } else if (const auto* legs = std::get_if<LegOdometrySample>(&delivery.measurement)) {
    writing(Kind::kLegs, delivery.arrival, *legs);
  } else {
    writing(Kind::kScan, delivery.arrival, *std::get<LidarScanPtr>(delivery.measurement));
  }
}

std::optional<Delivery> take_delivery(ByteCursor& cursor, const ScanFilter& with_points) {
  Reading reading(cursor);
  Kind kind{};
  Delivery delivery;
  bool complete = reading(kind, delivery.arrival);
  if (kind == Kind::kImu) {
    complete = complete && reading(delivery.measurement.emplace<ImuSample>());
  } else if (kind == Kind::kLegs) {
    complete = complete && reading(delivery.measurement.emplace<LegOdometrySample>());
  } else if (kind == Kind::kScan) {
    auto scan = std::make_shared<LidarScan>();
    complete = complete && read_scan(cursor, *scan, with_points);
    delivery.measurement = LidarScanPtr(std::move(scan));
  } else {
    return std::nullopt;
  }
  return complete ? std::optional(std::move(delivery)) : std::nullopt;
}

void append_truth(std::vector<std::byte>& out, const Truth& truth) { Writing{out}(truth); }

bool take_truth(ByteCursor& cursor, Truth& truth) {
  return Reading{cursor}(truth) && truth.walk.end <= WalkEnd::kUnstablePhysics;
}

}  // namespace aims
