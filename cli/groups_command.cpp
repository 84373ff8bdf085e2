// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>

#include "bench/studies/drawn_groups.hpp"
#include "cli/commands.hpp"
#include "cli/json_output.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

constexpr const char* kGroupsName = "study groups";

struct GroupsArguments {
  std::string folder;
  std::string by;
  int bins = 4;
  SharedOptions shared;
  bool json = false;
};

int groups_command(const GroupsArguments& arguments) {
  const auto results = read_results(arguments.folder);
  if (!results) return refuse(kGroupsName, results.error(), arguments.json);
  const auto groups =
      group_by_drawn(*results, arguments.by, static_cast<std::size_t>(arguments.bins));
  if (!groups) return refuse(kGroupsName, {"--by " + groups.error().message}, arguments.json);
  if (arguments.json) {
    print_json(groups_json(*groups, arguments.by, arguments.folder));
  } else {
    print_out("By {}; medians over the valid runs\n{}{}\n", arguments.by,
              to_text(groups_table(*groups)), groups_legend(*groups));
    for (const DrawnGroup& group : *groups) {
      if (group.invalid == 0) continue;
      print_out("{}, {}: {} INVALID RUNS left out\n", group.scenario, group.label, group.invalid);
    }
  }
  if (arguments.shared.out.empty()) return kOk;
  const auto written = write_groups(*groups, arguments.by, arguments.folder, arguments.shared.out);
  return written ? kOk : bad_input(kGroupsName, written.error());
}

}  // namespace

void declare_groups(Command command) {
  auto arguments = std::make_shared<GroupsArguments>();
  command.argument("folder", arguments->folder, "Folder of aims run or aims suite");
  command.option("--by", arguments->by, "Quantity that the seeds drew, e.g. scene.corridor.width",
                 Presence::kRequired);
  command.option("--bins", arguments->bins, {1, 100},
                 "Bins of a number, of about equal numbers of runs (4)");
  add_out(command, arguments->shared, "nowhere: the result is only printed");
  add_json(command, arguments->json);
  command.footer(
      "Of scenarios with a draw list, e.g. random_corridor.\n"
      "Examples:\n"
      "  aims suite random_corridor --seeds 1-50 --out out/random\n"
      "  aims study groups out/random --by scene.corridor.width\n"
      "  aims study groups out/random --by scene.corridor.doors.sides --out out/by-doors");
  command.action([arguments] { return groups_command(*arguments); });
}

}  // namespace aims
