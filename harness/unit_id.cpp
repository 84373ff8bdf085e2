// SPDX-License-Identifier: BSD-3-Clause
#include "harness/unit_id.hpp"

#include <fmt/format.h>

#include "harness/code_version.hpp"
#include "harness/estimator_spec.hpp"

namespace aims {
namespace {

/// http://www.isthe.com/chongo/tech/comp/fnv
std::uint64_t fnv1a(std::string_view text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 1099511628211ULL;
  }
  return hash;
}

/// The scenario with what does not change a run's numbers taken out.
std::string deciding_text(const Scenario& scenario, const EstimatorConfig& estimator) {
  Scenario bare;
  bare.simulation = scenario.simulation;
  bare.estimator = estimator;
  bare.scoring = scenario.scoring;
  return config_text(bare);
}

}  // namespace

std::string text_hash(std::string_view text) { return fmt::format("{:016x}", fnv1a(text)); }

std::string unit_id(const Scenario& scenario, std::uint64_t seed, const std::string& estimator) {
  const auto spec = parse_estimator_spec(estimator);
  const Result<EstimatorConfig> own =
      spec ? config_with(*spec, scenario.estimator) : scenario.estimator;
  return text_hash(fmt::format("{}\n{}\n{}\n{}", code_version(), seed,
                               spec ? spec->name : estimator, deciding_text(scenario, *own)));
}

}  // namespace aims
