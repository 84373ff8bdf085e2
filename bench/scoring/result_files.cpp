// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/result_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "bench/scoring/health_summary.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/tables.hpp"
#include "bench/scoring/validity.hpp"
#include "core/files/csv_columns.hpp"
#include "core/files/ply.hpp"
#include "core/files/tum.hpp"

namespace aims {

namespace fs = std::filesystem;

Result<void> write_record(const RunRecord& record, const fs::path& folder) {
  auto written = write_csv(folder / "scores.csv", scores_csv({&record, 1}));
  return written ? write_json(folder / "scores.json", record.scores) : written;
}

Result<RunRecord> read_record(const fs::path& file) {
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  auto parsed = parse_json(*text, file.string());
  if (!parsed) return tl::unexpected(parsed.error());
  Json& json = *parsed;
  const bool known = json.is_object() && value_in(json, "schema", "") == kScoresSchema &&
                     json.contains("seed") && json["seed"].is_number_unsigned() &&
                     json.contains("estimators") && json["estimators"].is_object();
  if (!known) return failure(fmt::format("{}: holds no {}", file.string(), kScoresSchema));
  mark_validity(json);  // of results from before it was written
  return RunRecord{json["seed"].get<std::uint64_t>(), std::move(json)};
}

std::string seed_folder_name(std::uint64_t seed) { return fmt::format("seed-{}", seed); }

std::vector<fs::path> seed_folders_in(const fs::path& parent) {
  std::vector<fs::path> folders;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(parent, ignored)) {
    const bool is_seed = entry.path().filename().string().starts_with("seed-");
    if (is_seed && entry.is_directory(ignored)) folders.push_back(entry.path());
  }
  const auto shorter_first = [](const fs::path& path) {
    const std::string name = path.filename().string();
    return std::pair(name.size(), name);
  };
  std::ranges::sort(folders, {}, shorter_first);
  return folders;
}

RowWriter::RowWriter(AtomicFile poses, AtomicFile scans, AtomicFile health)
    : poses_(std::move(poses)),
      scans_(std::move(scans)),
      health_(std::move(health)),
      health_table_(health_table({})) {}

Result<RowWriter> RowWriter::create(const fs::path& folder, const std::string& name) {
  auto poses = AtomicFile::create(folder / (name + ".tum"));
  if (!poses) return tl::unexpected(poses.error());
  auto scans = AtomicFile::create(folder / (name + ".diagnostics.csv"));
  if (!scans) return tl::unexpected(scans.error());
  auto health = AtomicFile::create(folder / (name + ".health.csv"));
  if (!health) return tl::unexpected(health.error());
  return RowWriter(std::move(*poses), std::move(*scans), std::move(*health));
}

Result<void> RowWriter::add(const EstimatorRows& rows) {
  if (scan_table_) {
    add_scans(rows, *scan_table_);
  } else {
    scan_table_ = diagnostics_table(rows);
  }
  add_health_rows(rows.health, health_table_);
  auto written = poses_.write(tum_text(rows.poses));
  if (written) written = scans_.write(scan_table_->take_text());
  if (written) written = health_.write(health_table_.take_text());
  return written;
}

Result<void> RowWriter::commit() {
  auto done = poses_.commit();
  if (done) done = scans_.commit();
  if (done) done = health_.commit();
  return done;
}

Result<void> write_estimator(const EstimatorOutcome& outcome, const fs::path& folder,
                             const std::string& name) {
  auto writer = RowWriter::create(folder, name);
  if (!writer) return tl::unexpected(writer.error());
  auto written = writer->add(rows_of(outcome));
  if (written) written = writer->commit();
  return written ? write_map_and_optimized(outcome, folder, name) : written;
}

Result<void> add_health_reasons(const fs::path& folder, const std::string& name,
                                const std::vector<std::string>& reasons) {
  const fs::path file = folder / (name + ".health.csv");
  if (reasons.empty() || !fs::exists(file)) return {};
  const auto rows = CsvColumns::read(file);
  if (!rows) return tl::unexpected(rows.error());
  const auto stamps = rows->texts("stamp_s"), states = rows->texts("state"),
             before = rows->texts("reasons"), sigmas = rows->texts("position_sigma_m");
  CsvTable table(rows->header());
  const std::string added = fmt::format("{}", fmt::join(reasons, "; "));
  for (std::size_t i = 0; i < rows->rows(); ++i) {
    const bool started = states[i] != name_of(HealthState::kStarting);
    const bool healthy = states[i] == name_of(HealthState::kHealthy);
    const std::string separator = before[i].empty() ? "" : "; ";
    table.add(stamps[i]);
    table.add(healthy ? std::string(name_of(HealthState::kDegraded)) : states[i]);
    table.add(started ? before[i] + separator + added : before[i]).add(sigmas[i]);
    table.end_row();
  }
  return write_csv(file, table);
}

Result<void> write_map_and_optimized(const EstimatorOutcome& outcome, const fs::path& folder,
                                     const std::string& name) {
  Result<void> written;
  if (outcome.result.optimized) {
    written = write_tum(folder / (name + kOptimizedEnding), *outcome.result.optimized);
  }
  if (written && !outcome.map.empty()) {
    written = write_ply(folder / (name + ".map.ply"), outcome.map);
  }
  return written;
}

Result<EstimatorOutcome> read_estimator(const fs::path& folder, const std::string& name,
                                        const EstimatorParts& parts) {
  EstimatorOutcome outcome;
  outcome.name = name;
  auto trajectory = read_tum(folder / (name + ".tum"), PoseRules::kAsGiven);
  if (!trajectory) return tl::unexpected(trajectory.error());
  outcome.result.trajectory = std::move(*trajectory);
  if (const fs::path file = folder / (name + kOptimizedEnding); fs::exists(file)) {
    auto optimized = read_tum(file, PoseRules::kAsGiven);
    if (!optimized) return tl::unexpected(optimized.error());
    outcome.result.optimized = std::move(*optimized);
  }
  if (parts.diagnostics) {
    auto diagnostics = read_diagnostics(folder / (name + ".diagnostics.csv"));
    if (!diagnostics) return tl::unexpected(diagnostics.error());
    outcome.result.diagnostics = std::move(*diagnostics);
  }
  const fs::path map = folder / (name + ".map.ply");
  if (!parts.map || !fs::exists(map)) return outcome;
  auto points = read_ply(map);
  if (!points) return tl::unexpected(points.error());
  outcome.map = std::move(*points);
  return outcome;
}

}  // namespace aims
