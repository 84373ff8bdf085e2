// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "core/files/output_folder.hpp"
#include "lab/baselines/baseline_fidelity.hpp"
#include "lab/commands.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "fidelity-baselines";
constexpr const char* kImu = "imu";
constexpr const char* kLidar = "lidar";

struct FidelityBaselinesArguments {
  SharedOptions shared;
  std::string bag;
  std::vector<std::string> topics;
  std::vector<std::string> references;
  std::string body = kImu;
  fs::path waypoint_times;
};

Result<BaselineFidelityRequest> request_of(const FidelityBaselinesArguments& arguments) {
  const auto overrides = overrides_of(arguments.shared, arguments.topics);
  if (!overrides) return tl::unexpected(overrides.error());
  auto config = load_estimate_config({}, *overrides);
  if (!config) return tl::unexpected(config.error());
  BaselineFidelityRequest request;
  request.config = std::move(*config);
  request.options = {arguments.bag, false, arguments.shared.jobs};
  request.references.assign(arguments.references.begin(), arguments.references.end());
  request.body = arguments.body == kLidar ? ReferenceBody::kLidar : ReferenceBody::kImu;
  request.waypoint_times = arguments.waypoint_times;
  return request;
}

int fidelity_baselines_command(const FidelityBaselinesArguments& arguments) {
  const SharedOptions& shared = arguments.shared;
  const auto request = request_of(arguments);
  if (!request) return bad_input(kName, request.error());
  watch_interrupt();
  auto folder = OutputFolder::create(shared.out, shared.overwrite);
  if (!folder) return bad_input(kName, folder.error());
  ProgressDisplay display(arguments.bag, shared.quiet, "read");
  const auto comparisons = baseline_fidelity(
      *request, [&](const Progress& progress) { return display.show(std::nullopt, progress); });
  display.close();
  if (interrupted()) return interrupted_code();
  if (!comparisons) return bad_input(kName, comparisons.error());
  auto written = write_baseline_fidelity(*comparisons, folder->path());
  if (written) written = folder->commit();
  if (!written) return bad_input(kName, written.error());
  print_out(
      "{}\nRMS, max: distance from the published positions, first poses equal\n"
      "within limits: M_list within 30 % or 0.05 percentage points, M_end within 30 % or\n"
      "0.05 m; where the published system diverges, so does the baseline\n"
      "results: {}\n",
      to_text(baseline_fidelity_table(*comparisons)),
      (folder->final_path() / "baselines.md").string());
  return kOk;
}

}  // namespace

void declare_fidelity_baselines(Command command, const fs::path& /*scenarios*/) {
  auto arguments = std::make_shared<FidelityBaselinesArguments>();
  SharedOptions& shared = arguments->shared;
  shared.out = "out/fidelity-baselines";
  command.argument("bag", arguments->bag, "Bag with ground truth");
  command.repeatable("--reference", arguments->references,
                     "Trajectory of a published system on that bag (TUM; seconds from its\n"
                     "start), one for each of --estimators",
                     Presence::kRequired);
  command.choice("--reference-body", arguments->body, {kImu, kLidar},
                 "Whose poses the references are (imu)");
  add_estimators(command, shared, "aims");
  command.list("--topics", arguments->topics, "SENSOR=TOPIC, e.g. imu=/imu/data_fast");
  command.option("--waypoint-times", arguments->waypoint_times,
                 "waypoint_times.csv of the sequence, for M_list (those in the bag)");
  add_settings(command, shared, "the configuration of aims estimate");
  add_out(command, shared, "out/fidelity-baselines");
  add_overwrite(command, shared);
  add_jobs(command, shared);
  add_quiet(command, shared);
  command.footer(
      "Both are scored at the stamps of the published poses.\n"
      "Examples:\n"
      "  aims_lab fidelity-baselines corridor.bag --estimators fast_lio2 \\\n"
      "    --reference published/fast_lio2.tum\n"
      "  aims_lab fidelity-baselines corridor.bag --estimators fast_lio2,lio \\\n"
      "    --reference fast_lio2.tum --reference other.tum --reference-body lidar");
  command.action([arguments] { return fidelity_baselines_command(*arguments); });
}

}  // namespace aims
