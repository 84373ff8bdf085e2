// SPDX-License-Identifier: BSD-3-Clause
#include "tests/render/page/written_run.hpp"

#include <fstream>
#include <iterator>
#include <sstream>

#include "bench/estimate/shown_scans.hpp"
#include "bench/scenario/scenario.hpp"
#include "bench/scoring/score_record.hpp"
#include "bench/scoring/tables.hpp"
#include "core/files/csv.hpp"
#include "core/files/ply.hpp"
#include "core/files/tum.hpp"
#include "core/random.hpp"
#include "estimator/aims/scan_diagnostics.hpp"

namespace aims::testing {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSeed = 3;
constexpr double kCovariance = 4e-4;  ///< of each axis [m^2]

/// Poses along +x from `first`, `step` apart, at 10 Hz.
Trajectory straight(const WrittenRun& run, const Eigen::Vector3d& first, double step) {
  Trajectory trajectory;
  for (int i = 0; i < run.scans; ++i) {
    StampedPose pose;
    pose.stamp = from_seconds(run.start_s + 0.1 * (i + 1));
    pose.pose.translation = first + Eigen::Vector3d(i * step, 0.0, 0.0);
    trajectory.push_back(pose);
  }
  return trajectory;
}

/// Points anywhere in the corridor around the start, in the odometry frame.
std::vector<Eigen::Vector3f> cloud(const WrittenRun& run, const std::string& name) {
  RandomStream stream(kSeed, "cloud " + name);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < run.map_points; ++i) {
    const Eigen::Vector3d point(stream.uniform(-5.0, 70.0), stream.uniform(-1.3, 1.3),
                                stream.uniform(0.0, 2.6));
    points.push_back(point.cast<float>());
  }
  return points;
}

void write_estimator(const fs::path& folder, const WrittenRun& run, const std::string& name,
                     double step, double noise = 0.0) {
  RandomStream stream(kSeed, name);
  const auto noisy = [&] { return noise * stream.uniform(-1.0, 1.0); };
  EstimatorOutcome outcome;
  outcome.name = name;
  outcome.result.trajectory = straight(run, Eigen::Vector3d::Zero(), step);
  outcome.result.diagnostics.series = scan_series();
  for (StampedPose& pose : outcome.result.trajectory) {
    pose.pose.translation += Eigen::Vector3d(noisy(), noisy(), noisy());
    ScanDiagnostics scan;
    scan.stamp = pose.stamp;
    scan.D = stream.uniform();
    scan.C_IL = stream.uniform();
    scan.gamma_lidar = stream.uniform();
    scan.innovation_position = {3e-3 + noisy(), 4e-3 + noisy(), 0.0};
    scan.covariance.position = kCovariance * (1.0 + noisy()) * Eigen::Matrix3d::Identity();
    outcome.result.diagnostics.scans.push_back(row_of(scan));
    outcome.scan_times.wall_ms.push_back(stream.uniform(1.0, 30.0));
  }
  put(folder / (name + ".tum"), tum_text(outcome.result.trajectory));
  put(folder / (name + ".diagnostics.csv"), diagnostics_table(rows_of(outcome)).text());
  if (run.map_points > 0) put(folder / (name + ".map.ply"), ply_text(cloud(run, name)));
}

std::string localizability_text(const WrittenRun& run) {
  CsvTable table({"stamp_s", "equivalent_returns", "weak_axis_x", "weak_axis_y", "weak_axis_z",
                  "degenerate_n10", "degenerate_n100"});
  for (int i = 0; i < run.scans; ++i) {
    table.add(run.start_s + 0.1 * (i + 1)).add(100.0 - i).add(1.0).add(0.0).add(0.0);
    table.add(false).add(i >= 10 && i < 20).end_row();
  }
  return table.text();
}

std::vector<std::string> names_of(const WrittenRun& run) {
  std::vector<std::string> names(std::begin(kMadeUpEstimators), std::end(kMadeUpEstimators));
  for (int i = 0; i < run.noisy; ++i) names.push_back("noisy_" + std::to_string(i));
  return names;
}

std::string scores_text(const WrittenRun& run) {
  Json scores = {
      {"schema", kScoresSchema},
      {"version", "0"},
      {"scenario", run.name},
      {"seed", 7},
      {"complete", true},
      {"simulated_s", 0.1 * run.scans},
      {"robot",
       {{"fell", false}, {"touched_wall", false}, {"valid", true}, {"invalid_reason", nullptr}}},
      {"segments", Json::array()}};
  for (const std::string& name : names_of(run)) {
    scores["estimators"][name] = {{"success", true}, {"diverged_at_s", nullptr}, {"ate_m", 0.125}};
  }
  return scores.dump(2) + "\n";
}

}  // namespace

std::string noisy_scans() {
  RandomStream stream(kSeed, "scans");
  std::vector<ShownScan> scans(kMostShownScans);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i] = {from_seconds(static_cast<double>(i + 1)), 28000, {}};
    for (std::size_t k = 0; k < kMostShownReturns; ++k) {
      const Eigen::Vector3d p(stream.uniform(-30.0, 30.0), stream.uniform(-1.3, 1.3),
                              stream.uniform(-0.3, 2.3));
      scans[i].shown.push_back({p.cast<float>(), static_cast<float>(stream.uniform())});
    }
  }
  return shown_scans_table(scans).text();
}

void put(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

void write_run(const fs::path& folder, const WrittenRun& run) {
  fs::create_directories(folder);
  Scenario scenario;
  scenario.name = run.name;
  scenario.simulation.lidar.range_max = 33.0;
  put(folder / "config.yaml", effective_config(scenario, 7));
  put(folder / "scores.json", scores_text(run));
  put(folder / "truth.tum", tum_text(straight(run, {1.0, 0.2, 0.3}, kStep)));
  put(folder / "localizability.csv", localizability_text(run));
  put(folder / "waypoint_times.csv", "point,stamp_s\n");
  for (const std::string& name : names_of(run)) {
    const bool noisy = name.starts_with("noisy");
    write_estimator(folder, run, name, (name == "exact" ? 1.0 : 1.1) * kStep, noisy ? 0.05 : 0.0);
  }
}

}  // namespace aims::testing
