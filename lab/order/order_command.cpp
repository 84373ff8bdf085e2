// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>

#include "cli/options.hpp"
#include "cli/terminal.hpp"
#include "lab/commands.hpp"
#include "lab/order/order_study.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOrderName = "order";

struct OrderArguments {
  std::string folder;
  OrderOptions options;
  int bins = 4;
  SharedOptions shared;
};

int order_command(OrderArguments arguments) {
  const auto results = read_results(arguments.folder);
  if (!results) return bad_input(kOrderName, results.error());
  arguments.options.bins = static_cast<std::size_t>(arguments.bins);
  const auto study = order_study(*results, arguments.options);
  if (!study) return bad_input(kOrderName, study.error());
  print_out("{}\n\n{}\n", summary_text(*study), to_text(conditions_table(*study)));
  if (study->map) {
    print_out("Advantage over {} (columns) and {} (rows), better/units\n{}\n", study->map->x,
              study->map->y, to_text(map_table(*study->map)));
  }
  if (arguments.shared.out.empty()) return kOk;
  const auto written = write_order(*study, arguments.folder, arguments.shared.out);
  return written ? kOk : bad_input(kOrderName, written.error());
}

}  // namespace

void declare_order(Command command, const fs::path& /*scenarios*/) {
  auto arguments = std::make_shared<OrderArguments>();
  OrderOptions& options = arguments->options;
  command.argument("folder", arguments->folder, "Folder of aims suite on a scenario with draws");
  command.option("--adaptive", options.adaptive, "Estimator whose weights adapt (aims)");
  command.option("--fixed", options.fixed, "Estimator with fixed weights (tfs)");
  command.option("--score", options.score, "Score of both, smaller is better (ate_m)");
  command.option("--bins", arguments->bins, {1, 100},
                 "Bins of each condition, of about equal numbers of runs (4)");
  add_out(command, arguments->shared, "nowhere: the result is only printed");
  command.footer(
      "Examples:\n"
      "  aims suite random_conditions --seeds 1-200 --estimators leg,fast_lio2,tfs,aims \\\n"
      "    --out out/conditions\n"
      "  aims_lab order out/conditions --out out/order");
  command.action([arguments] { return order_command(*arguments); });
}

}  // namespace aims
