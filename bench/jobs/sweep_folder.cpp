// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/sweep_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <system_error>

#include "bench/run/code_version.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/csv.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCodeLine = "# code ";

/// plan.yaml: the plan, and the code that its ids are of.
std::string plan_file_text(const std::string& plan) {
  return fmt::format("# aims sweep\n{}{}\n{}", kCodeLine, code_version(), plan);
}

std::string job_list(std::span<const Job> jobs) {
  CsvTable table({"id", "scenario", "seed", "estimator"});
  for (const Job& job : jobs) {
    table.add(job.id).add(job.scenario->name).add(static_cast<std::int64_t>(job.seed));
    table.add(point_text(job)).end_row();
  }
  return table.text();
}

/// The cells of a line that `CsvTable` wrote.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

/// The line of `text` that begins with `start`; empty when there is none.
std::string line_of(const std::string& text, std::string_view start) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(start)) return line.substr(start.size());
  }
  return "";
}

/// Of two texts, the first line of `theirs` that `ours` has otherwise.
std::string first_difference(const std::string& theirs, const std::string& ours) {
  std::istringstream a(theirs);
  std::istringstream b(ours);
  std::string left;
  std::string right;
  while (std::getline(a, left)) {
    if (!std::getline(b, right) || left != right) return left;
  }
  return "(fewer lines)";
}

/// Why the folder's jobs are not these; empty when they are, whatever else the plan says.
std::string mismatch(const std::string& plan_there, const std::string& plan_here,
                     const std::string& list_there, const std::string& list_here) {
  const std::string code_there = line_of(plan_there, kCodeLine);
  if (code_there != code_version()) {
    return fmt::format("holds jobs of code {}, and this is code {}", code_there, code_version());
  }
  if (list_there == list_here) return "";
  if (plan_there != plan_here) {
    return fmt::format("holds jobs of another plan, with '{}'",
                       first_difference(plan_there, plan_here));
  }
  return "holds jobs of other scenarios: a scenario file has changed";
}

}  // namespace

Result<void> SweepFolder::enter(const std::string& plan, std::span<const Job> jobs,
                                bool renew) const {
  const fs::path plan_file = path_ / "plan.yaml";
  const fs::path list_file = path_ / "jobs.csv";
  const std::string plan_here = plan_file_text(plan);
  const std::string list_here = job_list(jobs);
  if (fs::exists(plan_file)) {
    const auto plan_there = read_file(plan_file);
    if (!plan_there) return tl::unexpected(plan_there.error());
    const auto list_there = read_file(list_file);
    // Without a list, whoever wrote the plan was ended before it wrote that.
    const std::string why =
        mismatch(*plan_there, plan_here, list_there.value_or(list_here), list_here);
    if (!why.empty() && !renew) {
      return failure(fmt::format(
          "{}: {}; give another --out, or --force to continue here (valid results stay)",
          path_.string(), why));
    }
    if (why.empty() && list_there && *plan_there == plan_here) return {};
  }
  if (auto written = write_file_atomically(plan_file, plan_here); !written) return written;
  return write_file_atomically(list_file, list_here);
}

Result<std::vector<ListedJob>> SweepFolder::listed() const {
  const fs::path file = path_ / "jobs.csv";
  const auto text = read_file(file);
  if (!text)
    return failure(fmt::format("{}: not the folder of a sweep: no jobs.csv", path_.string()));
  std::istringstream lines(*text);
  std::string line;
  std::getline(lines, line);
  std::vector<ListedJob> jobs;
  while (std::getline(lines, line)) {
    std::vector<std::string> cells = cells_of(line);
    if (cells.size() != 4)
      return failure(fmt::format("{}: expected 4 cells: {}", file.string(), line));
    jobs.push_back({cells[0], cells[1], cells[2], cells[3]});
  }
  return jobs;
}

Result<std::string> SweepFolder::plan() const { return read_file(path_ / "plan.yaml"); }

}  // namespace aims
