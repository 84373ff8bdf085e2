// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/report.hpp"
#include "core/files/csv.hpp"
#include "lab/order/order_study.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOrderIntroduction =
    "# Where adaptive weights help\n"
    "\n"
    "Advantage: {0} of `{1}` minus that of `{2}`, median over units with 95 % bootstrap interval;\n"
    "positive: `{2}` is better. A unit is a run whose seed drew all conditions. Association:\n"
    "Kendall's tau between condition and advantage over all units. Agreement: Kendall's tau "
    "between\n"
    "the paper's order and that of the unit, mean over the columns of the paper's table I and "
    "over\n"
    "units.\n";

std::string advantage_interval_text(const Interval& interval) {
  return interval.low ? fmt::format("[{:.3f}, {:.3f}]", *interval.low, *interval.high) : "–";
}

std::string tau_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "–";
}

Json bin_json(const OrderBin& bin) {
  return {{"low", bin.low},
          {"high", bin.high},
          {"units", bin.units},
          {"better", bin.better},
          {"advantage", bin.advantage},
          {"advantage_low", json_of(bin.interval.low)},
          {"advantage_high", json_of(bin.interval.high)},
          {"agreement", json_of(bin.tau)}};
}

Json condition_json(const OrderCondition& condition) {
  Json bins = Json::array();
  for (const OrderBin& bin : condition.bins) bins.push_back(bin_json(bin));
  return {{"key", condition.key},
          {"association", condition.association},
          {"association_low", json_of(condition.interval.low)},
          {"association_high", json_of(condition.interval.high)},
          {"agreement_association", json_of(condition.tau_association)},
          {"bins", std::move(bins)}};
}

Json map_json(const OrderMap& map) {
  Json cells = Json::array();
  for (const OrderMap::Cell& cell : map.cells) {
    cells.push_back(
        {{"x", cell.x}, {"y", cell.y}, {"bin", cell.bin ? bin_json(*cell.bin) : Json()}});
  }
  return {{"x", map.x}, {"y", map.y}, {"cells", std::move(cells)}};
}

Json order_json(const OrderStudy& study, const std::string& source) {
  Json conditions = Json::array();
  for (const OrderCondition& each : study.conditions) conditions.push_back(condition_json(each));
  return {{"schema", "aims.order/1"},
          {"folder", source},
          {"adaptive", study.options.adaptive},
          {"fixed", study.options.fixed},
          {"score", study.options.score},
          {"left_out", study.left_out},
          {"all", bin_json(study.all)},
          {"conditions", std::move(conditions)},
          {"map", study.map ? map_json(*study.map) : Json()}};
}

CsvTable order_csv(const OrderStudy& study) {
  std::vector<std::string> header = {"scenario", "seed", "advantage", "agreement"};
  for (const OrderCondition& condition : study.conditions) header.push_back(condition.key);
  CsvTable table(header);
  for (const OrderUnit& unit : study.units) {
    table.add(unit.scenario).add(unit.seed).add(unit.advantage).add(unit.tau);
    for (const OrderCondition& condition : study.conditions) {
      const auto drawn = unit.conditions.find(condition.key);
      table.add(drawn == unit.conditions.end() ? std::nullopt : std::optional(drawn->second));
    }
    table.end_row();
  }
  return table;
}

std::string order_markdown(const OrderStudy& study, const std::string& source) {
  const OrderOptions& options = study.options;
  std::string text =
      fmt::format(kOrderIntroduction, options.score, options.fixed, options.adaptive) +
      fmt::format("\n{}\n\n{}", summary_text(study), to_markdown(conditions_table(study)));
  if (study.map) {
    text += fmt::format("\nAdvantage over {} (columns) and {} (rows)\n\n{}", study.map->x,
                        study.map->y, to_markdown(map_table(*study.map)));
  }
  return text + fmt::format("\nFrom {}\n", source);
}

std::string map_cell_text(const std::optional<OrderBin>& bin) {
  return bin ? fmt::format("{:+.3f} ({}/{})", bin->advantage, bin->better, bin->units) : "–";
}

}  // namespace

TextTable conditions_table(const OrderStudy& study) {
  TextTable table;
  table.header = {"condition", "association", "95 % interval", "from",     "to",
                  "units",     "better",      "advantage",     "interval", "agreement"};
  for (const OrderCondition& condition : study.conditions) {
    bool first = true;
    for (const OrderBin& bin : condition.bins) {
      table.rows.push_back(
          {first ? condition.key : "", first ? fmt::format("{:+.2f}", condition.association) : "",
           first ? advantage_interval_text(condition.interval) : "", fmt::format("{:.4g}", bin.low),
           fmt::format("{:.4g}", bin.high), std::to_string(bin.units), std::to_string(bin.better),
           fmt::format("{:+.3f}", bin.advantage), advantage_interval_text(bin.interval),
           tau_text(bin.tau)});
      first = false;
    }
  }
  return table;
}

TextTable map_table(const OrderMap& map) {
  std::set<double> columns;
  for (const OrderMap::Cell& cell : map.cells) columns.insert(cell.x);
  TextTable table;
  table.header = {""};
  for (const double x : columns) table.header.push_back(fmt::format("{:.4g}", x));
  for (std::size_t i = 0; i < map.cells.size(); i += columns.size()) {
    std::vector<std::string> row = {fmt::format("{:.4g}", map.cells[i].y)};
    for (std::size_t j = 0; j < columns.size() && i + j < map.cells.size(); ++j) {
      row.push_back(map_cell_text(map.cells[i + j].bin));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string summary_text(const OrderStudy& study) {
  const OrderBin& all = study.all;
  return fmt::format(
      "{} is better than {} in {} of {} units; median advantage {:+.3f} {}, agreement with the "
      "paper's order {}; {} runs left out",
      study.options.adaptive, study.options.fixed, all.better, all.units, all.advantage,
      advantage_interval_text(all.interval), tau_text(all.tau), study.left_out);
}

Result<void> write_order(const OrderStudy& study, const std::string& source,
                         const fs::path& folder) {
  return write_report({.name = "order",
                       .markdown = order_markdown(study, source),
                       .csv = order_csv(study),
                       .json = order_json(study, source)},
                      folder);
}

}  // namespace aims
