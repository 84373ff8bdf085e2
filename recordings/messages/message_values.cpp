// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_values.hpp"

#include <cmath>
#include <string>

#include "recordings/messages/robot_states.hpp"

namespace aims {
namespace {

using NoMessages = std::vector<MessageView>;

/// "a[].b" as "a" and "b"; "a[]" has no field.
struct EntryPath {
  std::string_view array, field;
};

std::optional<EntryPath> entries_of(std::string_view path) {
  const std::size_t at = path.find("[]");
  if (at == std::string_view::npos) return std::nullopt;
  std::string_view rest = path.substr(at + 2);
  if (rest.starts_with('.')) rest.remove_prefix(1);
  return EntryPath{path.substr(0, at), rest};
}

/// What `read` gives of each entry; nothing where it does not.
template <class Value, class Read>
std::optional<std::vector<Value>> each_entry(const MessageView& message, const EntryPath& path,
                                             Read read) {
  const auto entries = message.messages(path.array);
  if (!entries) return std::nullopt;
  std::vector<Value> values;
  for (const MessageView& entry : *entries) {
    auto value = read(entry, path.field);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

/// A column of single numbers.
std::optional<std::vector<double>> column_of(const TableView& table, std::string_view name) {
  const ColumnLayout* column = table.find(name);
  if (column == nullptr || column->count != 1) return std::nullopt;
  std::vector<double> values(table.rows);
  for (std::size_t row = 0; row < values.size(); ++row) {
    values[row] = number_at(table.bytes.data() + row * table.stride + column->offset, column->type,
                            table.order);
  }
  return values;
}

/// A rotation, normalized unless it is no rotation at all, which is counted.
std::optional<Eigen::Quaterniond> valid_orientation(Eigen::Quaterniond rotation,
                                                    EventCounts& counts) {
  const double norm = rotation.norm();
  if (!(norm > 0.5) || !(norm < 2.0)) {
    ++counts["imu_orientation_invalid"];
    return std::nullopt;
  }
  if (is_off_unit(rotation)) rotation.normalize();
  return rotation;
}

/// Reads the IMU below `path` of a robot's state.
bool state_imu(const MessageView& message, std::string_view path, ImuSample& sample,
               EventCounts& counts) {
  const std::string prefix = std::string(path) + '.';
  const auto turn = message.numbers(prefix + "gyroscope");
  const auto force = message.numbers(prefix + "accelerometer");
  const auto q = message.numbers(prefix + "quaternion");
  if (!turn || !force || !q) return false;
  if (turn->size() != 3 || force->size() != 3 || q->size() != 4) return false;
  sample.angular_velocity = Eigen::Vector3d(turn->data());
  sample.specific_force = Eigen::Vector3d(force->data());
  sample.orientation =
      valid_orientation(Eigen::Quaterniond((*q)[0], (*q)[1], (*q)[2], (*q)[3]), counts);
  return true;
}

}  // namespace

std::optional<Time> recorded_stamp(const MessageView& message) {
  for (const std::string_view path : {"header.stamp", "stamp", "readings[0].header.stamp"}) {
    if (const auto stamp = message.time(path)) return stamp;
  }
  const auto seconds = message.number("stamp.sec");
  const auto rest = message.number("stamp.nanosec");
  if (!seconds || !rest) return std::nullopt;
  return static_cast<Time>(*seconds) * kSecond + static_cast<Time>(*rest);
}

Time header_stamp(const MessageView& message, Time record_time) {
  return recorded_stamp(message).value_or(record_time);
}

std::optional<std::vector<double>> numbers_at(const MessageView& message, std::string_view path) {
  if (const auto parts = entries_of(path)) {
    if (const auto table = message.table(parts->array)) return column_of(*table, parts->field);
    return each_entry<double>(message, *parts, [](const MessageView& entry, std::string_view f) {
      return entry.number(f);
    });
  }
  if (auto numbers = message.numbers(path)) return numbers;
  const auto bytes = message.bytes(path);
  if (!bytes) return std::nullopt;
  std::vector<double> numbers;
  for (const std::byte each : *bytes) numbers.push_back(std::to_integer<int>(each));
  return numbers;
}

std::optional<std::vector<std::string_view>> texts_at(const MessageView& message,
                                                      std::string_view path) {
  const auto parts = entries_of(path);
  if (!parts) return message.texts(path);
  return each_entry<std::string_view>(
      message, *parts, [](const MessageView& entry, std::string_view f) { return entry.text(f); });
}

std::optional<std::vector<Eigen::Vector3d>> points_at(const MessageView& message,
                                                      std::string_view path) {
  if (const auto parts = entries_of(path)) {
    return each_entry<Eigen::Vector3d>(
        message, *parts,
        [](const MessageView& entry, std::string_view f) { return vector_at(entry, f); });
  }
  const auto numbers = message.numbers(path);
  if (!numbers || numbers->size() % 3 != 0) return std::nullopt;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < numbers->size(); i += 3) points.emplace_back(&(*numbers)[i]);
  return points;
}

std::optional<Eigen::Vector3d> vector_at(const MessageView& message, std::string_view path) {
  const std::string prefix = path.empty() ? std::string() : std::string(path) + '.';
  const auto x = message.number(prefix + "x");
  const auto y = message.number(prefix + "y");
  const auto z = message.number(prefix + "z");
  if (!x || !y || !z) return std::nullopt;
  return Eigen::Vector3d(*x, *y, *z);
}

std::optional<Eigen::Quaterniond> quaternion_at(const MessageView& message, std::string_view path) {
  const auto axis = vector_at(message, path);
  const auto w = message.number(std::string(path) + ".w");
  if (!axis || !w) return std::nullopt;
  return Eigen::Quaterniond(*w, axis->x(), axis->y(), axis->z());
}

std::vector<FrameTransform> transforms_in(const MessageView& message) {
  constexpr std::size_t kMaxTransforms = 1000;
  std::vector<FrameTransform> transforms;
  for (const MessageView& each : message.messages("transforms").value_or(NoMessages())) {
    const auto parent = each.text("header.frame_id");
    const auto child = each.text("child_frame_id");
    const auto translation = vector_at(each, "transform.translation");
    const auto rotation = quaternion_at(each, "transform.rotation");
    if (!parent || !child || !translation || !rotation) break;
    if (transforms.size() == kMaxTransforms) break;
    transforms.push_back({*parent, *child, {*rotation, *translation}});
  }
  return transforms;
}

bool is_off_unit(const Eigen::Quaterniond& rotation) {
  return !(std::abs(rotation.norm() - 1.0) <= 1e-9);
}

std::optional<Eigen::Quaterniond> imu_orientation(const MessageView& message, EventCounts& counts) {
  auto rotation = quaternion_at(message, "orientation");
  const auto covariance = message.numbers("orientation_covariance");
  const bool estimated = !covariance || covariance->empty() || covariance->front() != -1.0;
  if (!rotation || !estimated) return std::nullopt;
  return valid_orientation(*rotation, counts);
}

std::optional<ImuSample> imu_at(const MessageView& message, Time record_time, EventCounts& counts) {
  ImuSample sample;
  sample.stamp = header_stamp(message, record_time);
  const auto turn = vector_at(message, "angular_velocity");
  const auto force = vector_at(message, "linear_acceleration");
  if (turn && force) {
    sample.angular_velocity = *turn;
    sample.specific_force = *force;
    sample.orientation = imu_orientation(message, counts);
    return sample;
  }
  for (const std::string_view imu : robot_imus()) {
    if (state_imu(message, imu, sample, counts)) return sample;
  }
  return std::nullopt;
}

std::optional<Pose> message_pose(const MessageView& message, std::string_view path,
                                 EventCounts& counts) {
  const std::string prefix(path);
  auto position = vector_at(message, prefix + ".position");
  auto rotation = quaternion_at(message, prefix + ".orientation");
  if (!position) position = vector_at(message, prefix + ".translation");
  if (!rotation) rotation = quaternion_at(message, prefix + ".rotation");
  if (!position || !rotation) return std::nullopt;
  Pose pose{*rotation, *position};
  const double norm = pose.rotation.norm();
  if (!(norm > 0.5) || !(norm < 2.0)) {
    ++counts["pose_without_rotation"];
    pose.rotation.setIdentity();
  } else if (is_off_unit(pose.rotation)) {
    pose.rotation.normalize();
  }
  return pose;
}

}  // namespace aims
