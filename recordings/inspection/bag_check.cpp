// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/bag_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace aims {
namespace {

constexpr double kEnoughRest = 2.0;  ///< of a standing start [s]

/// What the systems ask for, looked up once.
struct Inventory {
  const BagInfo* bag = nullptr;
  const CloudInfo* cloud = nullptr;        ///< the topic with the most clouds
  const TopicInfo* cloud_times = nullptr;  ///< of that topic
  const ImuInfo* imu = nullptr;            ///< the fastest
  const TopicInfo* imu_times = nullptr;    ///< of that topic
};

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
    if (found.imu && times->rate_hz.value_or(0.0) <= found.imu_times->rate_hz.value_or(0.0))
      continue;
    found.imu = &each;
    found.imu_times = times;
  }
  return found;
}

/// Collects the checks of one system.
class SystemCheck {
 public:
  SystemCheck(std::string system, const Inventory& bag, std::vector<RequirementCheck>& out)
      : system_(std::move(system)), bag_(bag), out_(out) {}

  /// False, and nothing else to ask of clouds, when there are none.
  bool clouds() {
    if (bag_.cloud) {
      met("3-D LiDAR clouds",
          fmt::format("{}, {:.0f} points", bag_.cloud->topic, bag_.cloud->mean_points));
      return true;
    }
    add(Fulfilment::kMissing, "3-D LiDAR clouds", "none",
        "record sensor_msgs/PointCloud2 or livox CustomMsg");
    return false;
  }

  void point_times(Fulfilment without, const std::string& why) {
    if (!bag_.cloud) return;
    if (const auto* field = bag_.cloud->time_field()) {
      return met("time of each point", field->name + " " + field->type);
    }
    add(without, "time of each point", "no such field", why);
  }

  void rings(Fulfilment without, const std::string& why) {
    if (!bag_.cloud) return;
    const auto* field = bag_.cloud->ring_field();
    if (field) return met("ring of each point", field->name + " " + field->type);
    if (bag_.cloud->height > 1) return met("ring of each point", "rows of the organised cloud");
    add(without, "ring of each point", "no such field", why);
  }

  /// A field of exactly that name and type, as readers that map structs want it.
  void exact_field(const std::string& name, const std::string& type, Fulfilment without) {
    if (!bag_.cloud) return;
    const PointFieldInfo* field = bag_.cloud->find(name);
    const std::string wanted = fmt::format("field '{}' as {}", name, type);
    if (field && field->type == type) return met(wanted, fmt::format("at {}", field->offset));
    add(without, wanted, field ? "as " + field->type : "no such field",
        "rename or convert the field on the way");
  }

  void dense() {
    if (!bag_.cloud) return;
    if (bag_.cloud->dense && bag_.cloud->not_finite_share == 0.0) {
      return met("dense clouds", "no NaN");
    }
    add(Fulfilment::kMissing, "dense clouds",
        fmt::format("is_dense {}, {:.1f} % NaN", bag_.cloud->dense,
                    100.0 * bag_.cloud->not_finite_share),
        "it stops at the first cloud that is not dense: drop the misses");
  }

  /// An IMU of at least `least_hz`, good from `good_hz`, that covers all clouds.
  void imu(double least_hz, double good_hz) {
    if (!bag_.imu) {
      return add(Fulfilment::kMissing, "IMU", "none", "record sensor_msgs/Imu");
    }
    const double rate = bag_.imu_times->rate_hz.value_or(0.0);
    const std::string found = fmt::format("{} at {:.0f} Hz", bag_.imu->topic, rate);
    const std::string wanted = fmt::format("IMU of {:.0f} Hz or more", good_hz);
    if (rate >= 0.95 * good_hz) {
      met(wanted, found);
    } else {
      add(rate >= 0.95 * least_hz ? Fulfilment::kPoor : Fulfilment::kMissing, wanted, found,
          "record the IMU at its full rate; of a simulated walk: --fast-imu 200");
    }
    cover();
  }

  void imu_in_si() {
    if (!bag_.imu) return;
    if (!bag_.imu->in_g) return met("IMU in m/s^2", "yes");
    add(Fulfilment::kMissing, "IMU in m/s^2", "in g", "multiply the force by 9.80665");
  }

