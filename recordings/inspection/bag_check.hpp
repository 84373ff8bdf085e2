// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/files/table.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {

/// Whether a bag has what a system asks for.
enum class Fulfilment {
  kMet,
  kPoor,     ///< it runs, worse than it could
  kMissing,  ///< it does not run, or gives nonsense
};

/// One thing that a system asks of a bag, and what the bag has of it.
struct RequirementCheck {
  std::string system;
  std::string requirement;  ///< e.g. "ring of each point (uint16)"
  Fulfilment fulfilment = Fulfilment::kMet;
  std::string found;   ///< e.g. "/imu/data at 50 Hz"
  std::string remedy;  ///< of what is poor or missing
};

/// Holds the bag against what FAST-LIO2, LIO-SAM, LeGO-LOAM, LINS, LOAM, Leg-KILO and the
/// estimators here need (docs/decisions.md names the sources).
std::vector<RequirementCheck> check_bag(const BagInfo& info);

/// A row per system: runs, runs poorly, or cannot run.
TextTable check_table(const std::vector<RequirementCheck>& checks);

/// What is poor or missing, with its remedy, system by system.
std::string check_text(const std::vector<RequirementCheck>& checks);

}  // namespace aims
