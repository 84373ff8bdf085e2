// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench/cli/commands.hpp"
#include "bench/cli/exit_code.hpp"
#include "bench/cli/interrupt.hpp"
#include "bench/cli/options.hpp"
#include "bench/cli/progress_display.hpp"
#include "bench/run/seeds.hpp"
#include "estimator/estimator_spec.hpp"
#include "render/film/film_files.hpp"
#include "render/film/stored_sequence.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct RenderArguments {
  std::string source;
  std::string seed;
  std::vector<std::string> estimators;
  std::vector<std::string> overrides;
  std::string out;
  std::string size;
  std::string still_size;
  double at_s = 0.0;
  bool at_given = false;
  FilmOptions film;
  int jobs = default_jobs();
  bool quiet = false;
};

const std::map<std::string, FilmView> kViews = {{"follow", FilmView::kFollow},
                                                {"top", FilmView::kTop}};

/// Of a scenario that names no estimator that is asked for, its own first choice.
Result<Scenario> scenario_of(const RenderArguments& arguments, const fs::path& folder) {
  const fs::path source = arguments.source;
  auto file = holds_sequence(source) ? Result<fs::path>(source / "config.yaml")
                                     : find_scenario(arguments.source, folder);
  if (!file) return tl::unexpected(file.error());
  std::vector<std::string> overrides = arguments.overrides;
  if (!arguments.estimators.empty()) {
    overrides.push_back(estimators_setting(joined_specs(arguments.estimators)));
  }
  auto scenario = load_scenario(*file, overrides);
  if (!scenario || !arguments.estimators.empty()) return scenario;
  const auto labels = labels_of(scenario->estimators);
  const auto best = std::find(labels.begin(), labels.end(), "aims_d");
  const auto chosen = best == labels.end() ? 0 : best - labels.begin();
  if (!labels.empty())
    scenario->estimators = {scenario->estimators[static_cast<std::size_t>(chosen)]};
  return scenario;
}

Result<std::uint64_t> seed_of(const RenderArguments& arguments, const Scenario& scenario) {
  if (arguments.seed.empty()) return static_cast<std::uint64_t>(scenario.seed);
  const auto seeds = parse_seeds(arguments.seed);
  if (!seeds) return tl::unexpected(seeds.error());
  if (seeds->size() != 1) return failure("--seed: expected one seed: pictures are of one walk");
  return seeds->front();
}

Result<FilmOptions> options_of(const RenderArguments& arguments) {
  FilmOptions options = arguments.film;
  if (!options.still && options.video.empty() && !options.svg && !options.pdf) {
    options.still = true;
    options.video = "walk.webp";
  }
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
  if (arguments.at_given) options.at_s = arguments.at_s;
  options.out = arguments.out;
  if (auto checked = check(options); !checked) return tl::unexpected(checked.error());
  return options;
}

/// From files when they suffice; else simulated.
Result<FilmedSequence> sequence_of(const RenderArguments& arguments, const FilmOptions& options,
                                   const fs::path& folder) {
  if (!options.needs_simulation() && holds_sequence(arguments.source)) {
    if (!arguments.overrides.empty() || !arguments.seed.empty()) {
      return failure("--seed, --set: expected a scenario, since " + arguments.source +
                     " is a walk that was walked");
    }
    if (arguments.estimators.size() > 1) {
      return failure("--estimators: of a finished run expected one, whose map is drawn");
    }
    return stored_sequence(arguments.source,
                           arguments.estimators.empty() ? "" : arguments.estimators.front());
  }
  const auto scenario = scenario_of(arguments, folder);
  if (!scenario) return tl::unexpected(scenario.error());
  const auto seed = seed_of(arguments, *scenario);
  if (!seed) return tl::unexpected(seed.error());
  ProgressDisplay display(scenario->name, arguments.quiet);
  auto sequence = film_sequence(*scenario, {*seed, arguments.jobs}, [&](const Progress& progress) {
    display.show(*seed, progress);
    return !interrupted();
  });
  display.close();
  return sequence;
}

/// Says how far a video is, where somebody looks at it.
bool show_frame(bool quiet, int done, int frames) {
  if (!quiet && isatty(STDERR_FILENO) != 0) {
    fmt::print(stderr, "\rframe {} of {}{}", done + 1, frames, done + 1 == frames ? "\n" : " ");
  }
  return !interrupted();
}

