// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/consistency_study.hpp"

#include <algorithm>
#include <utility>

#include "bench/run/weak_axis_series.hpp"

namespace aims {
namespace {

/// The case of that scenario and estimator, which is added when it is not there.
ConsistencyCase& case_of(const Job& job, ConsistencyStudy& study) {
  const auto known = std::find_if(study.begin(), study.end(), [&](const ConsistencyCase& each) {
    return each.scenario == job.scenario->name && each.estimator == job.estimator.label;
  });
  if (known != study.end()) return *known;
  return study.emplace_back(ConsistencyCase{job.scenario->name, job.estimator.label, {}, {}, {}});
}

}  // namespace

Result<ConsistencyStudy> consistency_study(const Suite& suite,
                                           const std::filesystem::path& folder) {
  const JobStore store(folder);
  ConsistencyStudy study;
  for (const Job& job : suite.jobs) {
    const auto result = store.find(job.id);
    if (!result || result->outcome != JobOutcome::kDone) continue;
    if (invalid_reason(result->sequence)) continue;
    auto series = read_weak_axis(store.outputs_of(job.id) / kWeakAxisFile);
    if (!series) return tl::unexpected(series.error());
    ConsistencyCase& each = case_of(job, study);
    each.seeds.push_back(job.seed);
    each.runs.push_back(std::move(*series));
  }
  for (ConsistencyCase& each : study) each.result = consistency_of(each.runs);
  return study;
}

}  // namespace aims
