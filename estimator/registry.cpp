// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/registry.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "estimator/aims/eskf_estimator.hpp"
#include "estimator/aims/leg_dead_reckoning.hpp"

namespace aims {
namespace {

using Factory = std::unique_ptr<Estimator> (*)(const EstimatorConfig&, const SensorRig&);

template <EstimatorVariant variant>
std::unique_ptr<Estimator> eskf(const EstimatorConfig& config, const SensorRig& rig) {
  return std::make_unique<EskfEstimator>(config, variant, rig);
}

std::unique_ptr<Estimator> dead_reckoning(const EstimatorConfig& config, const SensorRig& rig) {
  return std::make_unique<LegDeadReckoning>(config, rig);
}

constexpr std::array kEntries = {
    EstimatorEntry{"aims", "LiDAR, IMU and legs, weighted by the degeneracy index of the paper"},
    EstimatorEntry{"aims_d", "beyond the paper: weights per axis, leg scale, ground constraint"},
    EstimatorEntry{"tfs",
                   "fixed weights, zero-order hold of lost leg packets: the paper's ablation"},
    EstimatorEntry{"tfs_clean", "fixed weights, lost leg packets skipped"},
    EstimatorEntry{"lio", "LiDAR and IMU only, fixed weights", false},
    EstimatorEntry{"leg", "leg odometry alone, as the robot reports it"},
};
constexpr std::array<Factory, kEntries.size()> kFactories = {
    eskf<EstimatorVariant{.adaptive = true}>,
    eskf<EstimatorVariant{.adaptive = false, .directional = true}>,
    eskf<EstimatorVariant{.repeat_lost = true, .adaptive = false}>,
    eskf<EstimatorVariant{.adaptive = false}>,
    eskf<EstimatorVariant{.leg = false, .adaptive = false}>,
    dead_reckoning};

std::string unknown_estimator_message(std::string_view name) {
  std::vector<std::string> names;
  std::string list;
  for (const EstimatorEntry& entry : kEntries) {
    names.emplace_back(entry.name);
    list += (list.empty() ? "" : ", ") + names.back();
  }
  const std::string near = near_match(name, names);
  std::string message = "unknown estimator '" + std::string(name) + "'";
  if (!near.empty()) message += "; did you mean '" + near + "'?";
  return message + " (known: " + list + ")";
}

}  // namespace

std::span<const EstimatorEntry> estimator_registry() { return kEntries; }

bool needs_legs(std::string_view name) {
  const auto entry = std::ranges::find(kEntries, name, &EstimatorEntry::name);
  return entry != kEntries.end() && entry->needs_legs;
}

Result<std::unique_ptr<Estimator>> make_estimator(std::string_view name,
                                                  const EstimatorConfig& config,
                                                  const SensorRig& rig) {
  for (std::size_t i = 0; i < kEntries.size(); ++i) {
    if (kEntries[i].name == name) return kFactories[i](config, rig);
  }
  return failure(unknown_estimator_message(name));
}

}  // namespace aims
