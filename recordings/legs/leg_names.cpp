// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_names.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace aims {
namespace {

constexpr std::size_t kMaxNameBytes = 200;

std::string lower(std::string_view text) {
  std::string result(text.substr(0, kMaxNameBytes));
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> result(1);
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c))) {
      result.back() += c;
    } else if (!result.back().empty()) {
      result.emplace_back();
    }
  }
  return result;
}

bool has_any(const std::vector<std::string>& each, std::initializer_list<std::string_view> wanted) {
  return std::any_of(each.begin(), each.end(), [&](const std::string& word) {
    return std::find(wanted.begin(), wanted.end(), word) != wanted.end();
  });
}

bool holds_any(const std::string& text, std::initializer_list<std::string_view> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](std::string_view part) { return text.find(part) != std::string::npos; });
}

bool is_foot(std::string_view name) { return holds_any(lower(name), {"foot", "toe", "contact"}); }

}  // namespace

std::optional<int> leg_of_name(std::string_view name) {
  const std::vector<std::string> each = words(lower(name));
  if (has_any(each, {"fl", "lf", "frontleft", "leftfront"})) return 0;
  if (has_any(each, {"fr", "rf", "frontright", "rightfront"})) return 1;
  if (has_any(each, {"rl", "lr", "lh", "hl", "bl", "rearleft", "leftrear", "hindleft", "lefthind",
                     "backleft", "leftback"})) {
    return 2;
  }
  if (has_any(each, {"rr", "rh", "hr", "br", "rearright", "rightrear", "hindright", "righthind",
                     "backright", "rightback"})) {
    return 3;
  }
  const bool front = has_any(each, {"front", "fore"});
  const bool rear = has_any(each, {"rear", "hind", "back"});
  const bool left = has_any(each, {"left"});
  const bool right = has_any(each, {"right"});
  if (front == rear || left == right) return std::nullopt;
  return (front ? 0 : 2) + (left ? 0 : 1);
}

std::optional<int> joint_of_name(std::string_view name, bool abad) {
  const std::string text = lower(name);
  if (holds_any(text, {"kfe", "calf", "knee", "kn", "shank", "lower", "tibia", "elbow"})) return 2;
  if (holds_any(text, {"hfe", "thigh", "hip_y", "hipy", "hip_pitch", "hippitch", "hip_fe",
                       "hip_flex", "hy", "upper", "femur", "shoulder rotation"})) {
    return 1;
  }
  if (abad && holds_any(text, {"hip"}) && !holds_any(text, {"abad", "abd"})) return 1;
  if (holds_any(text, {"haa", "hip", "hx", "abd", "abad", "shoulder", "coxa"})) return 0;
  return std::nullopt;
}

namespace {

/// The entries of an array without names, of which twelve different ones are listed.
std::optional<JointOrder> order_of_indices(std::span<const std::string> listed, std::size_t size) {
  JointOrder order{};
  if (listed.size() != order.size()) return std::nullopt;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const char* const end = listed[i].data() + listed[i].size();
    const auto [read, error] = std::from_chars(listed[i].data(), end, order[i]);
    if (error != std::errc() || read != end || order[i] >= size) return std::nullopt;
    const auto before = std::span(order).first(i);
    if (std::ranges::find(before, order[i]) != before.end()) return std::nullopt;
  }
  return order;
}

}  // namespace

std::optional<JointOrder> joint_order(std::span<const std::string_view> recorded,
                                      std::span<const std::string> configured, std::size_t size) {
  JointOrder order;
  std::array<bool, kJointCount> found{};
  // Where the abduction has its own name, the hip is the joint that pitches (MIT Cheetah).
  const bool abad = std::ranges::any_of(recorded, [](std::string_view name) {
    return holds_any(lower(name), {"abad", "abd"}) && !holds_any(lower(name), {"hip"});
  });
  if (recorded.empty() && !configured.empty()) return order_of_indices(configured, size);
  const std::size_t named = std::min(recorded.size(), size);
  for (std::size_t i = 0; i < named; ++i) {
    std::optional<std::size_t> joint;
    if (!configured.empty()) {
      const auto at = std::find(configured.begin(), configured.end(), recorded[i]);
      if (at != configured.end()) joint = static_cast<std::size_t>(at - configured.begin());
    } else if (!is_foot(recorded[i])) {
      const auto leg = leg_of_name(recorded[i]);
      const auto part = joint_of_name(recorded[i], abad);
      if (leg && part) joint = static_cast<std::size_t>(3 * *leg + *part);
    }
    if (!joint || *joint >= order.size() || found[*joint]) continue;
    order[*joint] = i;
    found[*joint] = true;
  }
  if (std::all_of(found.begin(), found.end(), [](bool each) { return each; })) return order;
  return std::nullopt;
}

bool joints_are_unnamed(std::span<const std::string_view> recorded, std::size_t size) {
  if (size != std::size_t{kJointCount}) return false;
  return std::ranges::none_of(
      recorded, [](std::string_view name) { return leg_of_name(name) && joint_of_name(name); });
}

std::optional<std::vector<int>> named_foot_order(std::span<const std::string_view> recorded,
                                                 std::span<const std::string> configured,
                                                 std::size_t size) {
  if (size > kMaxNameBytes) return std::nullopt;
  std::vector<int> order(size, -1);
  std::array<bool, kLegCount> found{};
  const auto take = [&](std::size_t entry, std::optional<int> leg) {
    if (!leg || found[static_cast<std::size_t>(*leg)]) return;
    order[entry] = *leg;
    found[static_cast<std::size_t>(*leg)] = true;
  };
  // In an array of joints, the foot's entry has the foot's name or is the knee, which carries its
  // load.
  const bool among_joints = size >= static_cast<std::size_t>(kJointCount);
  const bool has_feet = std::any_of(recorded.begin(), recorded.end(), is_foot);
  for (std::size_t i = 0; i < size; ++i) {
    if (i < configured.size()) {
      take(i, leg_of_name(configured[i]));
    } else if (configured.empty() && i < recorded.size()) {
      const bool wanted =
          !among_joints || (has_feet ? is_foot(recorded[i]) : joint_of_name(recorded[i]) == 2);
      if (wanted) take(i, leg_of_name(recorded[i]));
    }
  }
  if (std::all_of(found.begin(), found.end(), [](bool each) { return each; })) return order;
  return std::nullopt;
}

std::optional<std::vector<int>> foot_order(std::span<const std::string_view> recorded,
                                           std::span<const std::string> configured,
                                           std::size_t size) {
  if (auto order = named_foot_order(recorded, configured, size)) return order;
  if (!configured.empty() || size != static_cast<std::size_t>(kLegCount)) return std::nullopt;
  return std::vector<int>{0, 1, 2, 3};
}

}  // namespace aims
