// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "live/dds/dds_program.hpp"
#include "live/dds/dds_transport.hpp"
#include "live/dds/discovery.hpp"
#include "live/dds/playback.hpp"
#include "recordings/source/recording_file.hpp"

namespace aims {
namespace {

constexpr const char* kProgram = "aims_play";
constexpr double kMaxBlocking = 10.0;  ///< a player waits for its subscribers [s]

struct PlayArguments {
  std::vector<std::string> files;
  DdsOptions dds;
  PlaybackOptions playback;
};

void add_options(CLI::App& app, PlayArguments& arguments) {
  app.add_option("recording", arguments.files,
                 "Recording, simulated or of a robot: files or folders, merged by record time")
      ->required();
  app.add_option("--rate", arguments.playback.rate, "Of the recording's pace (1)")
      ->check(CLI::Range(0.01, 1000.0));
  app.add_option("--domain", arguments.dds.domain, "DDS domain ($ROS_DOMAIN_ID, else 0)")
      ->check(CLI::Range(0, 232));
  app.add_option("--topics", arguments.playback.topics, "Only these, e.g. /imu/data,/lidar/points")
      ->delimiter(',');
  app.add_flag("--wait", arguments.playback.wait,
               "Start once each topic has a subscriber; else after a second");
  app.footer(
      "The time of sending is the record time. CYCLONEDDS_URI chooses the interfaces.\n"
      "Exit codes: 0 ok, also when interrupted; 2 bad usage, recording or network.");
}

int run(const PlayArguments& arguments) {
  std::vector<std::filesystem::path> with(arguments.files.begin() + 1, arguments.files.end());
  const auto recording = open_recording(arguments.files.front(), {.with = std::move(with)});
  if (!recording) return report_bad_input(kProgram, recording.error().message);
  const auto transport = DdsTransport::connect(arguments.dds);
  if (!transport) return report_bad_input(kProgram, transport.error().message);
  const auto outcome = play(**recording, **transport, arguments.playback);
  for (const std::string& problem : (*transport)->take_problems()) {
    fmt::print(stderr, "aims_play: warning: {}\n", problem);
  }
  if (!outcome) return report_bad_input(kProgram, outcome.error().message);
  for (const std::string& skipped : outcome->skipped) {
    fmt::print(stderr, "aims_play: warning: not played: {}\n", skipped);
  }
  fmt::print("{} messages of {} topics on domain {}{}\n", outcome->messages, outcome->topics,
             arguments.dds.domain, outcome->complete ? "" : ", interrupted");
  if (outcome->blocked > 0) {
    fmt::print("warning: {} messages were not sent: a subscriber is too slow\n", outcome->blocked);
  }
  if (outcome->unsendable > 0) {
    fmt::print(
        "warning: {} messages were not sent: DDS holds times from 1970 to 2038, the first was "
        "recorded at {} s\n",
        outcome->unsendable, stamp_text(outcome->unsendable_time));
  }
  if (outcome->unanswered > 0) {
    fmt::print("warning: {} topics have a subscriber that did not acknowledge the last messages\n",
               outcome->unanswered);
  }
  return kLiveOk;
}

int main_of(int argc, char** argv) {
  PlayArguments arguments;
  const auto domain = default_domain();
  if (!domain) return report_bad_input(kProgram, domain.error().message);
  arguments.dds.domain = *domain;
  arguments.dds.node = "aims_play";
  arguments.dds.keep_all = true;
  arguments.dds.max_blocking = kMaxBlocking;
  CLI::App app("Publishes a recording on DDS at its own pace, as ROS 2 nodes do.", "aims_play");
  add_options(app, arguments);
  arguments.playback.waiting = [](const std::string& missing) {
    fmt::print(stderr, "{}: waiting: {}\n", kProgram, missing);
  };
  if (const auto exit_code = exit_after_parsing(app, kProgram, argc, argv)) return *exit_code;
  return run(arguments);
}

}  // namespace
}  // namespace aims

int main(int argc, char** argv) {
  return aims::guarded_main(aims::kProgram, [&] { return aims::main_of(argc, argv); });
}
