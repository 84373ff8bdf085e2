// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "recordings/inspection/bag_check.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {

/// The topics of a bag that the checks refer to.
struct Inventory {
  const BagInfo* bag = nullptr;
  const CloudInfo* cloud = nullptr;        ///< the topic with the most clouds
  const TopicInfo* cloud_times = nullptr;  ///< of that topic
  const ImuInfo* imu = nullptr;            ///< the fastest
  const TopicInfo* imu_times = nullptr;    ///< of that topic
};

Inventory inventory_of(const BagInfo& bag);

/// Checks the requirements of one system, one call per requirement. `without` is the outcome when
/// the bag does not meet it.
class SystemCheck {
 public:
  SystemCheck(std::string system, const Inventory& bag, std::vector<RequirementCheck>& out)
      : system_(std::move(system)), bag_(bag), out_(out) {}

  /// False when there are no clouds: missing.
  bool clouds();
  /// The same of a system that also runs on an IMU and legs alone: poor, or met when the
  /// configuration asks for no LiDAR.
  bool clouds_or_legs();
  void point_times(Fulfilment without, const std::string& remedy);
  void rings(Fulfilment without, const std::string& remedy);
  /// A field of exactly that name and type, for readers that map structs.
  void exact_field(const std::string& name, const std::string& type, Fulfilment without);
  void dense();
  /// An IMU that covers all clouds: missing below `min_hz`, poor below `good_hz`.
  void imu(double min_hz, double good_hz);
  void imu_in_si();
  void orientation();
  void static_start();
  void extrinsics(const std::string& remedy);
  /// Joint angles and foot forces as Unitree's robots publish them.
  void unitree_state();
  void legs();
  /// `without_lidar`: the system also runs without one.
  void readable(bool without_lidar);

 private:
  void imu_coverage();
  bool has_legs() const;
  bool has_type(const std::string& type) const;
  void met(const std::string& requirement, const std::string& found);
  void add(Fulfilment fulfilment, const std::string& requirement, const std::string& found,
           const std::string& remedy);

  std::string system_;
  const Inventory& bag_;
  std::vector<RequirementCheck>& out_;
};

}  // namespace aims
