// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/report_command.hpp"
#include "render/page/page.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  std::vector<std::string> folders;
  std::string out;
  std::string against;
  std::string detectors;
};

void print_reports(const WrittenPages& reports) {
  for (const std::string& warning : reports.warnings) fmt::print("warning: {}\n", warning);
  const std::size_t most = 5;
  const std::size_t left_out = reports.pages.size() > most ? reports.pages.size() - most : 0;
  if (left_out > 0) fmt::print("report: {} pages of runs, and\n", left_out);
  for (std::size_t i = left_out; i < reports.pages.size(); ++i) {
    fmt::print("report: {}\n", reports.pages[i].string());
  }
}

/// The page of one folder, to the file that was asked for.
int write_one(const ReportArguments& arguments, const PageOptions& options) {
  if (arguments.folders.size() != 1) {
    return bad_input(
        "report", {fmt::format("--out: expected one folder, found {}", arguments.folders.size())});
  }
  auto written = write_page(arguments.folders.front(), arguments.out, options);
  if (!written) return bad_input("report", written.error());
  fmt::print("report: {}\n", arguments.out);
  return kOk;
}

int report_command(const ReportArguments& arguments) {
  const PageOptions options = {arguments.against, arguments.detectors, {}};
  if (!arguments.out.empty()) return write_one(arguments, options);
  for (const std::string& folder : arguments.folders) {
    const auto reports = write_pages(folder, options);
    if (!reports) return bad_input("report", reports.error());
    print_reports(*reports);
  }
  return kOk;
}

}  // namespace

void show_reports(const fs::path& folder) {
  const auto reports = write_pages(folder);
  if (reports) {
    print_reports(*reports);
  } else {
    fmt::print("warning: no report: {}\n", reports.error().message);
  }
}

void add_report_command(CLI::App& app, int& exit_code) {
  auto* command =
      app.add_subcommand("report", "Write a page (one HTML file) that shows a folder of results");
  auto arguments = std::make_shared<ReportArguments>();
  command
      ->add_option("folders", arguments->folders, "Folders of run, suite, estimate, score, sweep")
      ->required();
  command->add_option("--out", arguments->out, "File to write, of one folder (FOLDER/page.html)");
  command->add_option("--against", arguments->against,
                      "Second folder of results that a suite is held against");
  command->add_option("--detectors", arguments->detectors,
                      "Folder of `aims detectors` whose curves a suite's page shows");
  command->footer(
      "Each folder gets its page.html; of several seeds each gets one, of a suite also the runs\n"
      "that kept trajectories. The page needs no network and opens from the disk. Examples:\n"
      "  aims report out/corridor-seed-1\n"
      "  aims report out/severity --against out/severity_before --out compare.html");
  command->callback([arguments, &exit_code] { exit_code = report_command(*arguments); });
}

}  // namespace aims
