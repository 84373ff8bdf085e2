// SPDX-License-Identifier: BSD-3-Clause
#include "core/file_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/text.hpp"

namespace aims {
namespace {

bool is_control_character(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

/// The start of the name.
std::string start_of(std::string_view name) {
  constexpr std::size_t kMostShown = 60;
  return name_text(name.substr(0, kMostShown)) + (name.size() > kMostShown ? "..." : "");
}

/// What makes the text no name; empty when nothing does.
std::string flaw_of(std::string_view name) {
  if (name.empty()) return "it is empty";
  if (name.size() > kMaxNameLength) {
    return fmt::format("it has {} bytes, more than {}", name.size(), kMaxNameLength);
  }
  if (name.find_first_of("/\\") != std::string_view::npos) return "it holds a separator";
  if (name.find("..") != std::string_view::npos) return "it holds '..'";
  if (std::ranges::any_of(name, is_control_character)) return "it holds a control character";
  if (name.front() == '.' || name.front() == '-') {
    return fmt::format("it begins with '{}'", name.front());
  }
  return "";
}

}  // namespace

Result<void> check_file_name(std::string_view key, std::string_view name) {
  const std::string flaw = flaw_of(name);
  if (flaw.empty()) return {};
  return failure(fmt::format("{}: expected a name that a file can have, got '{}': {}", key,
                             start_of(name), flaw));
}

}  // namespace aims
