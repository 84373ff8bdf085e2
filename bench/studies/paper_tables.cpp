// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/paper_tables.hpp"

#include <algorithm>

namespace aims {
namespace {

constexpr std::nullopt_t kDash = std::nullopt;

/// Systems that the paper does not have.
void add_others(PaperTable& table) {
  for (const char* estimator : {"leg_kilo", "tfs_plus", "aims_d"}) {
    table.methods.push_back(
        {estimator, "", std::vector<std::optional<double>>(table.scores.size())});
  }
}

PaperTable corridor() {
  PaperTable table;
  table.scenario = "corridor";
  table.title = "Table I, corridor";
  table.scores = {{"m_list_percent.a-b", "M_list a-b [%]"},
                  {"m_list_percent.b-a", "M_list b-a [%]"},
                  {"m_end_m", "M_end [m]"}};
  table.methods = {{"loam", "LOAM", {0.15, 1.73, 16.32}},
                   {"fast_lio2", "FAST-LIO2", {0.12, 0.18, 0.36}},
                   {"lins", "LINS", {0.14, 0.16, 1.29}},
                   {"lego_loam", "LEGO-LOAM", {0.89, 0.92, 0.79}},
                   {"lio_sam", "LIO-SAM", {kDash, kDash, kDash}},
                   {"leg", "Legged Odometry", {6.16, 15.97, 7.01}},
                   {"tfs", "TFS", {14.83, 17.04, 3.44}},
                   {"aims", "Proposed method", {0.07, 0.08, 0.16}}};
  add_others(table);
  return table;
}

PaperTable garage() {
  PaperTable table;
  table.scenario = "garage";
  table.title = "Table II, garage";
  table.scores = {{"m_list_percent.a-d", "M_list a-d [%]"},
                  {"m_list_percent.d-a", "M_list d-a [%]"},
                  {"m_list_percent.d-h", "M_list d-h [%]"},
                  {"m_list_percent.h-d", "M_list h-d [%]"},
                  {"m_end_m", "M_end [m]"}};
  table.methods = {{"loam", "LOAM", {0.26, 10.57, 4.85, 5.13, 23.84}},
                   {"fast_lio2", "FAST-LIO2", {0.20, 0.62, 1.56, 1.69, 0.48}},
                   {"lins", "LINS", {4.29, 4.89, 8.64, 8.38, 0.63}},
                   {"lego_loam", "LEGO-LOAM", {2.50, 3.64, 6.68, 6.27, 0.85}},
                   {"lio_sam", "LIO-SAM", {76.5, kDash, kDash, kDash, kDash}},
                   {"leg", "Legged Odometry", {5.87, 5.92, 6.45, 6.92, 9.70}},
                   {"tfs", "TFS", {8.31, 9.65, 7.44, 7.65, 11.92}},
                   {"aims", "Proposed method", {0.15, 0.14, 0.48, 0.51, 0.29}}};
  add_others(table);
  return table;
}

}  // namespace

const std::vector<PaperTable>& paper_tables() {
  static const std::vector<PaperTable> tables = {corridor(), garage()};
  return tables;
}

const PaperTable* paper_table_of(const std::string& scenario) {
  const auto& tables = paper_tables();
  const auto found = std::ranges::find(tables, scenario, &PaperTable::scenario);
  return found == tables.end() ? nullptr : &*found;
}

std::vector<std::string> paper_estimators() {
  std::vector<std::string> names;
  for (const PaperMethod& method : paper_tables().front().methods)
    names.push_back(method.estimator);
  return names;
}

}  // namespace aims
