// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/dataset_sequences.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glob.h>

#include <algorithm>
#include <cctype>
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

/// The name without the date and time in front or behind it: "2021-07-01-10-37-38-quad-easy".
std::string without_date(const std::string& name) {
  constexpr std::string_view kDate = "0123456789-_";
  constexpr std::size_t kLeast = 8;  // digits of a date
  const auto digits = [](std::string_view text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](unsigned char c) { return std::isdigit(c) != 0; }));
  };
  const std::size_t first = name.find_first_not_of(kDate), last = name.find_last_not_of(kDate);
  if (first == std::string::npos) return name;
  const std::size_t begin = digits(name.substr(0, first)) >= kLeast ? first : 0;
  const bool dated = digits(name.substr(last + 1)) >= kLeast;
  return name.substr(begin, (dated ? last + 1 : name.size()) - begin);
}

std::string filled(std::string pattern, std::string_view key, const std::string& name) {
  for (std::size_t at = 0; (at = pattern.find(key, at)) != std::string::npos; at += name.size()) {
    pattern.replace(at, key.size(), name);
  }
  return pattern;
}

/// The first of the files that is there. `alone`: the sequence is the only one of the folder. Names
/// without that of the sequence count in the folder of the sequence alone.
std::string file_of(const std::vector<std::string>& patterns, const DatasetSequence& sequence,
                    const fs::path& folder, bool alone) {
  for (const std::string& each : patterns) {
    const bool of_sequence = alone || each.find("{sequence}") != std::string::npos ||
                             each.find("{name}") != std::string::npos;
    const std::string pattern =
        filled(filled(each, "{sequence}", sequence.name), "{name}", without_date(sequence.name));
    for (const fs::path& below : {sequence.recording, folder}) {
      if (below == folder && !of_sequence) continue;
      const fs::path found = first_match(below / pattern);
      if (!found.empty()) return found.string();
    }
  }
  return {};
}

void find_truth(const DatasetProfile& profile, const fs::path& folder, bool alone,
                DatasetSequence& sequence) {
  const DatasetTruth& truth = profile.truth;
  sequence.truth = file_of(truth.files, sequence, folder, alone);
  sequence.lever_arms = file_of(truth.lever_arm_files, sequence, folder, alone);
  if (sequence.truth.empty() && !truth.topic.empty()) {
    sequence.truth = fmt::format("{}:{}", sequence.recording.string(), truth.topic);
  }
  if (!sequence.truth.empty()) return;
  const std::string names = fmt::format("{}", fmt::join(truth.files, ", "));
  sequence.looked_for =
      filled(filled(names, "{sequence}", sequence.name), "{name}", without_date(sequence.name));
}

/// Whether the profile states the end of that sequence.
bool has_end(const DatasetTruth& truth, const std::string& sequence) {
  if (truth.end_pose.empty()) return false;
  return truth.end_pose_of.empty() ||
         std::ranges::any_of(truth.end_pose_of, [&sequence](const std::string& part) {
           return sequence.find(part) != std::string::npos;
         });
}

/// Scores of the one estimate; none where the sequence has no truth.
Result<void> score_sequence(const DatasetProfile& profile, const DatasetSequence& sequence,
                            const std::string& label, Trajectory trajectory,
                            EstimateResult& result) {
  if (sequence.truth.empty() && !has_end(profile.truth, sequence.name)) return {};
  ScoringRequest request;
  request.truth = sequence.truth;
  if (request.truth.empty()) request.end_pose = profile.truth.end_pose;
  request.estimates = request.names = {label};
  request.in_memory[label] = std::move(trajectory);
  request.extrinsic = profile.truth.extrinsic;
  if (!request.truth.empty()) request.lever_arm = profile.truth.lever_arm;
  if (!sequence.lever_arms.empty()) {
    request.lever_arm.clear();
    request.lever_arms = sequence.lever_arms;
    request.lever_frame = profile.truth.lever_arm_frame;
  }
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
    find_truth(profile, folder, sequences.size() == 1, each);
  }
  return sequences;
}

std::string fingerprint(const DatasetSequence& sequence) {
  std::vector<fs::path> files = {sequence.truth, sequence.lever_arms};
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
