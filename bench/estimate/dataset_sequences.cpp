// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/dataset_sequences.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "bench/estimate/scoring_input.hpp"
#include "core/files/tum.hpp"
#include "core/text.hpp"
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

/// Names of folders in which data sets keep the bags of one sequence.
bool is_folder_of_bags(const std::string& name) {
  constexpr std::array<std::string_view, 4> kNames = {"rosbag", "rosbags", "bag", "bags"};
  return std::ranges::find(kNames, lower_case(name)) != kNames.end();
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code ignored;
  for (const auto& each : fs::directory_iterator(folder, ignored)) entries.push_back(each.path());
  std::ranges::sort(entries);
  return entries;
}

/// The files of the pattern, in order of names.
std::vector<fs::path> matches_of(const fs::path& pattern) {
  glob_t found{};
  std::vector<fs::path> files;
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
  return files;
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

/// What {name} stands for: without the date, and without the first of the endings that it has.
std::string short_name(const std::string& sequence, const std::vector<std::string>& endings) {
  const std::string name = without_date(sequence);
  const std::string lower = lower_case(name);
  for (const std::string& each : endings) {
    if (each.empty() || lower.size() <= each.size() || !lower.ends_with(lower_case(each))) continue;
    return name.substr(0, name.size() - each.size());
  }
  return name;
}

/// The sequences of a data set and where their files are.
struct Places {
  const std::vector<DatasetSequence>& sequences;
  fs::path folder;
  std::vector<std::string> of_case = {};  ///< patterns that are for the sequence alone
};

/// Whether the name goes on behind `part`, as of another sequence: "tunnel10" behind "tunnel1", and
/// "day_2_leica" behind "day". A date of four digits and more does not.
bool goes_on(std::string_view name, std::string_view part) {
  const std::size_t at = part.empty() ? std::string_view::npos : name.find(part);
  if (at == std::string_view::npos) return false;
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::string_view rest = name.substr(at + part.size());
  if (rest.empty()) return false;
  if (std::isalnum(static_cast<unsigned char>(rest.front())) != 0) return true;
  if (rest.front() != '_' && rest.front() != '-') return false;
  rest.remove_prefix(1);
  const auto end = std::ranges::find_if_not(rest, is_digit);
  const auto digits = end - rest.begin();
  const bool number = end == rest.end() || std::isalpha(static_cast<unsigned char>(*end)) == 0;
  return number && digits > 0 && digits < 4;
}

/// Whether the name of the file is rather that of another sequence's, of which this one's name is a
/// part.
bool is_of_another(const fs::path& file, const std::string& short_of_own,
                   const DatasetSequence& sequence, const Places& places) {
  const std::string name = file.filename().string();
  const bool whole = name.find(sequence.name) != std::string::npos;
  if (goes_on(name, whole ? sequence.name : short_of_own)) return true;
  return std::ranges::any_of(places.sequences, [&](const DatasetSequence& other) {
    if (other.name == sequence.name) return false;
    for (const std::string& longer : {other.name, without_date(other.name)}) {
      if (name.find(longer) == std::string::npos) continue;
      for (const std::string& own : {sequence.name, short_of_own}) {
        if (longer.size() > own.size() && longer.find(own) != std::string::npos) return true;
      }
    }
    return false;
  });
}

/// A file, or why there is none.
struct FoundFile {
  std::string file;
  std::string several;  ///< those of one pattern, which does not say which of them
};

/// The first pattern that has a file decides. Names without that of the sequence count in its own
/// folder alone, and in that of all where it is the only one.
FoundFile file_of(const std::vector<std::string>& patterns, const DatasetTruth& truth,
                  const DatasetSequence& sequence, const Places& places) {
  const bool alone = places.sequences.size() == 1;
  for (const std::string& each : patterns) {
    const bool of_sequence = alone || each.find("{sequence}") != std::string::npos ||
                             each.find("{name}") != std::string::npos ||
                             std::ranges::find(places.of_case, each) != places.of_case.end();
    const std::string name = short_name(sequence.name, truth.name_without);
    const std::string pattern = filled(filled(each, "{sequence}", sequence.name), "{name}", name);
    const bool open = each.find('*') != std::string::npos;
    for (const fs::path& below : {sequence.recording, sequence.home, places.folder}) {
      const bool shared = below == places.folder && below != sequence.home;
      if (below.empty() || (shared && !of_sequence)) continue;
      std::vector<fs::path> found = matches_of(below / pattern);
      std::erase_if(found, [&](const fs::path& file) {
        return open && (is_of_another(file, name, sequence, places) || is_recording(file));
      });
      if (found.size() == 1) return {found.front().string(), ""};
      if (found.empty()) continue;
      std::vector<std::string> names;
      for (const fs::path& file : found) names.push_back(file.filename().string());
      return {"", fmt::format("{} are all named as {}", fmt::join(names, ", "), pattern)};
    }
  }
  return {};
}

/// What was looked for, and why it was not found.
std::string lack_of(const std::vector<std::string>& patterns, const DatasetTruth& truth,
                    const DatasetSequence& sequence, const FoundFile& found) {
  if (!found.several.empty()) return found.several + "; --set truth.files=[...] names one";
  if (patterns.empty()) return "no file is named";
  const auto is_general = [](const std::string& each) {
    return each.find("{sequence}") == std::string::npos && each.find("{name}") == std::string::npos;
  };
  const std::string names = fmt::format("{}", fmt::join(patterns, ", "));
  return fmt::format("looked for {}{}",
                     filled(filled(names, "{sequence}", sequence.name), "{name}",
                            short_name(sequence.name, truth.name_without)),
                     std::ranges::all_of(patterns, is_general)
                         ? ", which without {sequence} is looked for in its own folder alone"
                         : "");
}

/// Whether the truth states the end of that sequence.
bool has_end(const DatasetTruth& truth, const std::string& sequence) {
  if (truth.end_pose.empty()) return false;
  return truth.end_pose_of.empty() || holds_part(sequence, truth.end_pose_of);
}

std::string topic_of_recording(const fs::path& recording, const std::string& topic) {
  return fmt::format("{}:{}", recording.string(), topic);
}

void find_truth(const DatasetProfile& profile, const Places& places, DatasetSequence& sequence) {
  const DatasetTruth truth = truth_of(profile, sequence.name);
  const FoundFile found = file_of(truth.files, truth, sequence, places);
  const FoundFile points = file_of(truth.lever_arm_files, truth, sequence, places);
  sequence.truth = found.file;
  sequence.lever_arms = points.file;
  if (found.file.empty() && found.several.empty() && !truth.topic.empty()) {
    sequence.truth = topic_of_recording(sequence.recording, truth.topic);
  }
  if (sequence.truth.empty() && !has_end(truth, sequence.name)) {
    sequence.lack = "no truth: " + lack_of(truth.files, truth, sequence, found);
  } else if (!sequence.truth.empty() && !truth.lever_arm_files.empty() && points.file.empty() &&
             truth.lever_arm.empty()) {
    sequence.lack = "no measured points in the body: " +
                    lack_of(truth.lever_arm_files, truth, sequence, points);
  }
}

/// Scores of the one estimate; none where the sequence has no truth.
Result<void> score_sequence(const DatasetProfile& profile, const DatasetSequence& sequence,
                            const std::string& label, Trajectory trajectory,
                            EstimateResult& result) {
  if (!sequence.lack.empty()) return {};
  const DatasetTruth truth = truth_of(profile, sequence.name);
  ScoringRequest request;
  request.truth = sequence.truth;
  if (request.truth.empty()) request.end_pose = truth.end_pose;
  request.estimates = request.names = {label};
  request.in_memory[label] = std::move(trajectory);
  request.extrinsic = truth.extrinsic;
  if (!request.truth.empty()) {
    request.lever_arm = truth.lever_arm;
    request.lever_frame = truth.lever_arm_frame;
  }
  if (!sequence.lever_arms.empty()) {
    request.lever_arm.clear();
    request.lever_arms = sequence.lever_arms;
  }
  request.time_offset_s = truth.time_offset_s;
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

/// The folder itself, or the one below it in which data sets keep their bags; empty: neither.
fs::path folder_of_recordings(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return {};
  const std::vector<fs::path> entries = sorted_entries(folder);
  if (std::ranges::any_of(entries, is_recording)) return folder;
  for (const fs::path& each : entries) {
    if (!is_folder_of_bags(each.filename().string())) continue;
    if (fs::is_directory(each, ignored) && std::ranges::any_of(sorted_entries(each), is_recording))
      return each;
  }
  return {};
}

/// The recordings of a folder, without their truths.
std::vector<DatasetSequence> sequences_in(const fs::path& folder) {
  std::error_code ignored;
  const fs::path named = fs::absolute(folder, ignored).lexically_normal();
  const fs::path whole = named.filename().empty() ? named.parent_path() : named;
  if (is_recording(folder)) {
    const bool file = fs::is_regular_file(folder, ignored);
    return {{.name = (file ? whole.stem() : whole.filename()).string(),
             .recording = folder,
             .truth = "",
             .home = file ? whole.parent_path() : folder}};
  }
  const std::vector<fs::path> entries = sorted_entries(folder);
  const bool direct = std::ranges::any_of(entries, is_recording);
  const fs::path inside = folder_of_recordings(folder);
  if (!direct && !inside.empty()) {  // of one sequence, with its truth beside
    return {{.name = whole.filename().string(), .recording = inside, .truth = "", .home = folder}};
  }
  std::vector<DatasetSequence> sequences;
  for (const fs::path& each : entries) {
    if (is_recording(each)) {
      const bool file = fs::is_regular_file(each, ignored);
      sequences.push_back({.name = (file ? each.stem() : each.filename()).string(),
                           .recording = each,
                           .truth = "",
                           .home = file ? fs::path() : each});
    } else if (const fs::path below = folder_of_recordings(each); !below.empty()) {
      sequences.push_back(
          {.name = each.filename().string(), .recording = below, .truth = "", .home = each});
    }
  }
  return sequences;
}

}  // namespace

Result<std::vector<DatasetSequence>> dataset_sequences(const DatasetProfile& profile,
                                                       const fs::path& folder) {
  std::vector<DatasetSequence> sequences = sequences_in(folder);
  if (sequences.empty()) {
    return failure(
        fmt::format("{}: expected recordings (.bag, .mcap, .db3, folders of them), found "
                    "none",
                    folder.string()));
  }
  std::vector<DatasetSequence> found = sequences;
  for (DatasetSequence& each : found) {
    const TruthCase* own = case_of(profile, each.name);
    const auto files = own == nullptr ? std::vector<std::string>() : own->files;
    find_truth(profile, {sequences, folder, files}, each);
  }
  return found;
}

std::string truth_text(const DatasetProfile& profile, const DatasetSequence& sequence) {
  const std::string& topic = profile.truth.topic;
  const bool recorded =
      !topic.empty() && sequence.truth == topic_of_recording(sequence.recording, topic);
  return recorded ? fmt::format("topic {} of the recording", topic)
                  : fs::path(sequence.truth).filename().string();
}

std::vector<std::string> scoring_notes(const DatasetProfile& profile,
                                       const DatasetSequence& sequence) {
  if (!sequence.lack.empty()) return {"not scored: " + sequence.lack};
  const DatasetTruth truth = truth_of(profile, sequence.name);
  std::vector<std::string> notes = {
      sequence.truth.empty()
          ? fmt::format("truth: the pose of the end in the frame of the start, '{}', as the "
                        "profile states",
                        truth.end_pose)
          : fmt::format("truth: {}", truth_text(profile, sequence))};
  if (!truth.extrinsic.empty()) {
    notes.push_back(fmt::format("IMU in the body of the truth: {}", truth.extrinsic));
  } else if (!sequence.truth.empty() && truth.lever_arm.empty() && sequence.lever_arms.empty()) {
    notes.emplace_back(
        "the truth is taken to be of the IMU: the profile states no extrinsic and "
        "no lever arm");
  }
  const std::string frame =
      truth.lever_arm_frame.empty()
          ? ""
          : ", in a frame whose pose in the IMU frame is " + truth.lever_arm_frame;
  if (!sequence.lever_arms.empty()) {
    notes.push_back(fmt::format("measured points in the body: {}{}",
                                fs::path(sequence.lever_arms).filename().string(), frame));
  } else if (!sequence.truth.empty() && !truth.lever_arm.empty()) {
    notes.push_back("lever arm: " + truth.lever_arm + frame);
  }
  if (truth.time_offset_s != 0.0) {
    notes.push_back(fmt::format("{} s added to the stamps of the estimates", truth.time_offset_s));
  }
  const TruthCase* own = case_of(profile, sequence.name);
  if (own != nullptr && !own->note.empty()) notes.push_back(own->note);
  return notes;
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
