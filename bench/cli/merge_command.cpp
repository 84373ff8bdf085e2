// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/options.hpp"
#include "bench/jobs/sweep_store.hpp"
#include "bench/tuning/sweep_report.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostShown = 10;  ///< units that are named one by one

struct MergeArguments {
  std::vector<std::string> folders;
  std::string out;
  std::string score = Objective{}.score;
};

/// Says what cannot be told; a sweep without ranges has no report.
void report(const MergedSweep& sweep, const std::string& score, const fs::path& out) {
  Objective objective;
  objective.score = score;
  std::vector<std::string> warnings;
  const auto written = write_sweep_report(sweep, objective, out, warnings);
  if (!written) warnings.push_back("no sweep.md: " + written.error().message);
  for (const std::string& warning : warnings) fmt::print("note: {}\n", warning);
}

/// Names units that failed, and a few that are missing.
void print_open(const MergedSweep& sweep) {
  std::size_t shown = 0;
  std::size_t left = 0;
  for (const MergedJob& unit : sweep.jobs) {
    const std::string outcome = unit.outcome();
    if (outcome == "done") continue;
    if (++shown > kMostShown) {
      ++left;
      continue;
    }
    const std::string why = unit.file.is_object() ? unit.file.value("message", "") : "";
    fmt::print("{}: {} {} seed {} {}{}{}\n", outcome, unit.listed.id, unit.listed.scenario,
               unit.listed.seed, unit.listed.estimator, why.empty() ? "" : ": ", why);
  }
  if (left > 0) fmt::print("and {} more\n", left);
}

int merge_command(const MergeArguments& arguments) {
  const std::vector<fs::path> folders(arguments.folders.begin(), arguments.folders.end());
  if (folders.size() > 1 && arguments.out.empty()) {
    return bad_input("merge", {"several folders: say by --out into which the result goes"});
  }
  const fs::path out = arguments.out.empty() ? folders.front() : fs::path(arguments.out);
  const auto sweep = merge_sweeps(folders);
  if (!sweep) return bad_input("merge", sweep.error());
  std::error_code code;
  fs::create_directories(out, code);
  auto written = write_sqlite(*sweep, out / "sweep.sqlite");
  if (written) written = write_sweep_csv(*sweep, out / "sweep.csv");
  if (!written) return bad_input("merge", written.error());
  report(*sweep, arguments.score, out);
  fmt::print("{}\n", to_text(merge_table(*sweep)));
  print_open(*sweep);
  if (sweep->others > 0) {
    fmt::print("note: {} results of another plan, code or scenario are left out\n", sweep->others);
  }
  fmt::print("{} of {} units done: {}, sweep.csv, sweep.md\n", sweep->count("done"),
             sweep->jobs.size(), (out / "sweep.sqlite").string());
  return sweep->count("done") == sweep->jobs.size() ? kOk : kGateFailed;
}

}  // namespace

void add_merge_command(CLI::App& app, int& exit_code) {
  auto* command =
      app.add_subcommand("merge", "Put a sweep's results into one SQLite database and a table");
  auto arguments = std::make_shared<MergeArguments>();
  command->add_option("folder", arguments->folders, "Folders that aims sweep filled, or fills")
      ->required();
  command->add_option("--out", arguments->out,
                      "Folder for sweep.sqlite, sweep.csv and sweep.md (the first)");
  command->add_option("--score", arguments->score,
                      "Key of scores.json that sweep.md is about (ate_m)");
  command->footer(
      "Examples:\n"
      "  aims merge out/sweep\n"
      "  sqlite3 out/sweep/sweep.sqlite \"SELECT p.value, avg(s.value) FROM parameters p\n"
      "      JOIN scores s USING (unit) WHERE p.key='degeneracy.eta' AND s.key='m_end_m'\n"
      "      GROUP BY p.value\"\n"
      "Exit codes: as of aims; 1 when units failed or are missing.");
  command->callback([arguments, &exit_code] { exit_code = merge_command(*arguments); });
}

}  // namespace aims
