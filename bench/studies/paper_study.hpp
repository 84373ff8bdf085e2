// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/metrics/statistics.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/score_statistics.hpp"
#include "bench/studies/suite.hpp"
#include "core/error.hpp"
#include "core/files/table.hpp"

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

/// Version of the layout of paper.json; see docs/result-files.md.
inline constexpr std::string_view kPaperSchema = "aims.paper/1";

/// One score of one system.
struct PaperCell {
  std::optional<double> figure;  ///< in the paper
  std::vector<double> values;    ///< here, by valid run; infinite where a run has none
  std::optional<double> median;  ///< of them; none where it is infinite
  std::optional<double> worst;   ///< likewise
};

/// How many of `headline_scores()` stand beside those of the paper: the ATE in both alignments and
/// the heading error, which its tables do not have.
inline constexpr std::size_t kPaperHeadline = 3;

struct PaperSystem {
  std::string estimator;
  std::string method;            ///< its name in the paper; empty: it is not there
  std::vector<PaperCell> cells;  ///< by column
  std::size_t runs = 0;          ///< valid ones in which it finished
  std::size_t successes = 0;
  SuccessRate strict;                           ///< within 1 %
  std::vector<std::optional<double>> headline;  ///< medians, `kPaperHeadline` of them
};

/// How far the paper's order of its systems and ours agree in one score.
struct PaperOrder {
  PaperScore score;
  std::size_t systems = 0;    ///< with a place in both
  std::optional<double> tau;  ///< Kendall's, between the paper's figures and the medians here
  Interval interval;          ///< 95 %, bootstrap over seeds
};

/// One experiment of the paper, repeated.
struct PaperExperiment {
  std::string scenario;
  std::string title;
  std::vector<std::uint64_t> seeds;  ///< of the valid runs
  std::vector<PaperSystem> systems;  ///< those that ran, in the order of the table
  std::vector<PaperOrder> orders;    ///< by column
};

struct PaperTau {
  std::optional<double> tau;
  std::size_t systems = 0;  ///< compared
};

/// Kendall's tau between the paper's figures of its systems and the medians of their scores in
/// `runs`; systems without a run are left out. A "-" of the paper and a median without a value are
/// last.
PaperTau paper_tau(const PaperTable& table, std::size_t column, std::span<const RunRecord> runs);

/// The experiments of the paper that the suite ran. Error when it ran none.
Result<std::vector<PaperExperiment>> paper_study(const Suite& suite);

/// "paper · median (worst)" of every score, a row per system.
TextTable system_table(const PaperExperiment& experiment);

/// Kendall's tau of every score of every experiment.
TextTable order_table(const std::vector<PaperExperiment>& experiments);

/// What paper.json holds.
Json paper_json(const std::vector<PaperExperiment>& experiments);

/// Writes paper.md, paper.json and paper.csv into `folder`.
Result<void> write_paper(const std::vector<PaperExperiment>& experiments, const Suite& suite,
                         const std::filesystem::path& folder);

}  // namespace aims
