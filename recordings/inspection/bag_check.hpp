// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/files/table.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {

/// Whether a bag meets a requirement.
enum class Fulfilment {
  kMet,
  kPoor,     ///< the system runs, with reduced accuracy
  kMissing,  ///< the system does not run, or its result is unusable
};

/// One requirement of a system, and how the bag meets it.
struct RequirementCheck {
  std::string system;
  std::string requirement;  ///< e.g. "ring of each point (uint16)"
  Fulfilment fulfilment = Fulfilment::kMet;
  std::string found;   ///< e.g. "/imu/data at 50 Hz"; empty: the remedy says it
  std::string remedy;  ///< if poor or missing
};

/// Checks the bag against the requirements of FAST-LIO2, LIO-SAM, LeGO-LOAM, LINS, LOAM, Leg-KILO
/// and AIMS.
std::vector<RequirementCheck> check_bag(const BagInfo& info);

/// A row per system: runs, runs poorly, or cannot run.
TextTable check_table(const std::vector<RequirementCheck>& checks);

/// The poor and missing requirements with their remedies, by system.
std::string check_text(const std::vector<RequirementCheck>& checks);

}  // namespace aims
