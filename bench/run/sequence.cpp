// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/sequence.hpp"

#include <fmt/format.h>

#include <utility>

#include "bench/estimate/shown_scans.hpp"
#include "bench/run/run_legs.hpp"
#include "bench/scoring/tables.hpp"
#include "core/files/csv_columns.hpp"
#include "core/files/tum.hpp"
#include "core/files/waypoint_times.hpp"
#include "sim/environment/scene_config.hpp"

namespace aims {
namespace {

CsvTable snapshots_table(const std::vector<RobotSnapshot>& snapshots) {
  std::vector<std::string> header = {"stamp_s"};
  const std::size_t size = snapshots.empty() ? 0 : snapshots.front().qpos.size();
  for (std::size_t i = 0; i < size; ++i) header.push_back(fmt::format("q{}", i));
  CsvTable table(header);
  for (const RobotSnapshot& each : snapshots) {
    table.add(to_seconds(each.stamp));
    for (const double value : each.qpos) table.add(value);
    table.end_row();
  }
  return table;
}

Result<std::vector<LegInterval>> legs_of(const Sequence& sequence, const Scenario& scenario,
                                         const Truth& truth) {
  LegPackets packets;
  const auto replayed = sequence.reader.replay_without_points([&](const Delivery& delivery) {
    packets.count({&delivery, 1});
  });
  if (!replayed) return tl::unexpected(replayed.error());
  return leg_intervals(scenario.simulation, packets, truth, sequence.end());
}

/// Scans to look at, their motion undone with the truth.
Result<std::vector<ShownScan>> shown_scans(const SequenceReader& reader, const Trajectory& truth) {
  if (truth.empty()) return std::vector<ShownScan>();
  ScanKeeper keeper(truth.back().stamp - truth.front().stamp);
  auto replayed = reader.replay_some_points(
      [&](const LidarScan& scan) { return keeper.wants(scan); },
      [&](const Delivery& delivery) {
        if (const auto* scan = std::get_if<LidarScanPtr>(&delivery.measurement)) keeper.add(**scan);
      });
  if (!replayed) return tl::unexpected(replayed.error());
  return keeper.shown(truth, reader.rig().T_body_lidar);
}

}  // namespace

Result<Sequence> open_sequence(const std::filesystem::path& file, const Scenario& scenario,
                               std::uint64_t seed) {
  auto reader = SequenceReader::open(file);
  if (!reader) return tl::unexpected(reader.error());
  Truth truth = reader->truth();
  Trajectory poses = body_trajectory(truth);
  RunLocalizability localizability =
      run_localizability(scenario.simulation, reader->rig(), seed, truth, poses);
  return Sequence{std::move(*reader), std::move(poses), std::move(truth.waypoint_times),
                  std::move(localizability), truth.walk};
}

Result<void> write_sequence(const Sequence& sequence, const Scenario& scenario,
                            const std::filesystem::path& folder) {
  const Truth truth = sequence.reader.truth();
  const auto legs = legs_of(sequence, scenario, truth);
  if (!legs) return tl::unexpected(legs.error());
  const auto scans = shown_scans(sequence.reader, sequence.truth_trajectory);
  if (!scans) return tl::unexpected(scans.error());
  auto written = write_tum(folder / "truth.tum", thinned(sequence.truth_trajectory, kTruthSpacing));
  const auto write = [&](const char* name, const CsvTable& table) {
    if (written) written = write_csv(folder / name, table);
  };
  write("waypoint_times.csv", waypoint_times_table(sequence.waypoint_times));
  write("localizability.csv", localizability_table(sequence.localizability));
  write("legs.csv", legs_table(*legs));
  write("snapshots.csv", snapshots_table(truth.snapshots));
  write("scans.csv", shown_scans_table(*scans));
  return written;
}

Result<WrittenSequence> read_sequence(const std::filesystem::path& folder) {
  auto scenario = load_scenario(folder / "config.yaml", {});
  if (!scenario) return tl::unexpected(scenario.error());
  auto truth = read_tum(folder / "truth.tum");
  if (!truth) return tl::unexpected(truth.error());
  auto waypoint_times = read_waypoint_times(folder / "waypoint_times.csv");
  if (!waypoint_times) return tl::unexpected(waypoint_times.error());
  const auto seed = static_cast<std::uint64_t>(scenario->seed);
  Scene scene = build_scene(scenario->simulation.scene, seed);
  return WrittenSequence{std::move(*scenario), seed, std::move(scene), std::move(*truth),
                         std::move(*waypoint_times)};
}

Result<std::vector<RobotSnapshot>> read_snapshots(const std::filesystem::path& file) {
  const auto table = CsvColumns::read(file);
  if (!table) return tl::unexpected(table.error());
  std::vector<RobotSnapshot> snapshots(table->rows());
  for (const std::string& column : table->header()) {
    const auto values = table->numbers(column);
    if (!values) return tl::unexpected(values.error());
    for (std::size_t i = 0; i < snapshots.size(); ++i) {
      if (column == "stamp_s") {
        snapshots[i].stamp = from_seconds((*values)[i]);
      } else {
        snapshots[i].qpos.push_back((*values)[i]);
      }
    }
  }
  return snapshots;
}

Json sequence_json(const Sequence& sequence, const Scenario& scenario, const Scores& scores) {
  const RunLocalizability& localizability = sequence.localizability;
  Json json = sequence_json(to_seconds(sequence.end()), sequence.walk, scores, localizability.scans,
                            localizability.bounds);
  if (!scenario.drawn.empty()) json["drawn"] = drawn_json(scenario.drawn);
  return json;
}

}  // namespace aims
