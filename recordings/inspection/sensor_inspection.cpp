// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/sensor_inspection.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "core/median.hpp"
#include "recordings/clouds/point_table.hpp"
#include "recordings/messages/message_values.hpp"
#include "recordings/messages/point_layout.hpp"
#include "recordings/stream/gravity_unit.hpp"

namespace aims {
namespace {

/// The ROS driver that names the fields of its points so ("ouster-ros"); empty: none that is known.
std::string_view driver_of(const PointTable& table) {
  if (table.find("offset_time") != nullptr && table.find("line") != nullptr) {
    return "livox_ros_driver, CustomMsg";
  }
  for (const CloudLayout layout :
       {CloudLayout::kOuster, CloudLayout::kLivox, CloudLayout::kHesai, CloudLayout::kVelodyne}) {
    const PointLayout known = point_layout(layout);
    const bool all = std::ranges::all_of(known.fields, [&](const PointFieldLayout& field) {
      return table.find(field.name) != nullptr;
    });
    if (all) return known.driver;
  }
  return {};
}

constexpr std::uint64_t kMaxClouds = 20;
constexpr std::size_t kUnitSamples = 100;  ///< of an IMU, to find its unit

std::vector<double> numbers_of(const ImuSample& sample) {
  std::vector<double> numbers(sample.angular_velocity.begin(), sample.angular_velocity.end());
  numbers.insert(numbers.end(), sample.specific_force.begin(), sample.specific_force.end());
  return numbers;
}

}  // namespace

CloudInspection::CloudInspection(std::string topic) { info_.topic = std::move(topic); }

void CloudInspection::add(const MessageView& message, Time stamp) {
  auto table = point_table(message);
  const bool examined = info_.clouds < kMaxClouds;
  if (!table && examined) {
    ++info_.broken;
    info_.first_broken = info_.first_broken.empty() ? table.error().message : info_.first_broken;
  }
  if (!table) return;
  table->stamp = stamp;
  repeats_.add(*table);
  if (examined) add_layout(*table, message);
}

void CloudInspection::add_layout(const PointTable& table, const MessageView& message) {
  if (info_.clouds++ == 0) {
    info_.height = table.height;
    info_.driver = driver_of(table);
    info_.point_step = table.point_step;
    info_.dense = message.number("is_dense").value_or(1.0) != 0.0;
    for (const ColumnLayout& each : table.columns) {
      info_.fields.push_back({each.name, std::string(name_of(each.type)), each.offset});
    }
  }
  points_ += table.size();
  const PointField x(table, *table.find("x"));
  for (std::size_t i = 0; i < table.size(); ++i) {
    not_finite_ += std::isfinite(x.at(table.point(i))) ? 0 : 1;
  }
}

CloudInfo CloudInspection::finish() const {
  CloudInfo info = info_;
  if (repeats_.found())
    info.repeated_text = repeated_clouds_text(info.topic, repeats_.repeated(), repeats_.clouds());
  if (info.clouds > 0) {
    info.mean_points = static_cast<double>(points_) / static_cast<double>(info.clouds);
  }
  if (points_ > 0) {
    info.not_finite_fraction = static_cast<double>(not_finite_) / static_cast<double>(points_);
  }
  return info;
}

ImuInspection::ImuInspection(std::string topic) { info_.topic = std::move(topic); }

void ImuInspection::add(const MessageView& message, Time stamp) {
  EventCounts ignored;
  auto sample = imu_at(message, stamp, ignored);
  if (!sample || !sample->specific_force.allFinite()) return;
  sample->stamp = stamp;
  if (unit_known_) return add_in_si(*sample);
  first_.push_back(*sample);
  info_.oriented = sample->orientation.has_value();
  if (first_.size() == kUnitSamples) decide_unit();
}

ImuInfo ImuInspection::finish() {
  if (!unit_known_) decide_unit();
  info_.static_interval = static_intervals_.longest();
  return info_;
}

/// Finds the unit from the norm of the first samples, which is near one g.
void ImuInspection::decide_unit() {
  std::vector<double> norms;
  for (const ImuSample& each : first_) norms.push_back(each.specific_force.norm());
  const double typical = upper_median(norms).value_or(kStandardGravity);
  info_.in_g = is_in_gravities(typical);
  unit_known_ = true;
  RepeatFinder finder;
  for (const ImuSample& each : first_) finder.add(each.stamp, numbers_of(each));
  if (const auto period = finder.period()) {
    repeats_.emplace(*period);
    info_.new_rate_hz = 1.0 / to_seconds(*period);
  }
  for (const ImuSample& each : first_) add_in_si(each);
  first_.clear();
}

/// A sample that is sent again is no further one.
void ImuInspection::add_in_si(ImuSample sample) {
  if (repeats_ && repeats_->repeats(sample.stamp, numbers_of(sample))) return;
  if (info_.in_g) sample.specific_force *= kStandardGravity;
  static_intervals_.add(sample);
}

}  // namespace aims
