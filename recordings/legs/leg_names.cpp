// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_names.hpp"

#include <algorithm>
#include <cctype>

#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxNameBytes = 200;

std::string lower(std::string_view text) { return lower_case(text.substr(0, kMaxNameBytes)); }

bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }
bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Whether a word begins at a letter within others: "flFoot", "FLFoot".
bool begins_word(std::string_view text, std::size_t i) {
  if (i == 0 || !is_upper(text[i])) return false;
  const bool before_lower = i + 1 < text.size() && is_lower(text[i + 1]);
  return is_lower(text[i - 1]) || (is_upper(text[i - 1]) && before_lower);
}

/// The words of a name, in lower case.
std::vector<std::string> words_of(std::string_view name) {
  const std::string_view text = name.substr(0, kMaxNameBytes);
  std::vector<std::string> result(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool letter = std::isalnum(static_cast<unsigned char>(text[i])) != 0;
    if ((!letter || begins_word(text, i)) && !result.back().empty()) result.emplace_back();
    if (letter) result.back() += lower(text.substr(i, 1));
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

constexpr std::array<std::string_view, kLegCount> kLegIds = {"FL", "FR", "RL", "RR"};
constexpr std::array<std::string_view, 3> kLimbs = {"leg", "foot", "limb"};
constexpr std::array<std::string_view, 7> kSides = {"front", "fore", "rear", "hind",
                                                    "back",  "left", "right"};

/// The leg that a word tells alone.
std::optional<int> leg_of_word(const std::string& word) {
  const std::vector<std::string> one = {word};
  if (has_any(one, {"fl", "lf", "frontleft", "leftfront"})) return 0;
  if (has_any(one, {"fr", "rf", "frontright", "rightfront"})) return 1;
  if (has_any(one, {"rl", "lr", "lh", "hl", "bl", "rearleft", "leftrear", "hindleft", "lefthind",
                    "backleft", "leftback"})) {
    return 2;
  }
  if (has_any(one, {"rr", "rh", "hr", "br", "rearright", "rightrear", "hindright", "righthind",
                    "backright", "rightback"})) {
    return 3;
  }
  return std::nullopt;
}

/// The number of "leg2"; nothing for other words.
std::string number_of_limb(const std::string& word) {
  for (const std::string_view limb : kLimbs) {
    if (word.size() == limb.size() + 1 && word.starts_with(limb) && is_digit(word.back())) {
      return word.substr(limb.size());
    }
  }
  return {};
}

/// The names between the slashes.
std::vector<std::string_view> parts_of(std::string_view name) {
  std::vector<std::string_view> parts;
  while (!name.empty()) {
    const std::size_t end = std::min(name.find('/'), name.size());
    if (end > 0) parts.push_back(name.substr(0, end));
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return parts;
}

/// The words of a part of a name that do not tell the leg; `number` is that of a limb.
std::string rest_of(std::string_view part, std::string& number) {
  std::string rest;
  std::string before;
  for (const std::string& word : words_of(part)) {
    const bool limb = std::ranges::find(kLimbs, before) != kLimbs.end();
    before = word;
    const bool side = std::ranges::find(kSides, word) != kSides.end();
    if (leg_of_word(word) || side || word.empty()) continue;
    const bool counts = limb && word.size() == 1 && is_digit(word[0]);
    const std::string counted = counts ? word : number_of_limb(word);
    if (!counted.empty()) number = counted;
    if (counts) continue;
    rest += (rest.empty() ? "" : "_") + (counted.empty() ? word : word.substr(0, word.size() - 1));
  }
  return rest;
}

}  // namespace

std::optional<int> leg_of_name(std::string_view name) {
  const std::vector<std::string> each = words_of(name);
  for (int leg = 0; leg < kLegCount; ++leg) {
    if (std::ranges::any_of(each, [leg](const auto& word) { return leg_of_word(word) == leg; })) {
      return leg;
    }
  }
  const bool front = has_any(each, {"front", "fore"});
  const bool rear = has_any(each, {"rear", "hind", "back"});
  const bool left = has_any(each, {"left"});
  const bool right = has_any(each, {"right"});
  if (front == rear || left == right) return std::nullopt;
  return (front ? 0 : 2) + (left ? 0 : 1);
}

std::optional<NamedLeg> named_leg(std::string_view name) {
  NamedLeg named;
  named.leg = leg_of_name(name);
  for (const std::string_view part : parts_of(name)) {
    const std::string rest = rest_of(part, named.id);
    if (!rest.empty()) named.rest += "/" + rest;
  }
  if (named.leg) named.id = kLegIds[static_cast<std::size_t>(*named.leg)];
  if (named.id.empty()) return std::nullopt;
  return named;
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
    order[i] = number_from<std::size_t>(listed[i]).value_or(size);
    if (order[i] >= size) return std::nullopt;
    const auto before = std::span(order).first(i);
    if (std::ranges::find(before, order[i]) != before.end()) return std::nullopt;
  }
  return order;
}

/// The joints of each leg in the order in which they are recorded.
JointOrder order_within_legs(std::span<const std::string_view> recorded) {
  JointOrder order{};
  std::array<std::size_t, kLegCount> found{};
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    const auto leg = static_cast<std::size_t>(*leg_of_name(recorded[i]));
    order[3 * leg + found[leg]++] = i;
  }
  return order;
}

}  // namespace

bool names_tell_legs_alone(std::span<const std::string_view> recorded) {
  if (recorded.size() != std::size_t{kJointCount}) return false;
  std::array<int, kLegCount> found{};
  for (const std::string_view name : recorded) {
    const auto leg = leg_of_name(name);
    if (!leg || joint_of_name(name)) return false;
    ++found[static_cast<std::size_t>(*leg)];
  }
  return std::ranges::all_of(found, [](int joints) { return joints == 3; });
}

std::optional<JointOrder> joint_order(std::span<const std::string_view> recorded,
                                      std::span<const std::string> configured, std::size_t size) {
  JointOrder order;
  std::array<bool, kJointCount> found{};
  // Where the abduction has its own name, the hip is the joint that pitches (MIT Cheetah).
  const bool abad = std::ranges::any_of(recorded, [](std::string_view name) {
    return holds_any(lower(name), {"abad", "abd"}) && !holds_any(lower(name), {"hip"});
  });
  if (recorded.empty() && !configured.empty()) return order_of_indices(configured, size);
  if (configured.empty() && recorded.size() == size && names_tell_legs_alone(recorded)) {
    return order_within_legs(recorded);
  }
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