  void orientation() {
    if (!bag_.imu) return;
    if (bag_.imu->oriented) return met("orientation of the IMU", "unit quaternions");
    add(Fulfilment::kMissing, "orientation of the IMU", "no unit quaternion",
        "it needs a 9-axis IMU: add an attitude filter");
  }

  void standing_start() {
    const bool stands = bag_.imu && bag_.imu->rest && bag_.imu->rest->begin_s < 1.0 &&
                        bag_.imu->rest->length_s >= kEnoughRest;
    if (stands) {
      return met("standing start", fmt::format("{:.1f} s", bag_.imu->rest->length_s));
    }
    add(Fulfilment::kPoor, "standing start", "moves within the first seconds",
        fmt::format("let the robot stand for {:.0f} s before it walks", kEnoughRest));
  }

  void extrinsics(const std::string& remedy) {
    const auto& known = bag_.bag->transforms;
    if (std::any_of(known.begin(), known.end(), [](const auto& each) { return each.fixed; })) {
      return met("LiDAR to IMU transform", "tf_static");
    }
    add(Fulfilment::kPoor, "LiDAR to IMU transform", "no tf_static", remedy);
  }

  void joints_and_contacts() {
    const bool both = has_type("sensor_msgs/JointState") && !bag_.bag->used.contacts.empty();
    if (both) return met("joint states and foot contacts", bag_.bag->used.contacts);
    add(Fulfilment::kMissing, "joint states and foot contacts",
        has_type("sensor_msgs/JointState") ? "joint states only" : "none",
        "record the robot's joint states and foot forces");
  }

  void legs() {
    const TopicsConfig& used = bag_.bag->used;
    if (!used.leg_odometry.empty()) return met("leg odometry", used.leg_odometry);
    if (!used.joint_states.empty() && !used.contacts.empty()) {
      return met("leg odometry", "from joints and contacts");
    }
    add(Fulfilment::kMissing, "leg odometry", "none",
        "name its topic (--topics leg_odometry=/...), or use the estimator lio");
  }

  void readable() {
    if (!bag_.bag->refusal) return met("readable here", "yes");
    add(Fulfilment::kMissing, "readable here", "no", *bag_.bag->refusal);
  }

 private:
  void cover() {
    if (!bag_.cloud) return;
    const bool covers =
        bag_.imu_times->first_stamp <= bag_.cloud_times->first_stamp + kSecond / 10 &&
        bag_.imu_times->last_stamp + kSecond / 10 >= bag_.cloud_times->last_stamp;
    if (covers) return met("IMU covers all clouds", "yes");
    add(Fulfilment::kPoor, "IMU covers all clouds", "no",
        "start recording the IMU before the LiDAR and stop it after; some systems wait for ever");
  }

  bool has_type(const std::string& type) const {
    const auto& topics = bag_.bag->topics;
    return std::any_of(topics.begin(), topics.end(),
                       [&type](const TopicInfo& each) { return each.type == type; });
  }

  void met(const std::string& requirement, const std::string& found) {
    add(Fulfilment::kMet, requirement, found, "");
  }

  void add(Fulfilment fulfilment, const std::string& requirement, const std::string& found,
           const std::string& remedy) {
    out_.push_back({system_, requirement, fulfilment, found, remedy});
  }

  std::string system_;
  const Inventory& bag_;
  std::vector<RequirementCheck>& out_;
};

void check_fast_lio2(SystemCheck check) {
  if (check.clouds()) {
    check.point_times(Fulfilment::kPoor, "it falls back to azimuths, ring by ring");
    check.rings(Fulfilment::kPoor, "its Velodyne reader uses it where times are missing");
  }
  check.imu(50.0, 100.0);
  check.imu_in_si();
  check.standing_start();
  check.extrinsics("set extrinsic_T and extrinsic_R, or extrinsic_est_en");
}

void check_lio_sam(SystemCheck check) {
  if (check.clouds()) {
    check.dense();
    check.exact_field("ring", "uint16", Fulfilment::kMissing);
    check.point_times(Fulfilment::kPoor, "it does not deskew then");
  }
  check.imu(50.0, 200.0);
  check.imu_in_si();
  check.orientation();
  check.extrinsics("set extrinsicRot, extrinsicRPY and extrinsicTrans");
}

