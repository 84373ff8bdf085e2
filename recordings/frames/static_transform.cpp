// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/frames/static_transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "core/files/number_lines.hpp"

namespace aims {
namespace {

constexpr std::string_view kProgram = "static_transform_publisher";

Result<FixedTransform> transform_of(const std::string& parent, const std::string& child,
                                    std::span<const double> translation,
                                    const Result<Eigen::Quaterniond>& rotation,
                                    std::string_view place) {
  const auto t = translation_of(translation, place);
  if (!t) return tl::unexpected(t.error());
  if (!rotation) return tl::unexpected(rotation.error());
  return FixedTransform{parent, child, {*rotation, *t}};
}

/// "--x 1 --frame-id imu ...", in any order.
Result<FixedTransform> parse_options(const std::vector<std::string_view>& words,
                                     std::string_view place) {
  std::map<std::string_view, double> numbers;
  std::string parent, child;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    std::string_view key = words[i];
    if (!key.starts_with("--")) break;
    key.remove_prefix(2);
    if (key == "frame-id") {
      parent = words[i + 1];
    } else if (key == "child-frame-id") {
      child = words[i + 1];
    } else if (const auto number = parse_number(words[i + 1])) {
      numbers[key] = *number;
    } else {
      return failure(fmt::format("{}: expected a number after --{}", place, key));
    }
  }
  if (parent.empty() || child.empty()) {
    return failure(fmt::format("{}: expected --frame-id PARENT --child-frame-id CHILD", place));
  }
  const double xyz[] = {numbers["x"], numbers["y"], numbers["z"]};
  if (!numbers.contains("qw")) {
    return transform_of(parent, child, xyz,
                        rotation_of_rpy(numbers["roll"], numbers["pitch"], numbers["yaw"]), place);
  }
  const double q[] = {numbers["qx"], numbers["qy"], numbers["qz"], numbers["qw"]};
  return transform_of(parent, child, xyz, rotation_of_quaternion(q, place), place);
}

/// The value of an attribute of a tag; empty where it has none.
std::string attribute(std::string_view tag, std::string_view name) {
  std::size_t at = 0;
  while ((at = tag.find(name, at)) != std::string_view::npos) {
    const bool begins = at > 0 && (tag[at - 1] == ' ' || tag[at - 1] == '\n' ||
                                   tag[at - 1] == '\t' || tag[at - 1] == '\r');
    std::size_t open = tag.find_first_not_of(" \t\r\n", at + name.size());
    at += name.size();
    if (!begins || open == std::string_view::npos || tag[open] != '=') continue;
    open = tag.find_first_of("\"'", open);
    if (open == std::string_view::npos) return {};
    const std::size_t close = tag.find(tag[open], open + 1);
    if (close == std::string_view::npos) return {};
    return std::string(tag.substr(open + 1, close - open - 1));
  }
  return {};
}

std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string_view word : words_of(text)) {
    if (const auto number = parse_number(word)) numbers.push_back(*number);
  }
  return numbers;
}

/// Tags of an XML text, one after the other; comments are left out.
class Tags {
 public:
  explicit Tags(std::string_view text) : text_(text) {}

  /// The inside of the next tag, e.g. "origin xyz='0 0 1' /".
  std::optional<std::string_view> next() {
    while (true) {
      const std::size_t open = text_.find('<', at_);
      if (open == std::string_view::npos) return std::nullopt;
      const bool comment = text_.substr(open).starts_with("<!--");
      const std::size_t close = text_.find(comment ? "-->" : ">", open);
      if (close == std::string_view::npos) return std::nullopt;
      at_ = close + 1;
      line_ =
          1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(open), '\n');
      if (!comment) return text_.substr(open + 1, close - open - 1);
    }
  }

  std::ptrdiff_t line() const { return line_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  std::ptrdiff_t line_ = 0;
};

std::string_view name_of(std::string_view tag) {
  return tag.substr(0, tag.find_first_of(" \t\r\n/", 1));
}

}  // namespace

