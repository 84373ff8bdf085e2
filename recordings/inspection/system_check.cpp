// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/system_check.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace aims {
namespace {

constexpr double kMinStaticStart = 2.0;  ///< [s]

/// Of new samples [Hz].
double rate_of(const ImuInfo& imu, const TopicInfo& times) {
  return imu.new_rate_hz.value_or(times.rate_hz.value_or(0.0));
}

}  // namespace

Inventory inventory_of(const BagInfo& bag) {
  Inventory found{&bag};
  for (const CloudInfo& each : bag.clouds) {
    const TopicInfo* times = bag.find(each.topic);
    if (each.clouds == 0 || (found.cloud && times->messages <= found.cloud_times->messages))
      continue;
    found.cloud = &each;
    found.cloud_times = times;
  }
  for (const ImuInfo& each : bag.imus) {
    const TopicInfo* times = bag.find(each.topic);
    if (found.imu && rate_of(each, *times) <= rate_of(*found.imu, *found.imu_times)) continue;
    found.imu = &each;
    found.imu_times = times;
  }
  return found;
}

bool SystemCheck::clouds() {
  if (bag_.cloud) {
    met("3-D LiDAR clouds",
        fmt::format("{}, {:.0f} points", bag_.cloud->topic, bag_.cloud->mean_points));
    if (!bag_.cloud->repeated_text.empty()) {
      add(Fulfilment::kPoor, "clouds that are new", "", bag_.cloud->repeated_text);
    }
    return true;
  }
  add(Fulfilment::kMissing, "3-D LiDAR clouds", "none",
      "record sensor_msgs/PointCloud2 or livox CustomMsg");
  return false;
}

bool SystemCheck::clouds_or_legs() {
  const bool unused = !bag_.bag->refusal && bag_.bag->used.lidar.empty();
  if (!bag_.imu || !has_legs()) return clouds();
  if (unused) {
    met("3-D LiDAR clouds", "not used (topics.lidar: none)");
    return false;
  }
  if (!bag_.bag->opens_without_lidar) return clouds();
  add(Fulfilment::kPoor, "3-D LiDAR clouds", "none",
      "--set recording.topics.lidar=none estimates from IMU and legs alone, which drift");
  return false;
}

void SystemCheck::point_times(Fulfilment without, const std::string& remedy) {
  if (!bag_.cloud) return;
  if (const auto* field = bag_.cloud->time_field()) {
    const bool wrong = bag_.cloud->topic == bag_.bag->used.lidar && !bag_.bag->times_text.empty();
    if (wrong) return add(Fulfilment::kPoor, "time of each point", "", bag_.bag->times_text);
    return met("time of each point", field->name + " " + field->type);
  }
  add(without, "time of each point", "no such field", remedy);
}

void SystemCheck::rings(Fulfilment without, const std::string& remedy) {
  if (!bag_.cloud) return;
  const auto* field = bag_.cloud->ring_field();
  const bool lines = field != nullptr && field->name == "line";  // of a Livox
  if (field && !lines) return met("ring of each point", field->name + " " + field->type);
  if (bag_.cloud->height > 1) return met("ring of each point", "rows of the organised cloud");
  add(without, "ring of each point", lines ? "lines, which are no rings" : "no such field", remedy);
}

void SystemCheck::exact_field(const std::string& name, const std::string& type,
                              Fulfilment without) {
  if (!bag_.cloud) return;
  const PointFieldInfo* field = bag_.cloud->find(name);
  const std::string required = fmt::format("field '{}' as {}", name, type);
  if (field && field->type == type) return met(required, fmt::format("at {}", field->offset));
  add(without, required, field ? "as " + field->type : "no such field",
      "rename or convert the field");
}

void SystemCheck::dense() {
  if (!bag_.cloud) return;
  if (bag_.cloud->dense && bag_.cloud->not_finite_fraction == 0.0) {
    return met("dense clouds", "no NaN");
  }
  add(Fulfilment::kMissing, "dense clouds",
      fmt::format("is_dense {}, {:.1f} % NaN", bag_.cloud->dense,
                  100.0 * bag_.cloud->not_finite_fraction),
      "it stops at the first cloud that is not dense: drop the misses");
}

void SystemCheck::imu(double min_hz, double good_hz) {
  if (!bag_.imu) {
    return add(Fulfilment::kMissing, "IMU", "none", "record sensor_msgs/Imu");
  }
  const double rate = rate_of(*bag_.imu, *bag_.imu_times);
  const std::string found = fmt::format("{} at {:.0f} Hz", bag_.imu->topic, rate);
  const std::string required = fmt::format("IMU of {:.0f} Hz or more", good_hz);
  if (rate >= 0.95 * good_hz) {
    met(required, found);
  } else {
    add(rate >= 0.95 * min_hz ? Fulfilment::kPoor : Fulfilment::kMissing, required, found,
        "record the IMU at its full rate; of a simulation: --fast-imu 200");
  }
  imu_coverage();
}

