// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/consistency_study.hpp"

#include <utility>

#include "bench/run/weak_axis_series.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {

ConsistencyStudy consistency_study(Suite suite) {
  ConsistencyStudy study;
  study.suite = std::move(suite);
  for (const SuiteCase& each : study.suite.cases) {
    for (const std::string& label : labels_of(each.scenario.estimators)) {
      ConsistencyCase made{each.scenario.name, label, {}, {}, {}};
      for (const RunRecord& record : each.runs) {
        made.seeds.push_back(record.seed);
        made.runs.push_back(series_of(record, label));
      }
      made.result = consistency_of(made.runs);
      study.cases.push_back(std::move(made));
    }
  }
  return study;
}

Result<ConsistencyStudy> run_consistency(std::vector<ScenarioFile> scenarios,
                                         const SuiteOptions& options,
                                         const SuiteObserver& observer) {
  SuiteOptions with_series = options;
  with_series.weak_axis_series = true;
  auto suite = run_suite(std::move(scenarios), with_series, observer);
  if (!suite) return tl::unexpected(suite.error());
  ConsistencyStudy study = consistency_study(std::move(*suite));
  if (auto written = write_consistency(study, options.out); !written) {
    return tl::unexpected(written.error());
  }
  return study;
}

}  // namespace aims
