// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/scoring_config.hpp"

#include "bench/scenario/scenario.hpp"
#include "core/files/yaml_config.hpp"

namespace aims {
namespace {

/// The part of a configuration that scoring reads.
struct ScoringSettings {
  ScoreConfig scoring;
};

void describe(Fields& fields, ScoringSettings& settings) {
  fields.group("scoring", settings.scoring);
}

}  // namespace

Result<ScoreConfig> scoring_config(const std::filesystem::path& file,
                                   std::span<const std::string> overrides) {
  ScoringSettings settings;
  if (!file.empty()) {
    Scenario scenario;
    if (auto loaded = load_config(file, scenario); !loaded) return tl::unexpected(loaded.error());
    settings.scoring = scenario.scoring;
  }
  auto applied = apply_overrides(settings, overrides);
  if (!applied) return tl::unexpected(applied.error());
  return settings.scoring;
}

}  // namespace aims
