// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/inspection/bag_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "recordings/inspection/system_check.hpp"

namespace aims {
namespace {

void check_fast_lio2(SystemCheck check) {
  if (check.clouds()) {
    check.point_times(Fulfilment::kPoor, "it falls back to azimuths, ring by ring");
    check.rings(Fulfilment::kPoor, "its Velodyne reader uses it if times are missing");
  }
  check.imu(50.0, 100.0);
  check.imu_in_si();
  check.static_start();
  check.extrinsics("set extrinsic_T and extrinsic_R, or extrinsic_est_en");
}

void check_lio_sam(SystemCheck check) {
  if (check.clouds()) {
    check.dense();
    check.exact_field("ring", "uint16", Fulfilment::kMissing);
    check.point_times(Fulfilment::kPoor, "it then does not deskew");
  }
  check.imu(50.0, 200.0);
  check.imu_in_si();
  check.orientation();
  check.extrinsics("set extrinsicRot, extrinsicRPY and extrinsicTrans");
}

void check_lego_loam(SystemCheck check) {
  check.clouds();
  check.rings(Fulfilment::kPoor, "it computes rings from the elevation of a level 16-ring LiDAR");
}

void check_lins(SystemCheck check) {
  check.clouds();
  check.rings(Fulfilment::kPoor, "it computes rings from the elevation of a level 16-ring LiDAR");
  check.imu(50.0, 100.0);
  check.imu_in_si();
  check.extrinsics("set the transform in its parameter file");
}

void check_loam(SystemCheck check) {
  check.clouds();
  check.rings(Fulfilment::kPoor, "it computes rings from the elevation of a level LiDAR");
}

void check_leg_kilo(SystemCheck check) {
  if (check.clouds()) {
    check.point_times(Fulfilment::kMissing, "enable it in the LiDAR's driver");
    check.rings(Fulfilment::kPoor, "enable it in the LiDAR's driver");
  }
  check.imu(50.0, 100.0);
  check.imu_in_si();
  check.unitree_state();
  check.extrinsics("set the transform in its parameter file");
}

void check_own(SystemCheck check, bool with_legs) {
  check.readable(with_legs);
  const bool clouds = with_legs ? check.clouds_or_legs() : check.clouds();
  if (clouds) {
    check.point_times(Fulfilment::kPoor,
                      "times are derived from azimuths: deskewing is approximate");
  }
  check.imu(20.0, 50.0);
  if (with_legs) check.legs();
  check.static_start();
  if (clouds) check.extrinsics("set recording.T_imu_lidar");
}

/// The worst outcome of a system's requirements.
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
  check_own({"aims_d", bag, checks}, true);
  check_own({"aims", bag, checks}, true);
  check_own({"lio", bag, checks}, false);
  check_fast_lio2({"FAST-LIO2", bag, checks});
  check_lio_sam({"LIO-SAM", bag, checks});
  check_lego_loam({"LeGO-LOAM", bag, checks});
  check_lins({"LINS", bag, checks});
  check_loam({"LOAM", bag, checks});
  check_leg_kilo({"Leg-KILO", bag, checks});
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
    const std::string found = each.found.empty() ? "" : fmt::format("found {}; ", each.found);
    text +=
        fmt::format("{}: {}: {}: {}{}\n", each.system, word, each.requirement, found, each.remedy);
  }
  return text;
}

}  // namespace aims
