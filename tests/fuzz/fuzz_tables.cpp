// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>
#include <vector>

#include "core/files/csv.hpp"
#include "core/files/csv_columns.hpp"
#include "core/files/inflate.hpp"
#include "core/files/kitti.hpp"
#include "core/files/number_lines.hpp"
#include "core/files/ply.hpp"
#include "core/files/tum.hpp"
#include "core/files/waypoint_times.hpp"
#include "core/text.hpp"
#include "recordings/frames/calibration_file.hpp"
#include "recordings/trajectories/trajectory_file.hpp"
#include "tests/fuzz/demand.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace aims {
namespace {

const std::string kName = "input";

void read_columns(std::string_view text) {
  const auto table = CsvColumns::parse(text, kName);
  if (!table) return demand_readable(table.error());
  CsvTable again(table->header());
  std::vector<std::vector<std::string>> columns;
  for (const std::string& name : table->header()) {
    columns.push_back(table->texts(name));
    demand(columns.back().size() == table->rows());
    const auto numbers = table->numbers(name);
    if (!numbers) demand_readable(numbers.error());
    if (numbers) demand(numbers->size() == table->rows());
  }
  for (std::size_t row = 0; row < table->rows(); ++row) {
    for (const auto& column : columns) again.add(column[row]);
    again.end_row();
  }
  const auto reread = CsvColumns::parse(again.text(), kName);
  demand(reread && reread->header() == table->header() && reread->rows() == table->rows());
}

void read_waypoint_times(std::string_view text) {
  const auto times = parse_waypoint_times(text, kName);
  if (!times) return demand_readable(times.error());
  CsvTable again({"point", "stamp_s"});
  for (const WaypointTime& each : *times) {
    again.add(each.point).add(stamp_text(each.stamp)).end_row();
  }
  const auto reread = parse_waypoint_times(again.text(), kName);
  demand(reread && reread->size() == times->size());
  for (std::size_t i = 0; i < times->size(); ++i) {
    demand((*reread)[i].point == (*times)[i].point && (*reread)[i].stamp == (*times)[i].stamp);
  }
}

template <class Value>
void refuse_readably(const Result<Value>& read) {
  if (!read) demand_readable(read.error());
}

}  // namespace

void fuzz_tables(std::span<const std::uint8_t> input) {
  constexpr std::size_t kMost = std::size_t{1} << 20;
  const auto unpacked = inflate(std::as_bytes(input), kMost);
  demand(!unpacked || unpacked->size() <= kMost);
  const std::string_view text = text_of(input);
  for (const PoseRules rules : {PoseRules::kAsGiven, PoseRules::kStrict}) {
    refuse_readably(parse_tum(text, kName, rules));
    refuse_readably(parse_kitti(text, kName, rules));
  }
  refuse_readably(parse_times(text, kName));
  refuse_readably(parse_ply(text, kName));
  read_columns(text);
  read_waypoint_times(text);
  const auto transforms = parse_calibration(std::string(text), kName);
  if (!transforms) demand_readable(transforms.error());
  for (const FixedTransform& each : transforms.value_or(std::vector<FixedTransform>())) {
    demand(each.T_parent_child.translation.allFinite());
    demand(std::abs(each.T_parent_child.rotation.norm() - 1.0) < 1e-9);
  }
  const MemoryFile file(std::as_bytes(input));
  refuse_readably(read_trajectory(file.path().string(), {}));
}

}  // namespace aims
