// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "render/page/page.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPages = 5;  ///< more are counted, but for the last, which has all runs

struct PageArguments {
  std::vector<std::string> folders;
  std::string out;
  std::string against;
  std::string detectors;
  SharedOptions shared;
};

bool is_terminal() { return isatty(STDERR_FILENO) != 0; }

void print_pages(const WrittenPages& written) {
  for (const std::string& warning : written.warnings) print_out("warning: {}\n", warning);
  const std::size_t count = written.pages.size();
  const std::size_t left_out = count > kMostPages ? count - 1 : 0;
  if (left_out > 0) {
    print_out("pages of {} runs, {} and others\n", left_out, written.pages.front().string());
  }
  for (std::size_t i = left_out; i < count; ++i) {
    print_out("page: {}\n", written.pages[i].string());
  }
}

/// The page of one folder, to the file that was asked for.
int write_one(const PageArguments& arguments, const PageOptions& options) {
  if (arguments.folders.size() != 1) {
    return bad_input(
        "page", {fmt::format("--out: expected one folder, found {}", arguments.folders.size())});
  }
  const auto written = write_page(arguments.folders.front(), arguments.out, options);
  if (!written) return bad_input("page", written.error());
  print_out("page: {}\n", arguments.out);
  return kOk;
}

int page_command(const PageArguments& arguments) {
  const PageOptions options = {arguments.against, arguments.detectors, {}};
  if (!arguments.out.empty()) return write_one(arguments, options);
  DrawDisplay display(arguments.shared.quiet);
  for (const std::string& folder : arguments.folders) {
    const auto written = write_pages(folder, options, display.observer());
    display.close();
    if (!written) return bad_input("page", written.error());
    print_pages(*written);
  }
  return kOk;
}

}  // namespace

void print_written(const Result<WrittenPages>& written) {
  if (written) {
    print_pages(*written);
  } else {
    print_out("warning: no page: {}\n", written.error().message);
  }
}

void write_pages_of(const fs::path& folder, bool quiet) {
  DrawDisplay display(quiet || !is_terminal());  // elsewhere the line "page: ..." is enough
  const auto written = write_pages(folder, {}, display.observer());
  display.close();
  print_written(written);
}

Result<void> write_page_of(const fs::path& folder, bool quiet) {
  DrawDisplay display(quiet || !is_terminal());
  announce(display.observer(), folder / kPageFile);
  const auto written = write_page(folder, folder / kPageFile);
  if (!written) return failure("no page: " + written.error().message);
  return {};
}

void declare_page(Command command, const fs::path& /*scenarios*/) {
  auto arguments = std::make_shared<PageArguments>();
  command.arguments("folder", arguments->folders,
                    "Folders of run, suite, estimate, score, sweep or tune", Presence::kRequired);
  command.option("-o,--out", arguments->out,
                 fmt::format("File to write, of one folder (FOLDER/{})", kPageFile));
  command.option("--against", arguments->against,
                 "Folder of earlier results to compare a suite with");
  command.option("--detectors", arguments->detectors,
                 "Folder of aims study detectors to show with a suite");
  add_quiet(command, arguments->shared);
  command.footer(
      "Several seeds get a page each; of a suite, so do the runs that kept trajectories. A page\n"
      "is one file that opens without a network or server.\n"
      "Examples:\n"
      "  aims page out/corridor-seed-1\n"
      "  aims page out/severity --against out/severity_before --out compare.html");
  command.action([arguments] { return page_command(*arguments); });
}

}  // namespace aims
