// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/frames/calibration_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "core/files/number_lines.hpp"
#include "core/files/text_file.hpp"
#include "core/files/yaml_scalars.hpp"
#include "core/text.hpp"
#include "recordings/frames/frame_tree.hpp"
#include "recordings/frames/static_transform.hpp"

namespace aims {
namespace {

constexpr std::size_t kLargest = std::size_t{1} << 24;  ///< of a calibration [bytes]

/// Ending of keys whose seven numbers are a vector and a quaternion (Oxford Spires).
constexpr std::string_view kVectorAndQuaternion = "_t_xyz_q_xyzw";

bool is_index(std::string_view word) {
  return !word.empty() && word.size() <= 4 &&
         word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Lists of numbers by their place, in order: of "a.T_x_y.0.1" the place is "a.T_x_y".
using Lists = std::map<std::string, std::map<std::pair<int, int>, double>>;

Lists lists_of(const std::map<std::string, std::string>& scalars) {
  Lists lists;
  for (const auto& [place, text] : scalars) {
    const auto number = parse_number(text);
    if (!number) continue;
    std::string head = place;
    std::vector<int> indices;
    while (indices.size() < 2) {
      const std::size_t dot = head.rfind('.');
      const std::string_view last = std::string_view(head).substr(dot + 1);
      if (dot == std::string::npos || !is_index(last)) break;
      indices.insert(indices.begin(), std::stoi(std::string(last)));
      head.resize(dot);
    }
    if (indices.empty()) continue;
    if (head.ends_with(".data")) head.resize(head.size() - 5);
    const std::pair<int, int> at{indices[0], indices.size() > 1 ? indices[1] : 0};
    lists[head][at] = *number;
  }
  return lists;
}

std::vector<double> values(const std::map<std::pair<int, int>, double>& list) {
  std::vector<double> numbers;
  for (const auto& [at, number] : list) numbers.push_back(number);
  return numbers;
}

/// The parent and the child of a key, and the unit of its translation.
struct Named {
  std::string parent, child;
  double metres = 1.0;
};

std::optional<Named> split_at(std::string_view key, std::string_view word, bool child_first) {
  const std::size_t at = key.find(word);
  if (at == std::string_view::npos || at == 0 || at + word.size() >= key.size()) {
    return std::nullopt;
  }
  std::string before(key.substr(0, at)), after(key.substr(at + word.size()));
  if (child_first) std::swap(before, after);
  return Named{std::move(before), std::move(after)};
}

/// What the last two parts of a place say of the frames.
std::optional<Named> frames_of(const std::string& place) {
  const std::size_t dot = place.rfind('.');
  std::string group = dot == std::string::npos ? "" : place.substr(0, dot);
  group = group.substr(group.rfind('.') + 1);
  std::string key = place.substr(dot == std::string::npos ? 0 : dot + 1);
  if (key == "T_cn_cnm1" && group.starts_with("cam") && is_index(group.substr(3))) {
    return Named{group, fmt::format("cam{}", std::stoi(group.substr(3)) - 1)};
  }
  if (key.ends_with("_transform")) {
    auto named = split_at(key.substr(0, key.size() - 10), "_to_", true);
    const bool ouster = named && named->parent == "sensor";
    if (ouster) named->metres = 1e-3;
    return named;
  }
  if (auto named = split_at(key, "_in_", true)) return named;
  if (auto named = split_at(key, "_T_", false)) return named;
  if (!key.starts_with("T_") && !key.starts_with("t_")) return std::nullopt;
  if (key.ends_with(kVectorAndQuaternion)) key.resize(key.size() - kVectorAndQuaternion.size());
  auto named = split_at(key.substr(2), "_", false);
  if (named && named->parent == "here") named->parent = group;  // MultiCal
  if (named && named->parent == "cam" && group.starts_with("cam")) named->parent = group;
  if (named && named->parent == "cam" && is_index(group)) named->parent += group;  // of a list
  return named;
}

std::string place_in(const std::string& text, const std::string& name, const std::string& key) {
  const std::string last = key.substr(key.rfind('.') + 1);
  const std::size_t at = text.find(last);
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size()));
  const std::string shown = key.size() < 200 ? key : key.substr(0, 200) + "...";
  return fmt::format("{}:{}: {}", name, 1 + std::count(text.begin(), end, '\n'), shown);
}

/// A map "A_in_B: {translation: [..], quaternion_xyzw: [..]}" below `group`.
Result<Pose> pose_in_group(const Lists& lists, const std::string& group, const std::string& place) {
  const auto find = [&](const char* key) {
    const auto found = lists.find(group + "." + key);
    return found == lists.end() ? std::vector<double>() : values(found->second);
  };
  std::vector<double> t = find("translation");
  if (t.empty()) t = {0.0, 0.0, 0.0};
  const auto translation = translation_of(t, place);
  if (!translation) return tl::unexpected(translation.error());
  Result<Eigen::Quaterniond> rotation = Eigen::Quaterniond::Identity();
  if (const auto q = find("quaternion_xyzw"); !q.empty())
    rotation = rotation_of_quaternion(q, place);
  if (const auto R = find("rotation_matrix"); !R.empty()) rotation = rotation_of_matrix(R, place);
  if (const auto a = find("rotation_rpy_deg"); a.size() == 3) {
    constexpr double kRad = std::numbers::pi / 180.0;
    rotation = rotation_of_rpy(kRad * a[0], kRad * a[1], kRad * a[2]);
  }
  if (!rotation) return tl::unexpected(rotation.error());
  return Pose{*rotation, *translation};
}

Result<Pose> pose_of_seven(const std::vector<double>& numbers, const std::string& place) {
  if (numbers.size() != 7) {
    return failure(
        fmt::format("{}: expected 7 numbers: x y z qx qy qz qw, found {}", place, numbers.size()));
  }
  const auto translation = translation_of(std::span(numbers).first(3), place);
  if (!translation) return tl::unexpected(translation.error());
  const auto rotation = rotation_of_quaternion(std::span(numbers).subspan(3), place);
  if (!rotation) return tl::unexpected(rotation.error());
  return Pose{*rotation, *translation};
}

/// FAST-LIO's pair of lists: the LiDAR in the IMU.
Result<std::optional<Pose>> fast_lio_pair(const Lists& lists, const std::string& place,
                                          const std::string& where) {
  if (!place.ends_with("extrinsic_T")) return std::optional<Pose>();
  const auto R = lists.find(place.substr(0, place.size() - 1) + "R");
  if (R == lists.end()) return std::optional<Pose>();
  const auto rotation = rotation_of_matrix(values(R->second), where);
  if (!rotation) return tl::unexpected(rotation.error());
  const auto translation = translation_of(values(lists.at(place)), where);
  if (!translation) return tl::unexpected(translation.error());
  return Pose{*rotation, *translation};
}

Result<std::vector<FixedTransform>> parse_yaml(const std::string& text, const std::string& name) {
  const auto scalars = yaml_scalars(text, name);
  if (!scalars) return tl::unexpected(scalars.error());
  const Lists lists = lists_of(*scalars);
  std::vector<FixedTransform> transforms;
  std::set<std::string> groups;
  for (const auto& [place, list] : lists) {
    const std::string where = place_in(text, name, place);
    const auto pair = fast_lio_pair(lists, place, where);
    if (!pair) return tl::unexpected(pair.error());
    if (*pair) transforms.push_back({"imu", "lidar", **pair});
    const std::size_t dot = place.rfind('.');
    const std::string group = dot == std::string::npos ? "" : place.substr(0, dot);
    if (const auto in = frames_of(group); in && group.find("_in_") != std::string::npos) {
      if (!groups.insert(group).second) continue;
      const auto pose = pose_in_group(lists, group, place_in(text, name, group));
      if (!pose) return tl::unexpected(pose.error());
      transforms.push_back({in->parent, in->child, *pose});
      continue;
    }
    const auto named = frames_of(place);
    const bool seven = place.ends_with(kVectorAndQuaternion);
    if (!named || (list.size() < 12 && !seven)) continue;
    const auto pose = seven ? pose_of_seven(values(list), where)
                            : pose_of_matrix(values(list), where, named->metres);
    if (!pose) return tl::unexpected(pose.error());
    transforms.push_back({named->parent, named->child, *pose});
  }
  return transforms;
}

constexpr std::array<std::string_view, 2> kImuWords = {"imu", "body"};
constexpr std::array<std::string_view, 8> kLidarWords = {
    "lidar", "velodyne", "ouster", "hesai", "pandar", "livox", "laser", "os_sensor"};

/// The frame of that name, or of the first word that one frame alone contains.
Result<std::string> frame_named(const std::set<std::string>& frames, const std::string& given,
                                std::span<const std::string_view> words, std::string_view role,
                                const std::string& name) {
  if (!given.empty() && frames.contains(given)) return given;
  for (const std::string_view word : words) {
    std::vector<std::string> found;
    for (const std::string& frame : frames) {
      if (lower_case(frame) == word) return frame;
      if (lower_case(frame).find(word) != std::string::npos) found.push_back(frame);
    }
    if (given.empty() && found.size() == 1) return found.front();
    if (given.empty() && found.size() > 1) break;
  }
  return failure(
      fmt::format("{}: expected one frame as the {}{}; there are {}: name them in "
                  "file_frames",
                  name, role, given.empty() ? "" : fmt::format(", '{}'", given),
                  frames.empty() ? "none" : fmt::format("{}", fmt::join(frames, ", "))));
}

}  // namespace

