// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/tuning/objective.hpp"
#include "bench/tuning/sweep_store.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/sweep_results.hpp"
#include "cli/terminal.hpp"
#include "core/text.hpp"
#include "render/page/page.hpp"
#include "render/page/tuning_source.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostShown = 10;  ///< jobs that are listed one by one

struct MergeArguments {
  std::vector<std::string> folders;
  SharedOptions shared;
  Objective objective;
};

/// Lists jobs that failed or are missing, up to a number.
void print_open(const MergedSweep& sweep) {
  std::size_t open = 0;
  for (const MergedJob& job : sweep.jobs) {
    if (job.is_done() || ++open > kMostShown) continue;
    const std::string message = job.file.is_object() ? job.file.value("message", "") : "";
    const std::string why = job.invalid().value_or(message);
    print_out("{}: {} {} seed {} {}{}{}\n", job.outcome(), job.listed.id, job.listed.scenario,
              job.listed.seed, job.listed.estimator, why.empty() ? "" : ": ", why);
  }
  if (open > kMostShown) print_out("and {} more\n", open - kMostShown);
}

/// Whether no job that is done has the score, as of a misspelt key.
bool lacks_score(const MergedSweep& sweep, const std::string& key) {
  bool done = false;
  for (const MergedJob& job : sweep.jobs) {
    if (!job.is_done()) continue;
    done = true;
    if (number_at(value_in(job.file, "scores", Json()), key)) return false;
  }
  return done;
}

void print_notes(const MergedSweep& sweep) {
  if (sweep.repeated > 0) {
    print_out("note: {} failed in one folder and {} done in another, which counts\n",
              counted(sweep.repeated, "job"), sweep.repeated == 1 ? "is" : "are");
  }
  if (sweep.others > 0) {
    print_out("note: {} of another plan, code or scenario version {} left out\n",
              counted(sweep.others, "result"), sweep.others == 1 ? "is" : "are");
  }
}

int merge_command(const MergeArguments& arguments) {
  const std::vector<fs::path> folders(arguments.folders.begin(), arguments.folders.end());
  if (folders.size() > 1 && arguments.shared.out.empty()) {
    return bad_input("merge", {"several folders: expected --out"});
  }
  if (auto right = check_direction("--score", arguments.objective.score); !right) {
    return bad_input("merge", right.error());
  }
  const fs::path out =
      arguments.shared.out.empty() ? folders.front() : fs::path(arguments.shared.out);
  const auto sweep = merge_sweeps(folders);
  if (!sweep) return bad_input("merge", sweep.error());
  if (const std::string& key = arguments.objective.score; lacks_score(*sweep, key)) {
    return bad_input("merge", {fmt::format("--score: no job has a score '{}'; expected a key of "
                                           "scores.json, e.g. ate_yaw_m; nothing was written",
                                           key)});
  }
  if (auto written = write_results(*sweep, arguments.objective, out); !written) {
    return bad_input("merge", written.error());
  }
  print_out("{}\n", to_text(merge_table(*sweep)));
  print_points(*sweep, arguments.objective);
  print_open(*sweep);
  print_notes(*sweep);
  print_out("{} of {} jobs done: {}, sweep.csv, sweep.md\n", sweep->count("done"),
            sweep->jobs.size(), (out / "sweep.sqlite").string());
  print_written(write_merged_page(merged_source(*sweep, arguments.objective), out));
  const std::size_t invalid = sweep->count("invalid");
  if (sweep->count("done") + invalid < sweep->jobs.size()) return kExpectationFailed;
  return invalid == 0 ? kOk : kInvalidRun;
}

}  // namespace

void declare_merge(Command command, const fs::path& /*scenarios*/) {
  auto arguments = std::make_shared<MergeArguments>();
  command.arguments("folder", arguments->folders, "Folders of aims sweep, finished or not",
                    Presence::kRequired);
  add_out(command, arguments->shared, "the first folder");
  command.option("--score", arguments->objective.score,
                 "Key of scores.json that sweep.md analyses (ate_yaw_m)");
  command.option("--divergence-penalty", arguments->objective.divergence_penalty, {0.0, 1e9},
                 "Value of a diverged run in the objective, of which the fraction of\n"
                 "diverged runs is added too (10)");
  command.footer(
      "Writes sweep.sqlite, sweep.csv, sweep.md and the page.\n"
      "Examples:\n"
      "  aims merge out/sweep\n"
      "  sqlite3 out/sweep/sweep.sqlite \"SELECT p.value, avg(s.value) FROM parameters p\n"
      "      JOIN scores s USING (job) WHERE p.key='degeneracy.eta' AND s.key='m_end_m'\n"
      "      GROUP BY p.value\"\n"
      "Exit codes: as of aims; 1 when jobs failed or are missing.");
  command.action([arguments] { return merge_command(*arguments); });
}

}  // namespace aims
