// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/trajectory_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/files/kitti.hpp"
#include "core/files/number_lines.hpp"
#include "core/files/pose_cleaning.hpp"
#include "core/files/text_file.hpp"
#include "core/text.hpp"
#include "recordings/source/recording_file.hpp"
#include "recordings/trajectories/bag_trajectory.hpp"
#include "recordings/trajectories/pose_table.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Numbers of trajectories in text that are not finite: NaN, infinity, or empty cells, which are
/// NaN. The lines are those of TUM, of positions or of KITTI poses.

constexpr std::array<std::string_view, 8> kNames = {"stamp", "x", "y", "z", "qx", "qy", "qz", "qw"};

bool is_missing(std::string_view word) {
  const auto number = parse_number(word, false);
  return number && !std::isfinite(*number);
}

std::string_view word_for(std::string_view word) {
  return std::isnan(*parse_number(word, false)) ? "NaN (or an empty cell)" : "infinite";
}

/// The column of a number, by its name where the lines have stamps.
std::string column_text(std::size_t column, std::size_t columns) {
  return columns > kNames.size() ? fmt::format("column {}", column + 1)
                                 : std::string(kNames[column]);
}

/// Whether the words are of a line with a stamp in front.
bool has_stamp(std::size_t words) { return words <= kNames.size(); }

/// The lines with blank ones in place of those without a finite stamp, at which no pose can be;
/// notes how many, and the first.
std::string with_stamps(std::string_view text, const std::string& name,
                        std::vector<std::string>& notes) {
  std::string kept;
  kept.reserve(text.size());
  int line_number = 0, left_out = 0, first = 0;
  while (!text.empty()) {
    const std::string_view line = take_until(text, '\n');
    ++line_number;
    const auto words = words_of(line);
    if (!words.empty() && has_stamp(words.size()) && is_missing(words[0])) {
      first = left_out++ == 0 ? line_number : first;
    } else {
      kept += line;
    }
    kept += '\n';
  }
  if (left_out > 0) {
    notes.push_back(
        fmt::format("{}:{}: the stamp is NaN (or an empty cell): {} such line{} left out", name,
                    first, left_out, left_out == 1 ? " is" : "s are"));
  }
  return kept;
}

/// Notes the first number that is not finite behind the stamps, and how many lines hold one.
void note_missing_numbers(std::string_view text, const std::string& name,
                          std::vector<std::string>& notes) {
  LineReader lines(text, name);
  int found = 0;
  std::string first;
  while (const auto line = lines.next()) {
    const auto words = words_of(*line);
    const auto missing = std::ranges::find_if(words, is_missing);
    if (missing == words.end() || found++ > 0) continue;
    const auto column = static_cast<std::size_t>(missing - words.begin());
    first = fmt::format("{}:{}: {} is {}", name, lines.number(), column_text(column, words.size()),
                        word_for(*missing));
  }
  if (found == 0) return;
  notes.push_back(fmt::format("{}: {} line{} such a number, and {} no pose", first, found,
                              found == 1 ? " holds" : "s hold", found == 1 ? "is" : "are"));
}

constexpr std::size_t kPositionColumns = 4;
constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kKittiColumns = 12;

/// A file, and the topic after a colon unless the source itself is a file; with ":PARENT,CHILD" of
/// tf.
struct Source {
  fs::path file;
  std::string topic;
};

Source split(const std::string& source) {
  std::error_code ignored;
  const std::size_t colon = source.rfind(':');
  if (fs::exists(source, ignored) || colon == std::string::npos) return {source, ""};
  const std::size_t before = colon == 0 ? std::string::npos : source.rfind(":/", colon - 1);
  if (before != std::string::npos && source.find(',', colon) != std::string::npos) {
    return {source.substr(0, before), source.substr(before + 1)};
  }
  const bool names_topic = source.find('/', colon) == colon + 1;
  if (!names_topic && !fs::exists(source.substr(0, colon), ignored)) return {source, ""};
  return {source.substr(0, colon), source.substr(colon + 1)};
}

Result<Trajectory> stamped(const std::vector<Pose>& poses, const std::string& name,
                           const std::vector<StampList>& lists, std::vector<std::string>& notes) {
  std::vector<std::string> counts;
  for (const StampList& list : lists) {
    counts.push_back(fmt::format("{} has {}", list.name, list.stamps.size()));
    if (list.stamps.size() != poses.size()) continue;
    Trajectory trajectory;
    for (std::size_t i = 0; i < poses.size(); ++i) trajectory.push_back({list.stamps[i], poses[i]});
    notes.push_back(fmt::format("{}: KITTI poses take the stamps of {}", name, list.name));
    return trajectory;
  }
  return failure(
      fmt::format("{}: {} KITTI poses without stamps; expected a file with as many, one "
                  "stamp in seconds a line (--times){}{}",
                  name, poses.size(), counts.empty() ? "" : "; ", fmt::join(counts, ", ")));
}

