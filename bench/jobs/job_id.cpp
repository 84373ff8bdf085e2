// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job_id.hpp"

#include <fmt/format.h>

#include "bench/run/code_version.hpp"
#include "core/files/config_dump.hpp"
#include "core/text.hpp"

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

std::string key_of(std::string_view name, std::string_view config) {
  return fmt::format("{}\n{}", name, text_hash(config));
}

}  // namespace

std::string text_hash(std::string_view text) { return fmt::format("{:016x}", fnv1a(text)); }

JobIds::JobIds(const Scenario& scenario) : estimators_(scenario.estimators) {
  // What does not change a run's numbers, and the estimators, are left out.
  Scenario bare;
  bare.run.clear();
  bare.simulation = scenario.simulation;
  bare.scoring = scenario.scoring;
  scenario_key_ = text_hash(config_text(bare));
}

Result<std::string> JobIds::estimator_key(const EstimatorSpec& estimator) const {
  auto config = config_with(estimator, estimators_);
  if (!config) return tl::unexpected(config.error());
  return key_of(estimator.name, dump_config(fields_of(**config)));
}

std::string JobIds::version(const std::string& estimator_key) const {
  return text_hash(fmt::format("{}\n{}", scenario_key_, estimator_key));
}

std::string JobIds::id(std::uint64_t seed, const std::string& estimator_key) const {
  return text_hash(
      fmt::format("{}\n{}\n{}\n{}", code_version(), seed, scenario_key_, estimator_key));
}

std::string job_id(const Scenario& scenario, std::uint64_t seed, const std::string& estimator) {
  const JobIds ids(scenario);
  const auto spec = parse_estimator_spec(estimator);
  const auto key = spec ? ids.estimator_key(*spec) : tl::unexpected(spec.error());
  return ids.id(seed, key ? *key : key_of(estimator, ""));
}

Result<Shard> parse_shard(std::string_view text) {
  std::string_view count = text;
  const Shard shard{number_from<int>(take_until(count, '/')).value_or(0),
                    number_from<int>(count).value_or(0)};
  if (shard.index >= 1 && shard.index <= shard.count) return shard;
  return failure(fmt::format("--shard: expected I/N with I from 1 to N, e.g. 2/8, got '{}'", text));
}

std::span<const Job> part_of(std::span<const Job> jobs, const Shard& shard) {
  const auto border = [&](int index) {
    return jobs.size() * static_cast<std::size_t>(index) / static_cast<std::size_t>(shard.count);
  };
  return jobs.subspan(border(shard.index - 1), border(shard.index) - border(shard.index - 1));
}

}  // namespace aims
