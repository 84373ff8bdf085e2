// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_size.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace aims {
namespace {

constexpr int kDeepest = 100;
/// A shorter text costs the parser little, however deep it nests.
constexpr std::size_t kHarmless = std::size_t{128} << 10;

/// Follows how deep a text nests. Brackets in quoted text count too, which no long configuration
/// has by the hundred.
class Nesting {
 public:
  /// False when this character takes it too deep.
  bool add(char c) {
    if (c == '\n') ++line_;
    if (c == '[' || c == '{') ++brackets_;
    if (c == ']' || c == '}') brackets_ = std::max(0, brackets_ - 1);
    const bool blank = c == ' ' || c == '\t';
    const bool mark = c == '-' || c == '?';
    if (blank && last_was_mark_) ++marks_;
    if (!blank && !mark) marks_ = 0;
    last_was_mark_ = mark;
    return brackets_ <= kDeepest && marks_ <= kDeepest;
  }
  int line() const { return line_; }

 private:
  int line_ = 1;
  int brackets_ = 0;  ///< open ones
  int marks_ = 0;     ///< "- - - ": a list in a list in a list
  bool last_was_mark_ = false;
};

}  // namespace

Result<void> check_yaml_size(std::string_view text, const std::string& name) {
  if (text.size() > kLargestYaml) {
    return failure(
        fmt::format("{}: expected at most {} bytes, found {}", name, kLargestYaml, text.size()));
  }
  if (text.size() <= kHarmless) return {};
  Nesting nesting;
  for (const char c : text) {
    if (!nesting.add(c)) {
      return failure(
          fmt::format("{}:{}: expected no deeper nesting than {}", name, nesting.line(), kDeepest));
    }
  }
  return {};
}

}  // namespace aims