void check_lego_loam(SystemCheck check) {
  check.clouds();
  check.rings(Fulfilment::kPoor, "it takes rings from the elevation of a level 16-ring LiDAR");
}

void check_lins(SystemCheck check) {
  check.clouds();
  check.rings(Fulfilment::kPoor, "it takes rings from the elevation of a level 16-ring LiDAR");
  check.imu(50.0, 100.0);
  check.imu_in_si();
  check.extrinsics("set the transform in its parameter file");
}

void check_loam(SystemCheck check) {
  check.clouds();
  check.rings(Fulfilment::kPoor, "it takes rings from the elevation of a level LiDAR");
}

void check_leg_kilo(SystemCheck check) {
  if (check.clouds()) {
    check.point_times(Fulfilment::kMissing, "switch it on in the LiDAR's driver");
    check.rings(Fulfilment::kPoor, "switch it on in the LiDAR's driver");
  }
  check.imu(50.0, 100.0);
  check.imu_in_si();
  check.joints_and_contacts();
  check.extrinsics("set the transform in its parameter file");
}

void check_own(SystemCheck check, bool with_legs) {
  check.readable();
  if (check.clouds()) {
    check.point_times(Fulfilment::kPoor, "times are made up from azimuths: motion blurs a little");
  }
  check.imu(20.0, 50.0);
  if (with_legs) check.legs();
  check.standing_start();
  check.extrinsics("give recording.T_imu_lidar");
}

/// Worst of a system's requirements.
Fulfilment worst_of(const std::vector<RequirementCheck>& checks, const std::string& system) {
  Fulfilment worst = Fulfilment::kMet;
  for (const RequirementCheck& each : checks) {
    if (each.system == system) worst = std::max(worst, each.fulfilment);
  }
  return worst;
}

std::vector<std::string> systems_in(const std::vector<RequirementCheck>& checks) {
  std::vector<std::string> systems;
  for (const RequirementCheck& each : checks) {
    if (systems.empty() || systems.back() != each.system) systems.push_back(each.system);
  }
  return systems;
}

}  // namespace

std::vector<RequirementCheck> check_bag(const BagInfo& info) {
  const Inventory bag = inventory_of(info);
  std::vector<RequirementCheck> checks;
  check_fast_lio2({"FAST-LIO2", bag, checks});
  check_lio_sam({"LIO-SAM", bag, checks});
  check_lego_loam({"LeGO-LOAM", bag, checks});
  check_lins({"LINS", bag, checks});
  check_loam({"LOAM", bag, checks});
  check_leg_kilo({"Leg-KILO", bag, checks});
  check_own({"aims", bag, checks}, true);
  check_own({"aims lio", bag, checks}, false);
  return checks;
}

TextTable check_table(const std::vector<RequirementCheck>& checks) {
  TextTable table;
  table.header = {"system", "runs", "met", "poor", "missing"};
  for (const std::string& system : systems_in(checks)) {
    const auto count = [&](Fulfilment wanted) {
      return std::to_string(std::count_if(checks.begin(), checks.end(), [&](const auto& each) {
        return each.system == system && each.fulfilment == wanted;
      }));
    };
    const Fulfilment worst = worst_of(checks, system);
    const char* runs = worst == Fulfilment::kMet    ? "yes"
                       : worst == Fulfilment::kPoor ? "poorly"
                                                    : "no";
    table.rows.push_back({system, runs, count(Fulfilment::kMet), count(Fulfilment::kPoor),
                          count(Fulfilment::kMissing)});
  }
  return table;
}

std::string check_text(const std::vector<RequirementCheck>& checks) {
  std::string text;
  for (const RequirementCheck& each : checks) {
    if (each.fulfilment == Fulfilment::kMet) continue;
    const char* word = each.fulfilment == Fulfilment::kPoor ? "poor" : "MISSING";
    text += fmt::format("{}: {}: {}: found {}; {}\n", each.system, word, each.requirement,
                        each.found, each.remedy);
  }
  return text;
}

}  // namespace aims