void SystemCheck::imu_in_si() {
  if (!bag_.imu) return;
  if (!bag_.imu->in_g) return met("IMU in m/s^2", "yes");
  add(Fulfilment::kMissing, "IMU in m/s^2", "in g", "multiply the specific force by 9.80665");
}

void SystemCheck::orientation() {
  if (!bag_.imu) return;
  if (bag_.imu->oriented) return met("orientation of the IMU", "unit quaternions");
  add(Fulfilment::kMissing, "orientation of the IMU", "no unit quaternion",
      "use a 9-axis IMU or add an attitude filter");
}

void SystemCheck::static_start() {
  const auto* interval =
      bag_.imu && bag_.imu->static_interval ? &*bag_.imu->static_interval : nullptr;
  if (interval && interval->begin_s < 1.0 && interval->length_s >= kMinStaticStart) {
    return met("static start", fmt::format("{:.1f} s", interval->length_s));
  }
  add(Fulfilment::kPoor, "static start", "motion within the first seconds",
      fmt::format("let the robot stand for {:.0f} s before it walks", kMinStaticStart));
}

void SystemCheck::extrinsics(const std::string& remedy) {
  if (bag_.bag->extrinsics_configured) {
    return met("LiDAR to IMU transform", "T_imu_lidar of the configuration");
  }
  const auto& known = bag_.bag->transforms;
  if (std::any_of(known.begin(), known.end(), [](const auto& each) { return each.fixed; })) {
    return met("LiDAR to IMU transform", "tf_static");
  }
  add(Fulfilment::kPoor, "LiDAR to IMU transform", "no tf_static", remedy);
}

void SystemCheck::unitree_state() {
  constexpr const char* kState = "unitree_legged_msgs/HighState";
  const std::string required = fmt::format("joints and foot forces as {}", kState);
  if (has_type(kState)) return met(required, "recorded");
  const bool others = has_type("sensor_msgs/JointState") && !bag_.bag->used.contacts.empty();
  add(Fulfilment::kMissing, required, others ? "joint states and contacts of other types" : "none",
      "record or convert to that message, which it reads alone");
}

bool SystemCheck::has_legs() const {
  const TopicsConfig& used = bag_.bag->used;
  if (!bag_.bag->leg_lack.empty()) return false;
  return !used.leg_odometry.empty() || (!used.joint_states.empty() && !used.contacts.empty());
}

void SystemCheck::legs() {
  const TopicsConfig& used = bag_.bag->used;
  if (has_legs()) {
    return met("leg odometry",
               used.leg_odometry.empty() ? "from joints and contacts" : used.leg_odometry);
  }
  const std::string& lack = bag_.bag->leg_lack;
  add(Fulfilment::kMissing, "leg odometry", lack.empty() ? "none" : lack,
      "name its topic (--topics leg_odometry=/...), or use the estimator lio");
}

void SystemCheck::readable(bool without_lidar) {
  if (!bag_.bag->refusal) return met("readable by aims", "yes");
  if (without_lidar && bag_.bag->opens_without_lidar) {
    return met("readable by aims", "with recording.topics.lidar=none");
  }
  add(Fulfilment::kMissing, "readable by aims", "", *bag_.bag->refusal);
}

void SystemCheck::imu_coverage() {
  if (!bag_.cloud) return;
  const bool covers = bag_.imu_times->first_stamp <= bag_.cloud_times->first_stamp + kSecond / 10 &&
                      bag_.imu_times->last_stamp + kSecond / 10 >= bag_.cloud_times->last_stamp;
  if (covers) return met("IMU covers all clouds", "yes");
  add(Fulfilment::kPoor, "IMU covers all clouds", "no",
      "start recording the IMU before the LiDAR and stop it after; some systems otherwise wait "
      "forever");
}

bool SystemCheck::has_type(const std::string& type) const {
  const auto& topics = bag_.bag->topics;
  return std::any_of(topics.begin(), topics.end(),
                     [&type](const TopicInfo& each) { return each.type == type; });
}

void SystemCheck::met(const std::string& requirement, const std::string& found) {
  add(Fulfilment::kMet, requirement, found, "");
}

void SystemCheck::add(Fulfilment fulfilment, const std::string& requirement,
                      const std::string& found, const std::string& remedy) {
  out_.push_back({system_, requirement, fulfilment, found, remedy});
}

}  // namespace aims