int render_command(const RenderArguments& arguments, const fs::path& folder) {
  auto options = options_of(arguments);
  if (!options) return bad_input("render", options.error());
  if (fs::exists(options->out) && !options->overwrite) {
    return bad_input("render",
                     {options->out.string() +
                      ": exists already; give another --out, or --overwrite to replace it"});
  }
  watch_interrupt();
  const auto sequence = sequence_of(arguments, *options, folder);
  if (!sequence) return bad_input("render", sequence.error());
  if (interrupted()) return kInterrupted;
  if (options->out.empty()) {
    options->out =
        fs::path("out") / fmt::format("{}-seed-{}-render", sequence->scenario, sequence->seed);
  }
  const auto files = write_film(*sequence, *options, [&](int done, int frames) {
    return show_frame(arguments.quiet, done, frames);
  });
  if (interrupted()) return kInterrupted;
  if (!files) return bad_input("render", files.error());
  if (sequence->map.empty()) {
    fmt::print("no map: {} keeps none for it\n", arguments.source);
  }
  for (const fs::path& file : *files) fmt::print("{}\n", file.string());
  return kOk;
}

void add_what(CLI::App& command, RenderArguments& arguments) {
  command.add_flag("--still", arguments.film.still, "still.png, for papers and pages");
  command.add_option("--video", arguments.film.video,
                     "Looped video of that name: .webp (animated), .mp4 or\n"
                     ".webm (by ffmpeg, on PATH)");
  command.add_flag("--svg", arguments.film.svg, "Trajectories and maps as SVG");
  command.add_flag("--pdf", arguments.film.pdf, "Trajectories and maps as PDF");
}

void add_how(CLI::App& command, RenderArguments& arguments) {
  command.add_option("--view", arguments.film.view, "follow or top (follow)")
      ->transform(CLI::CheckedTransformer(kViews));
  command.add_option("--size", arguments.size, "Of the video [px] (640x400)");
  command.add_option("--still-size", arguments.still_size, "Of the still [px] (2400x1350)");
  command.add_option("--fps", arguments.film.frame_rate, "Frames of the video per second (12)")
      ->check(CLI::Range(1.0, 60.0));
  command.add_option("--seconds", arguments.film.seconds, "Length of the video (8)")
      ->check(CLI::Range(0.1, 600.0));
  command
      .add_option("--at", arguments.at_s, "Instant of the still [s] (three quarters of the way)")
      ->each([&arguments](const std::string&) { arguments.at_given = true; });
}

}  // namespace

void add_render_command(CLI::App& app, const fs::path& scenario_folder, int& exit_code) {
  auto* command =
      app.add_subcommand("render", "Draw a walk: a still, a looped video, vector pictures");
  auto arguments = std::make_shared<RenderArguments>();
  command
      ->add_option("source", arguments->source,
                   "Scenario file, its bare name, or the folder of a run")
      ->required();
  add_what(*command, *arguments);
  command->add_option("--seed", arguments->seed, "Seed of the walk (the scenario's)");
  command
      ->add_option("--estimators", arguments->estimators,
                   "Estimators to run (aims_d); of the first is the map")
      ->delimiter(',');
  add_repeatable(*command, "--set", arguments->overrides,
                 "key=value on top of the scenario; repeatable");
  add_how(*command, *arguments);
  command->add_option("--out", arguments->out,
                      "Folder for the pictures (out/SCENARIO-seed-N-render)");
  add_jobs_option(*command, arguments->jobs, "Threads; the pictures do not depend on it");
  command->add_flag("--overwrite", arguments->film.overwrite, "Replace pictures that exist");
  command->add_flag("--quiet", arguments->quiet, "No progress");
  command->footer(
      "Without --still, --video, --svg or --pdf it draws the still and walk.webp. Still and video\n"
      "are simulated, also from the folder of a run (its config.yaml); --svg and --pdf of such a\n"
      "folder are drawn from its files.\n"
      "Examples:\n"
      "  aims render corridor --seed 1 --out out/render\n"
      "  aims render garage --video walk.mp4 --size 1280x720 --fps 25 --seconds 12\n"
      "  aims render out/corridor-seed-1 --svg --pdf");
  command->callback([arguments, scenario_folder, &exit_code] {
    exit_code = render_command(*arguments, scenario_folder);
  });
}

}  // namespace aims