Result<FixedTransform> parse_static_transform(std::string_view arguments, std::string_view place) {
  std::vector<std::string_view> words = words_of(arguments);
  if (!words.empty() && words.front().find(kProgram) != std::string_view::npos) {
    words.erase(words.begin());
  }
  if (!words.empty() && words.front().starts_with("--")) return parse_options(words, place);
  std::vector<double> numbers;
  while (numbers.size() < words.size()) {
    const auto number = parse_number(words[numbers.size()]);
    if (!number) break;
    numbers.push_back(*number);
  }
  const std::size_t count = numbers.size();
  if ((count != 6 && count != 7) || words.size() < count + 2) {
    return failure(fmt::format(
        "{}: expected 'x y z yaw pitch roll PARENT CHILD' or 'x y z qx qy qz qw PARENT CHILD'",
        place));
  }
  const std::span<const double> all(numbers);
  const auto rotation = count == 7
                            ? rotation_of_quaternion(all.subspan(3), place)
                            : Result<Eigen::Quaterniond>(rotation_of_rpy(all[5], all[4], all[3]));
  return transform_of(std::string(words[count]), std::string(words[count + 1]), all.first(3),
                      rotation, place);
}

Result<std::vector<FixedTransform>> parse_static_transforms(std::string_view text,
                                                            const std::string& name) {
  std::vector<FixedTransform> transforms;
  const auto add = [&](std::string_view arguments, std::ptrdiff_t line) -> Result<void> {
    auto parsed = parse_static_transform(arguments, fmt::format("{}:{}", name, line));
    if (!parsed) return tl::unexpected(parsed.error());
    transforms.push_back(std::move(*parsed));
    return {};
  };
  if (text.find("<launch") != std::string_view::npos) {
    Tags tags(text);
    while (const auto tag = tags.next()) {
      if (tag->find(kProgram) == std::string_view::npos) continue;
      if (auto added = add(attribute(*tag, "args"), tags.line()); !added) {
        return tl::unexpected(added.error());
      }
    }
    return transforms;
  }
  LineReader lines(text, name);
  while (const auto line = lines.next()) {
    const std::size_t at = line->find(kProgram);
    if (at == std::string_view::npos) continue;
    if (auto added = add(line->substr(at), lines.number()); !added) {
      return tl::unexpected(added.error());
    }
  }
  return transforms;
}

Result<std::vector<FixedTransform>> parse_urdf(std::string_view text, const std::string& name) {
  std::vector<FixedTransform> transforms;
  std::optional<FixedTransform> joint;  // the fixed one that is open
  Tags tags(text);
  while (const auto tag = tags.next()) {
    const std::string_view kind = name_of(*tag);
    const std::string place = fmt::format("{}:{}", name, tags.line());
    if (kind == "joint" && attribute(*tag, "type") == "fixed") joint = FixedTransform();
    if (!joint) continue;
    if (kind == "parent") joint->parent = attribute(*tag, "link");
    if (kind == "child") joint->child = attribute(*tag, "link");
    if (kind == "origin") {
      std::vector<double> xyz = numbers_in(attribute(*tag, "xyz"));
      std::vector<double> rpy = numbers_in(attribute(*tag, "rpy"));
      if (xyz.empty()) xyz = {0.0, 0.0, 0.0};
      if (rpy.empty()) rpy = {0.0, 0.0, 0.0};
      if (rpy.size() != 3) return failure(place + ": expected rpy of three angles in rad");
      const auto t = translation_of(xyz, place);
      if (!t) return tl::unexpected(t.error());
      joint->T_parent_child = {rotation_of_rpy(rpy[0], rpy[1], rpy[2]), *t};
    }
    if (kind != "/joint") continue;
    if (joint->parent.empty() || joint->child.empty()) {
      return failure(place + ": expected a fixed joint with a parent and a child link");
    }
    transforms.push_back(*std::exchange(joint, std::nullopt));
  }
  return transforms;
}

}  // namespace aims
