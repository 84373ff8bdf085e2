// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/success_pairs.hpp"

#include "bench/studies/suite_summary.hpp"

namespace aims {
namespace {

SuccessTest test_of(const Suite& suite, const std::string& first, const std::string& second,
                    const std::string& key) {
  SuccessDifferences differences;
  for (const SuiteCase& each : suite.cases) {
    for (const RunRecord& run : each.runs) {
      const auto one = succeeds(run, first, key);
      const auto other = succeeds(run, second, key);
      if (one && other) differences.add(run.seed, *one, *other);
    }
  }
  return differences.test();
}

}  // namespace

std::vector<SuccessPair> success_pairs(const Suite& suite) {
  std::vector<SuccessPair> pairs;
  const std::vector<std::string> names = estimators_of(suite);
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      SuccessPair pair{names[i], names[j], {}};
      for (std::size_t k = 0; k < kSuccessCount; ++k) {
        pair.tests[k] = test_of(suite, names[i], names[j], success_scores()[k].key);
      }
      if (pair.tests[0].sequences > 0) pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

Json success_pairs_json(const std::vector<SuccessPair>& pairs) {
  Json json = Json::array();
  for (const SuccessPair& pair : pairs) {
    Json tests = Json::object();
    for (std::size_t k = 0; k < kSuccessCount; ++k) {
      const SuccessTest& test = pair.tests[k];
      tests[success_scores()[k].key] = {{"only_first", test.only_first},
                                        {"only_second", test.only_second},
                                        {"seeds_first", test.by_seed.only_first},
                                        {"seeds_second", test.by_seed.only_second},
                                        {"p", test.by_seed.p}};
    }
    json.push_back({{"first", pair.first},
                    {"second", pair.second},
                    {"sequences", pair.tests[0].sequences},
                    {"seeds", pair.tests[0].seeds},
                    {"tests", std::move(tests)}});
  }
  return json;
}

}  // namespace aims
