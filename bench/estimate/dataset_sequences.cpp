// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/dataset_sequences.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <utility>

#include "bench/estimate/scoring_input.hpp"
#include "core/files/tum.hpp"
#include "recordings/source/recording_file.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Recordings by their names: reading each would take long, and notes lie beside them.
bool is_recording(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return fs::exists(path / "metadata.yaml", ignored);
  const auto format = format_by_name(path);
  return fs::is_regular_file(path, ignored) && format && *format != RecordingFormat::kCsv;
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code ignored;
  for (const auto& each : fs::directory_iterator(folder, ignored)) entries.push_back(each.path());
  std::ranges::sort(entries);
  return entries;
}

/// The first file of the pattern, in order of names.
fs::path first_match(const fs::path& pattern) {
  glob_t found{};
  fs::path first;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0 && found.gl_pathc > 0) {
    first = found.gl_pathv[0];
  }
  ::globfree(&found);
  return first;
}

/// `alone`: the sequence is the only one of the folder. Names without that of the sequence count in
/// the folder of the sequence alone.
std::string truth_of(const DatasetProfile& profile, const DatasetSequence& sequence,
                     const fs::path& folder, bool alone) {
  const std::string name = sequence.name;
  for (std::string pattern : profile.truth.files) {
    const bool of_sequence = alone || pattern.find("{sequence}") != std::string::npos;
    for (std::size_t at = 0; (at = pattern.find("{sequence}", at)) != std::string::npos;) {
      pattern.replace(at, 10, name);
      at += name.size();
    }
    for (const fs::path& below : {sequence.recording, folder}) {
      if (below == folder && !of_sequence) continue;
      const fs::path found = first_match(below / pattern);
      if (!found.empty()) return found.string();
    }
  }
  const std::string& topic = profile.truth.topic;
  return topic.empty() ? "" : fmt::format("{}:{}", sequence.recording.string(), topic);
}

/// Scores of the one estimate; none where the sequence has no truth.
Result<void> score_sequence(const DatasetProfile& profile, const DatasetSequence& sequence,
                            const std::string& label, Trajectory trajectory,
                            EstimateResult& result) {
  if (sequence.truth.empty() && profile.truth.end_pose.empty()) return {};
  ScoringRequest request;
  request.truth = sequence.truth;
  if (request.truth.empty()) request.end_pose = profile.truth.end_pose;
  request.estimates = request.names = {label};
  request.in_memory[label] = std::move(trajectory);
  request.extrinsic = profile.truth.extrinsic;
  request.lever_arm = request.truth.empty() ? "" : profile.truth.lever_arm;
  request.time_offset_s = profile.truth.time_offset_s;
  request.scoring = profile.read.scoring;
  request.is_configured = true;
  auto input = read_scoring_input(request);
  if (!input) return tl::unexpected(input.error());
  auto scores = score_trajectories(std::move(*input));
  if (!scores) return tl::unexpected(scores.error());
  if (auto ok = check_compared(*scores); !ok) return ok;
  result.scores = std::move(*scores);
  return {};
}

}  // namespace

Result<std::vector<DatasetSequence>> dataset_sequences(const DatasetProfile& profile,
                                                       const fs::path& folder) {
  std::vector<DatasetSequence> sequences;
  std::error_code ignored;
  if (is_recording(folder)) sequences.push_back({folder.stem().string(), folder, ""});
  const std::vector<fs::path> entries =
      sequences.empty() ? sorted_entries(folder) : std::vector<fs::path>();
  for (const fs::path& each : entries) {
    const bool holds =
        fs::is_directory(each, ignored) && std::ranges::any_of(sorted_entries(each), is_recording);
    if (is_recording(each) || holds) {
      const bool file = fs::is_regular_file(each, ignored);
      sequences.push_back({(file ? each.stem() : each.filename()).string(), each, ""});
    }
  }
  if (sequences.empty()) {
    return failure(
        fmt::format("{}: expected recordings (.bag, .mcap, .db3, folders of them), found "
                    "none",
                    folder.string()));
  }
  for (DatasetSequence& each : sequences) {
    each.truth = truth_of(profile, each, folder, sequences.size() == 1);
  }
  return sequences;
}

std::string fingerprint(const DatasetSequence& sequence) {
  std::vector<fs::path> files = {sequence.truth};
  std::error_code ignored;
  if (fs::is_directory(sequence.recording, ignored)) {
    const auto inside = sorted_entries(sequence.recording);
    files.insert(files.end(), inside.begin(), inside.end());
  } else {
    files.push_back(sequence.recording);
  }
  std::string text = sequence.name + '\n' + sequence.truth + '\n';
  for (const fs::path& each : files) {
    if (!fs::is_regular_file(each, ignored)) continue;
    text += fmt::format("{} {} {}\n", each.filename().string(), fs::file_size(each, ignored),
                        fs::last_write_time(each, ignored).time_since_epoch().count());
  }
  return text;
}

Result<EstimateResult> estimate_sequence(const DatasetProfile& profile,
                                         const DatasetSequence& sequence,
                                         const std::string& estimator, const fs::path& folder,
                                         const Observer& observer) {
  EstimateConfig config = profile.read;
  config.run = {estimator};
  EstimateOptions options;
  options.bag = sequence.recording;
  options.folder = folder;
  auto result = estimate(config, options, observer);
  if (!result) return tl::unexpected(result.error());
  if (result->broken) return tl::unexpected(*result->broken);
  if (!result->failures.empty()) return failure(result->failures.front().message);
  if (result->estimators.empty()) return failure("no poses");
  const std::string label = result->estimators.front().name;
  auto trajectory = read_tum(folder / (label + ".tum"), PoseRules::kAsGiven);
  if (!trajectory) return tl::unexpected(trajectory.error());
  auto scored = score_sequence(profile, sequence, label, std::move(*trajectory), *result);
  if (!scored) return failure("not scored: " + scored.error().message);
  return std::move(*result);
}

}  // namespace aims
