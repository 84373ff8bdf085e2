// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/success_pairs.hpp"

#include "bench/studies/suite_summary.hpp"

namespace aims {
namespace {

/// Common sequences and those on which one alone is a success.
struct Counts {
  std::size_t sequences = 0;
  std::size_t only_first = 0;
  std::size_t only_second = 0;
};

Counts counts_of(const Suite& suite, const std::string& first, const std::string& second,
                 const std::string& key) {
  Counts counts;
  for (const SuiteCase& each : suite.cases) {
    for (const RunRecord& run : each.runs) {
      const auto one = succeeds(run, first, key);
      const auto other = succeeds(run, second, key);
      if (!one || !other) continue;
      ++counts.sequences;
      counts.only_first += *one && !*other;
      counts.only_second += !*one && *other;
    }
  }
  return counts;
}

}  // namespace

std::vector<SuccessPair> success_pairs(const Suite& suite) {
  std::vector<SuccessPair> pairs;
  const std::vector<std::string> names = estimators_of(suite);
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      SuccessPair pair{names[i], names[j], 0, {}};
      for (std::size_t k = 0; k < kSuccessCount; ++k) {
        const Counts counts = counts_of(suite, names[i], names[j], success_scores()[k].key);
        if (k == 0) pair.sequences = counts.sequences;
        pair.tests[k] = mcnemar_test(counts.only_first, counts.only_second);
      }
      if (pair.sequences > 0) pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

Json success_pairs_json(const std::vector<SuccessPair>& pairs) {
  Json json = Json::array();
  for (const SuccessPair& pair : pairs) {
    Json tests = Json::object();
    for (std::size_t k = 0; k < kSuccessCount; ++k) {
      tests[success_scores()[k].key] = {{"only_first", pair.tests[k].only_first},
                                        {"only_second", pair.tests[k].only_second},
                                        {"p", pair.tests[k].p}};
    }
    json.push_back({{"first", pair.first},
                    {"second", pair.second},
                    {"sequences", pair.sequences},
                    {"mcnemar", std::move(tests)}});
  }
  return json;
}

}  // namespace aims
