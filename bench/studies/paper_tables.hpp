// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace aims {

/// A column of a table of the paper.
struct PaperScore {
  std::string key;    ///< of the score here, e.g. "m_list_percent.a-b"
  std::string title;  ///< with its unit
};

/// A compared system and its figures in the paper.
struct PaperMethod {
  std::string estimator;  ///< its name here
  std::string name;       ///< in the paper; empty: it is not there
  /// By column; none where the paper has "-", or is silent.
  std::vector<std::optional<double>> figures;
};

/// Table I or II of the paper (Adaptive Inspection Multisensor SLAM, section IV).
struct PaperTable {
  std::string scenario;
  std::string title;
  std::vector<PaperScore> scores;
  std::vector<PaperMethod> methods;  ///< those of the paper in its order, then the others
};

/// Both tables.
const std::vector<PaperTable>& paper_tables();

/// The table of a scenario; null without one.
const PaperTable* paper_table_of(const std::string& scenario);

/// Names of the estimators of the tables.
std::vector<std::string> paper_estimators();

}  // namespace aims
