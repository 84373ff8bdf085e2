// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/studies/suite_summary.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/manifest.hpp"
#include "render/page/page_template.hpp"
#include "render/page/pages.hpp"
#include "render/page/run_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> runs_of_suite(const fs::path& suite) {
  std::vector<fs::path> runs;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(suite / "runs", ignored)) {
    for (fs::path& run : seed_folders(entry.path())) runs.push_back(std::move(run));
  }
  std::sort(runs.begin(), runs.end());
  return runs;
}

/// Whether the run's page shows its scores as they are now.
bool is_up_to_date(const fs::path& run) {
  std::error_code code;
  const auto page = fs::last_write_time(run / kPageFile, code);
  if (code) return false;
  const auto scores = fs::last_write_time(run / "scores.json", code);
  return code || page >= scores;
}

Result<PageData> page_of(const fs::path& folder, const PageOptions& options) {
  if (holds_suite(folder)) return suite_page(folder, options);
  if (!options.against.empty() || !options.detectors.empty()) {
    return failure(
        fmt::format("{}: has no suite.json: {} has an effect on the page of a suite alone",
                    folder.string(), options.against.empty() ? "--detectors" : "--against"));
  }
  if (holds_tuning(folder)) return tuning_page(folder, options);
  if (holds_run(folder)) return run_page(folder);
  if (holds_seeds(folder)) return seeds_page(folder, options);
  return failure(
      fmt::format("{}: holds no results: expected scores.json (aims run, score), estimate.json "
                  "(aims estimate), "
                  "suite.json (aims suite) or plan.yaml (aims sweep, tune)",
                  folder.string()));
}

Result<void> write_html(const PageData& page, const fs::path& file) {
  const auto html = page_html(page);
  if (!html) return tl::unexpected(html.error());
  auto written = write_file_atomically(file, *html);
  if (written && file.filename() == kPageFile) add_to_manifest(file);
  return written;
}

}  // namespace

Result<void> write_page(const fs::path& folder, const fs::path& file, PageOptions options) {
  if (options.out_folder.empty()) {
    options.out_folder = file.has_parent_path() ? file.parent_path() : ".";
  }
  const auto page = page_of(folder, options);
  if (!page) return tl::unexpected(page.error());
  return write_html(*page, file);
}

Result<WrittenPages> write_pages(const fs::path& folder, const PageOptions& options,
                                 const DrawObserver& observer) {
  WrittenPages written_pages;
  const bool suite = holds_suite(folder);
  const std::vector<fs::path> runs = suite ? runs_of_suite(folder) : seed_folders(folder);
  for (const fs::path& run : runs) {
    if (suite && is_up_to_date(run)) continue;
    announce(observer, run / kPageFile);
    if (auto written = write_page(run, run / kPageFile); written) {
      written_pages.pages.push_back(run / kPageFile);
    } else if (suite) {
      written_pages.warnings.push_back(written.error().message);
    } else {
      return tl::unexpected(written.error());
    }
  }
  const bool results = suite || holds_tuning(folder) || holds_run(folder) || !runs.empty();
  if (results) announce(observer, folder / kPageFile);
  auto written = write_page(folder, folder / kPageFile, options);
  if (!written) return tl::unexpected(written.error());
  written_pages.pages.push_back(folder / kPageFile);
  return written_pages;
}

Result<WrittenPages> write_merged_page(const TuningSource& source, const fs::path& folder) {
  const auto page = tuning_page(source, folder);
  if (!page) return tl::unexpected(page.error());
  if (auto written = write_html(*page, folder / kPageFile); !written) {
    return tl::unexpected(written.error());
  }
  return WrittenPages{.pages = {folder / kPageFile}, .warnings = {}};
}

}  // namespace aims
