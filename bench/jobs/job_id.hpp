// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "bench/jobs/job.hpp"
#include "bench/scenario/scenario.hpp"
#include "core/error.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {

/// 16 hexadecimal digits of a hash (FNV-1a, 64 bit) of the text.
std::string text_hash(std::string_view text);

/// Name of what one estimator yields on one seed of a scenario: the hash of everything that decides
/// it, and of nothing else: the effective configuration of simulation, scoring and the estimator
/// with the settings of its spec, the seed, the estimator's name, the code's version. Labels,
/// descriptions, tags and expectations do not count, nor does where a file lies.
std::string job_id(const Scenario& scenario, std::uint64_t seed, const std::string& estimator);

/// The same for many jobs of one scenario, whose common part is put into words once.
class JobIds {
 public:
  explicit JobIds(const Scenario& scenario);

  /// Stands for the estimator with its settings. Error for a setting that there is not or that has
  /// no effect, or a value that it does not allow.
  Result<std::string> estimator_key(const EstimatorSpec& estimator) const;

  /// Hash of the scenario and the estimator of that key, on any seed.
  std::string version(const std::string& estimator_key) const;

  /// `job_id` of the scenario, the seed and the estimator of that key.
  std::string id(std::uint64_t seed, const std::string& estimator_key) const;

 private:
  EstimatorConfigs estimators_;
  std::string scenario_key_;
};

/// Part `index` of `count` (from 1) of a list of jobs.
struct Shard {
  int index = 1;
  int count = 1;
};

/// The shard of "2/8".
Result<Shard> parse_shard(std::string_view text);

/// The shard's jobs: neighbours in the list, so that a shard needs few sequences. The shards differ
/// by one job at most, and together are all jobs.
std::span<const Job> part_of(std::span<const Job> jobs, const Shard& shard);

}  // namespace aims
