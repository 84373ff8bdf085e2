// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "estimator/estimator_spec.hpp"
#include "render/film/film_files.hpp"
#include "render/film/filmed_sequence.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct RenderArguments {
  SharedOptions shared;  ///< `scenario`: a scenario or the folder of a run
  bool still = false;
  bool svg = false;
  bool pdf = false;
  std::string video;
  std::string view;
  std::string size;
  std::string still_size;
  std::optional<double> fps;
  std::optional<double> seconds;
  std::optional<double> at_s;
};

const std::map<std::string, FilmView> kViews = {{"follow", FilmView::kFollow},
                                                {"top", FilmView::kTop}};

/// With --estimators those; else aims_d, or the first estimator of the scenario.
Result<Scenario> rendered_scenario(const SharedOptions& given) {
  SharedOptions shared = given;
  if (holds_sequence(shared.scenario)) {
    shared.scenario = (fs::path(shared.scenario) / "config.yaml").string();
  }
  auto scenario = scenario_of(shared);
  if (!scenario || !shared.estimators.empty() || scenario->run.empty()) return scenario;
  const auto labels = labels_of(scenario->run);
  const auto best = std::find(labels.begin(), labels.end(), "aims_d");
  const auto chosen = best == labels.end() ? 0 : best - labels.begin();
  scenario->run = {scenario->run[static_cast<std::size_t>(chosen)]};
  return scenario;
}

/// Error for options of a picture that is not drawn.
Result<void> check_use(const RenderArguments& arguments, const FilmOptions& options) {
  const bool of_video = !arguments.size.empty() || arguments.fps || arguments.seconds;
  if (of_video && options.video.empty()) {
    return failure("--size, --fps, --seconds: no effect without --video");
  }
  const bool of_still = !arguments.still_size.empty() || arguments.at_s;
  if (of_still && !options.still) return failure("--still-size, --at: no effect without --still");
  if (!arguments.view.empty() && options.video.empty() && !options.still) {
    return failure("--view: no effect without --still or --video");
  }
  return {};
}

Result<FilmOptions> options_of(const RenderArguments& arguments) {
  FilmOptions options;
  options.still = arguments.still;
  options.video = arguments.video;
  options.svg = arguments.svg;
  options.pdf = arguments.pdf;
  if (!options.still && options.video.empty() && !options.svg && !options.pdf) {
    options.still = true;
    options.video = "film.webp";
  }
  if (auto used = check_use(arguments, options); !used) return tl::unexpected(used.error());
  if (!arguments.view.empty()) options.view = kViews.at(arguments.view);
  options.frame_rate = arguments.fps.value_or(options.frame_rate);
  options.seconds = arguments.seconds.value_or(options.seconds);
  for (const auto& [text, size] : {std::pair{&arguments.size, &options.video_size},
                                   {&arguments.still_size, &options.still_size}}) {
    if (text->empty()) continue;
    const auto parsed = parse_picture_size(*text);
    if (!parsed) {
      const char* name = text == &arguments.size ? "--size " : "--still-size ";
      return failure(name + parsed.error().message);
    }
    *size = *parsed;
  }
  if (arguments.at_s) options.at_s = *arguments.at_s;
  options.out = arguments.shared.out;
  options.overwrite = arguments.shared.overwrite;
  if (auto checked = check(options); !checked) return tl::unexpected(checked.error());
  return options;
}

/// From files when they suffice; else simulated.
Result<FilmedSequence> sequence_of(const SharedOptions& shared, const FilmOptions& options) {
  if (!options.needs_simulation() && holds_sequence(shared.scenario)) {
    if (!shared.settings.empty() || !shared.seeds.empty()) {
      return failure("--seeds, --set: no effect, since the sequence is read from " +
                     shared.scenario);
    }
    const auto specs = joined_specs(shared.estimators);
    if (specs.size() > 1) {
      return failure("--estimators: of a finished run expected one, whose map is drawn");
    }
    return stored_sequence(shared.scenario, specs.empty() ? "" : specs.front());
  }
  const auto scenario = rendered_scenario(shared);
  if (!scenario) return tl::unexpected(scenario.error());
  const auto seed = seed_of(shared, *scenario);
  if (!seed) return tl::unexpected(seed.error());
  ProgressDisplay display(scenario->name, shared.quiet);
  return film_sequence(*scenario, {*seed, shared.jobs},
                       [&](const Progress& progress) { return display.show(*seed, progress); });
}

