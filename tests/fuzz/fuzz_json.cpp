// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fstream>

#include "bench/jobs/job_store.hpp"
#include "bench/jobs/stored_results.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/result_files.hpp"
#include "bench/studies/suite_summary.hpp"
#include "render/page/page_template.hpp"
#include "render/page/pages.hpp"
#include "tests/fuzz/demand.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& file, std::string_view text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

void show(const Result<PageData>& page) {
  if (!page) return demand_readable(page.error());
  demand(filled_template("__AIMS_TITLE__ __AIMS_DATA__", *page).has_value());
}

/// As what one run left.
void read_run(const fs::path& folder, std::string_view text) {
  put(folder / "scores.json", text);
  put(folder / "truth.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  const auto record = read_record(folder / "scores.json");
  if (!record) demand_readable(record.error());
  show(run_page(folder));
  const auto results = read_results(folder);
  if (!results) demand_readable(results.error());
  fs::remove(folder / "scores.json");
  put(folder / "estimate.json", text);
  show(run_page(folder));
}

/// As a suite, and as the result of its only job.
void read_suite(const fs::path& folder, std::string_view text) {
  put(folder / "suite.json", text);
  put(folder / "jobs.csv", "id,scenario,seed,label,estimator\nj,walk,1,lio,lio\n");
  put(folder / "jobs" / "j.json", text);
  static_cast<void>(holds_suite(folder));
  show(suite_page(folder, {}));
  static_cast<void>(JobStore(folder).find("j"));
  const auto results = read_results(folder);
  if (!results) demand_readable(results.error());
}

/// As the only job of a sweep.
void read_sweep(const fs::path& folder, std::string_view text) {
  put(folder / "plan.yaml", "scenarios: [walk]\nseeds: 1\nestimators: [lio]\n");
  put(folder / "jobs.csv", "id,scenario,seed,label,estimator\nj,walk,1,lio,lio\n");
  put(folder / "jobs" / "j.json", text);
  show(tuning_page(folder, {}));
}

}  // namespace

void fuzz_json(std::span<const std::uint8_t> input) {
  const std::string_view text = text_of(input);
  const auto json = parse_json(text, "input");
  if (!json) return demand_readable(json.error());
  demand(parse_json(json_text(*json, 2), "again").has_value());
  const TemporaryFolder folder;
  read_run(folder.path() / "run", text);
  read_suite(folder.path() / "suite", text);
  read_sweep(folder.path() / "sweep", text);
}

}  // namespace aims
