// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/registry.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "estimator/aims/constrained_lio.hpp"
#include "estimator/aims/eskf_estimator.hpp"
#include "estimator/aims/leg_dead_reckoning.hpp"
#include "estimator/aims/presets.hpp"
#include "estimator/baselines/bievr/bievr.hpp"
#include "estimator/baselines/fast_lio2/fast_lio2.hpp"
#include "estimator/baselines/leg_kilo/leg_kilo.hpp"
#include "estimator/baselines/lego_loam/lego_loam.hpp"
#include "estimator/baselines/lins/lins.hpp"
#include "estimator/baselines/lio_sam/lio_sam.hpp"
#include "estimator/baselines/loam/loam.hpp"
#include "estimator/python/python_estimator.hpp"

namespace aims {
namespace {

/// An entry whose estimator `Made` has the configuration that `config` returns.
template <class Made, class MakeConfig>
EstimatorEntry entry(std::string_view name, std::string_view description, MakeConfig config,
                     std::string_view preset_of = "") {
  using Config = decltype(config());
  return {name, description, preset_of, [config]() -> std::unique_ptr<EstimatorConfig> {
            return std::make_unique<ConfigOf<Config, Made>>(config());
          }};
}

/// The compared systems of others, which `aims run` leaves out unless they are named.
void add_baselines(std::vector<EstimatorEntry>& all) {
  all.push_back(entry<fast_lio2::FastLio2>("fast_lio2", "FAST-LIO2, set for a narrow corridor",
                                           [] { return fast_lio2::Config(); }));
  all.push_back(entry<fast_lio2::FastLio2>("fast_lio2_published",
                                           "FAST-LIO2 with its published defaults",
                                           fast_lio2::published, "fast_lio2"));
  all.push_back(
      entry<loam::Loam>("loam", "LOAM without IMU, set for a narrow corridor", loam::corridor));
  all.push_back(entry<loam::Loam>(
      "loam_published", "LOAM without IMU, with its published defaults",
      [] { return loam::Config(); }, "loam"));
  all.push_back(entry<loam::Loam>("a_loam", "A-LOAM, the published program without IMU",
                                  loam::a_loam, "loam"));
  all.push_back(entry<lego_loam::LegoLoam>(
      "lego_loam", "LeGO-LOAM without IMU, set for a narrow corridor", lego_loam::corridor));
  all.push_back(entry<lego_loam::LegoLoam>(
      "lego_loam_published", "LeGO-LOAM without IMU, with its published defaults",
      [] { return lego_loam::Config(); }, "lego_loam"));
  all.push_back(entry<leg_kilo::LegKilo>("leg_kilo", "Leg-KILO, set for a narrow corridor",
                                         [] { return leg_kilo::Config(); }));
  all.push_back(entry<leg_kilo::LegKilo>("leg_kilo_published",
                                         "Leg-KILO with its published defaults",
                                         leg_kilo::published, "leg_kilo"));
  all.push_back(
      entry<lins::Lins>("lins", "LINS without loops, set for a narrow corridor", lins::corridor));
  all.push_back(entry<lins::Lins>(
      "lins_published", "LINS with its published defaults, loops among them",
      [] { return lins::Config(); }, "lins"));
  all.push_back(
      entry<lio_sam::LioSam>("lio_sam", "LIO-SAM, set for a narrow corridor", lio_sam::corridor));
  all.push_back(entry<lio_sam::LioSam>(
      "lio_sam_published", "LIO-SAM with its published defaults", [] { return lio_sam::Config(); },
      "lio_sam"));
  all.push_back(entry<ConstrainedLio>(
      "x_icp", "lio with the update of X-ICP, set for a narrow corridor", x_icp_in_corridor));
  all.push_back(entry<ConstrainedLio>("x_icp_published",
                                      "lio with the update of X-ICP and its published thresholds",
                                      x_icp_published, "x_icp"));
  all.push_back(entry<ConstrainedLio>(
      "dcreg", "lio with the update of DCReg: preconditioned by Schur complements", dcreg_on_lio));
  all.push_back(entry<bievr::Bievr>("bievr",
                                    "BIEVR-LIO: scans matched with images of the relief of walls",
                                    [] { return bievr::Config(); }));
}

std::vector<EstimatorEntry> entries() {
  std::vector<EstimatorEntry> all;
  for (const EskfPreset& preset : eskf_presets()) {
    all.push_back(entry<EskfEstimator>(preset.name, preset.description, preset.config));
  }
  all.push_back(entry<LegDeadReckoning>("leg", "leg odometry alone, as the robot reports it",
                                        [] { return LegDeadReckoningConfig(); }));
  add_baselines(all);
  return all;
}

}  // namespace

std::span<const EstimatorEntry> estimator_registry() {
  static const std::vector<EstimatorEntry> all = entries();
  return all;
}

std::vector<std::string> estimator_names() {
  std::vector<std::string> names;
  for (const EstimatorEntry& each : estimator_registry()) names.emplace_back(each.name);
  return names;
}

std::vector<std::string> system_names() {
  std::vector<std::string> names;
  for (const EstimatorEntry& each : estimator_registry()) {
    if (each.preset_of.empty()) names.emplace_back(each.name);
  }
  return names;
}

Result<void> check_estimator_name(std::string_view name) {
  const std::vector<std::string> known = estimator_names();
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  const std::string near = near_match(name, known);
  return failure(fmt::format("no estimator '{}'; expected one of {}{}", name,
                             fmt::join(known, ", "),
                             near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

EstimatorConfigs::EstimatorConfigs() {
  for (const EstimatorEntry& entry : estimator_registry()) {
    configs_.emplace(entry.name, entry.config());
  }
}

EstimatorConfigs::EstimatorConfigs(const EstimatorConfigs& other) {
  for (const auto& [name, config] : other.configs_) configs_.emplace(name, config->clone());
}

EstimatorConfigs& EstimatorConfigs::operator=(const EstimatorConfigs& other) {
  if (this != &other) *this = EstimatorConfigs(other);
  return *this;
}

Result<void> EstimatorConfigs::add_python(std::string_view name) {
  if (!is_python_name(name) || configs_.contains(name)) return {};
  auto config = PythonConfig::load(name);
  if (!config) return tl::unexpected(config.error());
  configs_.emplace(name, std::make_unique<PythonConfig>(std::move(*config)));
  return {};
}

EstimatorConfig* EstimatorConfigs::find(std::string_view name) {
  const auto found = configs_.find(name);
  return found == configs_.end() ? nullptr : found->second.get();
}

const EstimatorConfig* EstimatorConfigs::find(std::string_view name) const {
  const auto found = configs_.find(name);
  return found == configs_.end() ? nullptr : found->second.get();
}

void describe(Fields& fields, EstimatorConfigs& configs) {
  for (const EstimatorEntry& entry : estimator_registry()) {
    fields.group_of(entry.name, fields_of(*configs.find(entry.name)));
  }
}

Result<std::unique_ptr<Estimator>> make_estimator(std::string_view name, const SensorRig& rig) {
  if (auto known = check_estimator_name(name); !known) return tl::unexpected(known.error());
  const EstimatorConfigs defaults;
  return defaults.find(name)->create(rig);
}

}  // namespace aims