/// Shows the progress of a video on a terminal; false after Ctrl-C.
bool show_frame(bool quiet, int done, int frames) {
  if (!quiet && isatty(STDERR_FILENO) != 0) {
    fmt::print(stderr, "\rframe {} of {}{}", done + 1, frames, done + 1 == frames ? "\n" : " ");
  }
  return !interrupted();
}

int render_command(const RenderArguments& arguments) {
  const SharedOptions& shared = arguments.shared;
  auto options = options_of(arguments);
  if (!options) return bad_input("render", options.error());
  if (fs::exists(options->out) && !options->overwrite) {
    return bad_input("render", {options->out.string() +
                                ": exists; give another --out, or --overwrite to replace it"});
  }
  watch_interrupt();
  const auto sequence = sequence_of(shared, *options);
  if (!sequence) return bad_input("render", sequence.error());
  if (interrupted()) return interrupted_code();
  if (options->out.empty()) {
    options->out =
        fs::path("out") / fmt::format("{}-seed-{}-render", sequence->scenario, sequence->seed);
  }
  const auto files = write_film(*sequence, *options, [&](int done, int frames) {
    return show_frame(shared.quiet, done, frames);
  });
  if (interrupted()) return interrupted_code();
  if (!files) return bad_input("render", files.error());
  if (sequence->map.empty()) print_out("no map: {} has none\n", shared.scenario);
  for (const fs::path& file : *files) print_out("{}\n", file.string());
  return kOk;
}

void add_outputs(Command& command, RenderArguments& arguments) {
  command.flag("--still", arguments.still, "still.png, for papers and pages");
  command.option("--video", arguments.video,
                 "Looped video of that name: .webp (animated), .mp4 or\n"
                 ".webm (by ffmpeg, on PATH)");
  command.flag("--svg", arguments.svg, "Trajectories and maps as SVG");
  command.flag("--pdf", arguments.pdf, "Trajectories and maps as PDF");
  command.choice("--view", arguments.view, {"follow", "top"}, "Camera (follow)");
  command.option("--size", arguments.size, "Size of the video [px] (640x400)");
  command.option("--still-size", arguments.still_size, "Size of the still [px] (2400x1350)");
  command.option("--fps", arguments.fps, {1.0, 60.0}, "Frames of the video per second (12)");
  command.option("--seconds", arguments.seconds, {0.1, 600.0}, "Length of the video [s] (8)");
  command.option("--at", arguments.at_s, {-1e12, 1e12},
                 "Time of the still [s] (three quarters of the sequence)");
}

}  // namespace

void declare_render(Command command, const fs::path& scenarios) {
  auto arguments = std::make_shared<RenderArguments>();
  SharedOptions& shared = arguments->shared;
  shared.folder = scenarios.string();
  command.argument("source", shared.scenario, "Scenario file, its name, or the folder of a run");
  add_folder(command, shared);
  add_outputs(command, *arguments);
  add_seeds(command, shared, "that of the scenario; one");
  add_robot_seed(command, shared);
  add_estimators(command, shared, "aims_d; the map is of the first");
  add_settings(command, shared);
  add_out(command, shared, "out/SCENARIO-seed-N-render");
  add_overwrite(command, shared);
  add_jobs(command, shared);
  add_quiet(command, shared);
  command.footer(
      "Without --still, --video, --svg or --pdf: --still --video film.webp. Still and video are\n"
      "simulated, also from the folder of a run (its config.yaml); --svg and --pdf of such a\n"
      "folder are drawn from its files.\n"
      "Examples:\n"
      "  aims render corridor --seeds 1 --out out/render\n"
      "  aims render garage --video walk.mp4 --size 1280x720 --fps 25 --seconds 12\n"
      "  aims render out/corridor-seed-1 --svg --pdf");
  command.action([arguments] { return render_command(*arguments); });
}

}  // namespace aims
