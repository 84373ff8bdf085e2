// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>
#include <vector>

#include "bench/estimate/convert.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

struct ConvertArguments {
  SharedOptions shared;
  std::vector<std::string> files;
  std::vector<std::string> drop;
  std::string compression = "none";
  bool recover = false;
};

int convert_command(const ConvertArguments& arguments) {
  const SharedOptions& shared = arguments.shared;
  const ConvertOptions options = {arguments.files.front(),
                                  shared.out,
                                  shared.overwrite,
                                  arguments.recover,
                                  *compression_named(arguments.compression),
                                  further(arguments.files),
                                  arguments.drop};
  watch_interrupt();
  ProgressDisplay display(arguments.files.front(), shared.quiet, "converted");
  const auto outcome =
      convert(options, [&display](const Progress& progress) { return display.show({}, progress); });
  display.close();
  if (!outcome) return bad_input("convert", outcome.error());
  if (!outcome->content.complete) return interrupted_code();
  if (!shared.quiet) {
    print_out("{}: {} messages, {} topics, {} bytes\n", shared.out, outcome->content.messages,
              outcome->content.topics, outcome->bytes);
  }
  if (outcome->lost_bytes > 0) {
    print_out("warning: {} damaged bytes were left out\n", outcome->lost_bytes);
  }
  if (!outcome->left_out.empty()) print_out("warning: {}\n", outcome->left_out);
  return kOk;
}

}  // namespace

void declare_convert(Command command, const fs::path& /*scenarios*/) {
  auto arguments = std::make_shared<ConvertArguments>();
  SharedOptions& shared = arguments->shared;
  command.arguments("bag", arguments->files,
                    "Recording of any format: files or folders, merged by record time",
                    Presence::kRequired);
  command.option("-o,--out", shared.out,
                 "Recording to write: NAME.bag, NAME.mcap, or NAME/ for rosbag2",
                 Presence::kRequired);
  command.list("--drop", arguments->drop, "Topics to leave out, e.g. /camera/image,/tf");
  add_compression(command, arguments->compression);
  command.flag("--recover", arguments->recover, "Read the intact part of a damaged recording");
  add_overwrite(command, shared);
  add_quiet(command, shared);
  command.footer(
      "Every value and record time of a topic that stays is kept. Messages of ROS 1 become those "
      "of ROS 2 in .mcap and "
      "in\n"
      "folders of rosbag2, whose names end in /; from ROS 2 to a ROS 1 bag there is no "
      "conversion.\n"
      "Examples:\n"
      "  aims convert robot.bag --out robot.mcap --compression zstd\n"
      "  aims convert robot.mcap --out robot/\n"
      "  aims convert robot.bag --drop /camera/image --out small.bag\n"
      "  aims convert damaged.mcap --recover --out intact.mcap");
  command.action([arguments] { return convert_command(*arguments); });
}

}  // namespace aims
