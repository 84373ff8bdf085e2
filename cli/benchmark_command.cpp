// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bench/studies/dataset_benchmark.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/suite_options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct BenchmarkArguments {
  SharedOptions shared;
  std::string profile;
  std::string data;
  std::vector<std::string> sequences;
  bool no_page = false;
  bool json = false;
  fs::path scenarios;
};

/// Beside the scenarios: models/datasets of the sources, datasets of an installation.
fs::path profile_folder(const fs::path& scenarios) {
  const fs::path root = fs::absolute(scenarios).lexically_normal().parent_path();
  const fs::path sources = root / "models" / "datasets";
  std::error_code ignored;
  return fs::is_directory(sources, ignored) ? sources : root / "datasets";
}

/// The sequences that were named; all without names.
Result<std::vector<DatasetSequence>> chosen(std::vector<DatasetSequence> all,
                                            const std::vector<std::string>& names) {
  if (names.empty()) return all;
  std::vector<std::string> known;
  for (const DatasetSequence& each : all) known.push_back(each.name);
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) != known.end()) continue;
    return failure(
        fmt::format("--sequences: no sequence '{}'; there are {}", name, fmt::join(known, ", ")));
  }
  std::erase_if(all, [&](const DatasetSequence& each) {
    return std::ranges::find(names, each.name) == names.end();
  });
  return all;
}

Result<Answer> benchmark_command(const BenchmarkArguments& arguments) {
  SharedOptions shared = arguments.shared;
  const auto file = find_dataset_profile(arguments.profile, profile_folder(arguments.scenarios));
  if (!file) return tl::unexpected(file.error());
  auto profile = load_dataset_profile(*file, overrides_of(shared));
  if (!profile) return tl::unexpected(profile.error());
  auto sequences = dataset_sequences(*profile, arguments.data);
  if (sequences) sequences = chosen(std::move(*sequences), arguments.sequences);
  if (!sequences) return tl::unexpected(sequences.error());
  if (shared.out.empty()) shared.out = (fs::path("out") / (profile->name + "-benchmark")).string();
  print_out("{}, score {}\n", profile->title, benchmark_score_text(*profile));
  for (const DatasetSequence& each : *sequences) {
    if (!each.lack.empty()) print_out("{} will not be scored: {}\n", each.name, each.lack);
  }
  std::fflush(stdout);  // before what the run says of itself
  watch_interrupt();
  JobDisplay display(shared.quiet);
  const auto done = run_dataset_benchmark(std::move(*profile), std::move(*sequences),
                                          job_options(shared), display.observer());
  if (!done) return tl::unexpected(done.error());
  if (auto written = write_benchmark(*done, shared.out); !written) {
    return tl::unexpected(written.error());
  }
  print_out("{}\n{}\n", done->profile.title, to_text(benchmark_table(*done)));
  for (const std::string& note : done->notes) print_out("note: {}\n", note);
  print_outcome(done->suite, shared);
  print_out("results: {}\n", (fs::path(shared.out) / "benchmark.md").string());
  if (!arguments.no_page) write_pages_of(shared.out, shared.quiet);
  return Answer{exit_code_of(done->suite), benchmark_json(*done)};
}

}  // namespace

void declare_benchmark(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<BenchmarkArguments>();
  SharedOptions& shared = arguments->shared;
  arguments->scenarios = scenarios;
  command.argument("profile", arguments->profile,
                   "Name of a data set (models/datasets), or a profile of your own",
                   Presence::kRequired);
  command.argument("folder", arguments->data,
                   "Folder of its recordings: files, or a folder of files per sequence",
                   Presence::kRequired);
  command.list("--sequences", arguments->sequences, "Only these, by name");
  add_estimators(command, shared, "those of the profile");
  add_settings(command, shared, "the profile", kGroupSetting);
  add_out(command, shared, "out/PROFILE-benchmark");
  add_jobs(command, shared);
  add_retry(command, shared);
  add_quiet(command, shared);
  command.flag("--no-page", arguments->no_page, "Write no HTML pages");
  add_json(command, arguments->json);
  command.footer(
      "Every sequence is estimated, scored as the authors of the data set score it, and put "
      "beside\n"
      "what they publish. The same command again continues.\n"
      "Examples:\n"
      "  aims benchmark geode ~/geode\n"
      "  aims benchmark grandtour ~/grandtour --estimators aims_d,lio,fast_lio2\n"
      "Exit codes: as of aims; 1 when a sequence failed.");
  command.action([arguments] {
    return answer("benchmark", arguments->json, [&] { return benchmark_command(*arguments); });
  });
}

}  // namespace aims
