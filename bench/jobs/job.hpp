// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/scenario/scenario.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/error.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {

/// Version of the layout of a job's file; see docs/studies-and-tuning.md.
inline constexpr std::string_view kJobSchema = "aims.job/1";

/// A value that a job's scenario has instead of its own.
struct ScenarioSetting {
  std::string key;            ///< e.g. "links.leg_odometry.loss"
  std::string value;          ///< as in YAML
  std::string default_value;  ///< of the scenario itself
};

struct JobResult;

/// The least piece of work: one estimator with its settings on one sequence. The same job gives the
/// same scores wherever and whenever it is done.
struct Job {
  std::shared_ptr<const Scenario> scenario;  ///< with its settings on top, drawn for the seed
  std::uint64_t seed = 0;
  EstimatorSpec estimator;
  std::string id;  ///< bench/jobs/job_id.hpp: of scenario, seed, estimator, settings, code version
  std::vector<ScenarioSetting> scenario_settings = {};  ///< what a sweep varies of the scenario
  std::string version = {};  ///< of a sweep: hash of scenario and estimator, whatever the seed
  /// Of a job on a recording, in place of a simulated sequence: all that is to be done, in a
  /// process of its own, which tells the part that is done.
  std::function<JobResult(std::atomic<double>& part)> recorded = {};
};

/// The job of those parts under its id, on the scenario as the seed draws it.
Job make_job(std::shared_ptr<const Scenario> scenario, std::uint64_t seed, EstimatorSpec estimator);

/// "aims+degeneracy.eta=3+links.lidar.loss=0.1": the estimator with its settings, and what is set
/// of the scenario.
std::string point_text(const Job& job);

/// "corridor seed 1 aims+degeneracy.eta=3", for messages.
std::string text_of(const Job& job);

/// How a job ended.
enum class JobOutcome {
  kDone,
  kFailed,        ///< the estimator ended with an error
  kCrashed,       ///< its process was ended by a signal, or by itself
  kTimedOut,      ///< it was stopped after the time that a job is given
  kNotSimulated,  ///< its sequence cannot be simulated, which is no failure of the estimator
};

std::string_view name_of(JobOutcome outcome);

/// What a job came to.
struct JobResult {
  JobOutcome outcome = JobOutcome::kDone;
  std::string message;  ///< unless done: why
  Json scores;          ///< when done: what scores.json holds of the estimator
  Json sequence;        ///< when done: what scores.json holds whoever estimates
  double wall_s = 0.0;  ///< that evaluating took
};

/// One number of the scores by dotted key ("m_list_percent.all", "time_per_scan_ms.mean"; success
/// is 1 or 0); none when the job failed or the score has no value.
std::optional<double> score_in(const JobResult& result, const std::string& key);

/// What a job's file holds: the job, in words and by its id, and what it came to.
Json job_json(const Job& job, const JobResult& result);

/// The result in a job's file; none when it is no such thing.
std::optional<JobResult> result_in(const Json& json);

}  // namespace aims
