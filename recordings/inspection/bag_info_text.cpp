// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <numbers>

#include "core/files/table.hpp"
#include "core/text.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {
namespace {

std::string number(const std::optional<double>& value, int digits, double factor = 1.0) {
  return value ? decimal_text(factor * *value, digits) : "-";
}

std::string vector_text(const Eigen::Vector3d& v, int digits) {
  return fmt::format("[{}, {}, {}]", decimal_text(v.x(), digits), decimal_text(v.y(), digits),
                     decimal_text(v.z(), digits));
}

std::string head_text(const BagInfo& info) {
  const BagSummary& bag = info.summary;
  return fmt::format("{}: {:.1f} MB, {:.1f} s, {} messages in {} chunks, compression {}\n",
                     info.file.string(), static_cast<double>(bag.file_size) / 1e6,
                     to_seconds(bag.end - bag.start), bag.messages, bag.chunks, bag.compression);
}

std::string topics_text(const BagInfo& info) {
  TextTable table;
  table.header = {"topic",  "type",     "messages",  "Hz",      "gap max s",
                  "lost %", "repeated", "backwards", "delay s", "clock offset s"};
  for (const TopicInfo& each : info.topics) {
    const std::string offset =
        each.median_offset_s ? fmt::format("{} ({} to {})", decimal_text(*each.median_offset_s, 3),
                                           decimal_text(*each.smallest_offset_s, 3),
                                           decimal_text(*each.largest_offset_s, 3))
                             : "-";
    table.rows.push_back({each.topic, each.type, std::to_string(each.messages),
                          number(each.rate_hz, 1), number(each.largest_gap_s, 3),
                          number(each.loss, 2, 100.0), std::to_string(each.repeated),
                          std::to_string(each.backwards), offset,
                          each.clock ? fmt::format("{:+.4f}", each.clock->seconds) : "-"});
  }
  return to_text(table);
}

std::string cloud_text(const CloudInfo& cloud) {
  std::string text = fmt::format("\ncloud {}: {:.0f} points", cloud.topic, cloud.mean_points);
  if (cloud.height > 1) text += fmt::format(" in {} rows", cloud.height);
  if (cloud.not_finite_fraction > 0.0) {
    text += fmt::format(", {:.1f} % not finite", 100.0 * cloud.not_finite_fraction);
  }
  if (!cloud.driver.empty()) text += fmt::format("; fields of {}", cloud.driver);
  text += fmt::format("; {} bytes a point:", cloud.point_step);
  for (const PointFieldInfo& each : cloud.fields) {
    text += fmt::format(" {} {}@{}", each.name, each.type, each.offset);
  }
  return text + "\n";
}

std::string imu_text(const ImuInfo& imu) {
  std::string text = fmt::format("\nIMU {}: specific force in {}, orientation {}\n", imu.topic,
                                 imu.in_g ? "g" : "m/s^2", imu.oriented ? "valid" : "not valid");
  if (!imu.static_interval) return text + "  no interval of a second without motion\n";
  const StaticInterval& interval = *imu.static_interval;
  text += fmt::format("  without motion for {:.1f} s from {:.1f} s on\n", interval.length_s,
                      interval.begin_s);
  text += fmt::format("  gyro bias {} rad/s, noise {} rad/s/sqrt(Hz)\n",
                      vector_text(interval.gyro_bias, 5), vector_text(interval.gyro_noise, 6));
  text += fmt::format("  specific force {} m/s^2 (norm {:.4f}), noise {} m/s^2/sqrt(Hz)\n",
                      vector_text(interval.force, 4), interval.force.norm(),
                      vector_text(interval.force_noise, 5));
  return text;
}

/// Roll, pitch, yaw [deg].
Eigen::Vector3d rpy_deg(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
  return (180.0 / std::numbers::pi) * Eigen::Vector3d(std::atan2(R(2, 1), R(2, 2)),
                                                      std::asin(std::clamp(-R(2, 0), -1.0, 1.0)),
                                                      std::atan2(R(1, 0), R(0, 0)));
}

std::string transform_text(const TransformInfo& each) {
  return fmt::format("  {} -> {}{}: {} m, rpy {} deg\n", each.parent, each.child,
                     each.fixed ? "" : " (moving; first one)",
                     vector_text(each.T_parent_child.translation, 4),
                     vector_text(rpy_deg(each.T_parent_child.rotation), 3));
}

}  // namespace

std::string info_text(const BagInfo& info) {
  std::string text = head_text(info) + topics_text(info);
  for (const CloudInfo& each : info.clouds) text += cloud_text(each);
  for (const ImuInfo& each : info.imus) text += imu_text(each);
  if (!info.transforms.empty()) text += "\ntransforms:\n";
  for (const TransformInfo& each : info.transforms) text += transform_text(each);
  if (!info.notes.empty()) text += "\nread by aims estimate:\n";
  for (const std::string& each : info.notes) text += "  " + each + "\n";
  if (info.refusal) text += "\nnot readable by aims estimate: " + *info.refusal + "\n";
  if (!info.warnings.empty()) text += "\n";
  for (const std::string& each : info.warnings) text += "warning: " + each + "\n";
  return text;
}

}  // namespace aims