/// Lines "stamp x y z" in seconds and metres; what is not finite is kept, for scoring to count.
Result<Trajectory> parse_positions(std::string_view text, const std::string& name) {
  Trajectory positions;
  LineReader lines(text, name);
  while (const auto line = lines.next()) {
    const auto words = words_of(*line);
    StampedPose pose;
    const auto stamp = words.empty() ? std::nullopt : parse_stamp(words[0]);
    bool good = words.size() == kPositionColumns && stamp;
    for (std::size_t i = 1; good && i < kPositionColumns; ++i) {
      const auto number = parse_number(words[i], false);
      good = number.has_value();
      pose.pose.translation[static_cast<Eigen::Index>(i) - 1] = number.value_or(0.0);
    }
    if (!good) return lines.error("expected a position: stamp x y z");
    pose.stamp = *stamp;
    positions.push_back(pose);
  }
  return positions;
}

/// The lines with their stamps in seconds; comments as they are.
std::string in_seconds(std::string_view text, int decimals) {
  if (decimals == 0) return std::string(text);
  std::string result;
  while (!text.empty()) {
    const std::string_view line = take_until(text, '\n');
    const auto words = words_of(line);
    if (words.empty() || words[0].starts_with('#')) {
      result += line;
    } else {
      const auto after = static_cast<std::size_t>(words[0].data() - line.data()) + words[0].size();
      result += stamp_in_seconds(words[0], decimals);
      result += line.substr(after);
    }
    result += '\n';
  }
  return result;
}

Result<TrajectoryFile> read_text(const fs::path& file, const TrajectoryFileOptions& options) {
  const auto text = read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  const std::string name = file.string();
  if (const std::string_view foreign = foreign_content(*text); !foreign.empty()) {
    return failure(fmt::format("{}: {}", name, foreign));
  }
  TrajectoryFile result;
  result.file = file;
  const bool table = is_pose_table(*text);
  auto lines_text = table ? tum_of_pose_table(*text, name, options.stamp_decimals, result.notes)
                          : Result<std::string>(in_seconds(*text, options.stamp_decimals));
  if (!lines_text) return tl::unexpected(lines_text.error());
  lines_text = with_stamps(*lines_text, name, result.notes);
  note_missing_numbers(*lines_text, name, result.notes);
  LineReader lines(*lines_text, name);
  const auto first = lines.next();
  if (!first) {
    return failure(fmt::format("{}:1: expected poses as TUM or KITTI lines, found none", name));
  }
  const std::size_t columns = words_of(*first).size();
  Result<Trajectory> trajectory = Trajectory();
  if (columns == kPositionColumns) {
    result.kind = table ? "CSV of positions" : "positions";
    result.has_attitude = false;
    trajectory = parse_positions(*lines_text, name);
  } else if (columns == kTumColumns) {
    result.kind = table ? "CSV" : "TUM";
    trajectory = parse_tum(*lines_text, name, PoseRules::kAsGiven);
  } else if (columns == kKittiColumns) {
    result.kind = kKittiPoses;
    const auto poses = parse_kitti(*lines_text, name, PoseRules::kAsGiven);
    if (!poses) return tl::unexpected(poses.error());
    trajectory = stamped(*poses, name, options.stamps, result.notes);
  } else {
    return lines.error(
        fmt::format("expected 8 columns (TUM: stamp x y z qx qy qz qw), 12 (KITTI poses) or 4 "
                    "(positions: stamp x y z), found {}",
                    columns));
  }
  if (!trajectory) return tl::unexpected(trajectory.error());
  result.trajectory = std::move(*trajectory);
  if (options.rules == PoseRules::kStrict && result.has_attitude) {
    result.has_attitude = !is_of_positions(result.trajectory, name, result.notes);
  }
  normalize_rounded(result.trajectory, name, result.notes);
  if (options.rules == PoseRules::kStrict) {
    result.dropped = drop_unusable(result.trajectory, name, result.notes);
  }
  return result;
}

bool is_recording(const fs::path& file) {
  // A file with the name of a recording is read as one, so that a damaged one gets its reader's
  // error. A folder is one recording, of rosbag2 or of several files.
  std::error_code ignored;
  return fs::is_directory(file, ignored) || format_by_content(file) || format_by_name(file);
}

}  // namespace

Result<TrajectoryFile> read_trajectory(const std::string& source,
                                       const TrajectoryFileOptions& options) {
  const auto [file, topic] = split(source);
  if (is_recording(file)) return read_bag_trajectory(file, topic, options);
  if (!topic.empty()) {
    return failure(
        fmt::format("{}: a topic ({}) needs a bag, which this file is not", file.string(), topic));
  }
  return read_text(file, options);
}

}  // namespace aims
