// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scoring/report.hpp"
#include "bench/scoring/score_statistics.hpp"

namespace aims {

/// How many runs there are and on how many each limit of the position error held.
inline Json success_json(const SuccessRate& rate, const SuccessRate& strict) {
  const Interval interval = rate.interval();
  return {{"runs", rate.runs},
          {"successes", rate.count},
          {"success_low", json_of(interval.low)},
          {"success_high", json_of(interval.high)},
          {"successes_1_percent", strict.count}};
}

/// A column for each limit, of rows with the members successes, runs and strict.
template <class Row>
void add_success_columns(TableColumns<Row>& columns) {
  columns.push_back({"", std::string(success_scores()[0].title), [](const Row& row) {
                       return SuccessRate{row.successes, row.runs}.text();
                     }});
  columns.push_back({"", std::string(success_scores()[1].title),
                     [](const Row& row) { return row.strict.text(); }});
}

}  // namespace aims