Result<std::vector<FixedTransform>> parse_calibration(const std::string& text,
                                                      const std::string& name) {
  if (text.find("<robot") != std::string::npos) return parse_urdf(text, name);
  if (text.find("static_transform_publisher") != std::string::npos) {
    return parse_static_transforms(text, name);
  }
  // OpenCV writes a directive that is no YAML.
  if (!text.starts_with("%YAML:")) return parse_yaml(text, name);
  return parse_yaml("#" + text, name);
}

Result<Pose> read_extrinsic(const std::filesystem::path& file, const std::string& parent,
                            const std::string& child) {
  const auto text = read_text_file(file, kLargest);
  if (!text) return tl::unexpected(text.error());
  const std::string name = file.string();
  const auto transforms = parse_calibration(*text, name);
  if (!transforms) return tl::unexpected(transforms.error());
  FrameTree tree;
  std::set<std::string> frames;
  for (const FixedTransform& each : *transforms) {
    tree.add(each.parent, each.child, each.T_parent_child);
    frames.insert({each.parent, each.child});
  }
  const auto from = frame_named(frames, parent, kImuWords, "IMU", name);
  if (!from) return tl::unexpected(from.error());
  const auto to = frame_named(frames, child, kLidarWords, "LiDAR", name);
  if (!to) return tl::unexpected(to.error());
  const auto pose = tree.transform(*from, *to);
  if (pose) return *pose;
  return failure(fmt::format("{}: no transform connects '{}' and '{}'", name, *from, *to));
}

}  // namespace aims
