// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/run_failure.hpp"

#include <fmt/format.h>

#include "core/text.hpp"

namespace aims {
namespace {

std::string head_of(const RunFailure& failure) {
  std::string text = failure.scenario;
  if (failure.seed) text += fmt::format(" seed {}", *failure.seed);
  if (!failure.estimator.empty()) text += " " + failure.estimator;
  return text;
}

/// The text with what Markdown takes for markup as itself.
std::string markdown_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (std::string_view("\\`*[]<>|").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

}  // namespace

std::string text_of(const RunFailure& failure) { return head_of(failure) + ": " + failure.message; }

std::string markdown_item(const RunFailure& failure) {
  const std::size_t end = failure.message.find('\n');
  return fmt::format("- {}: {}\n", markdown_text(head_of(failure)),
                     markdown_text(line_text(failure.message.substr(0, end))));
}

std::vector<RunFailure> joined(std::span<const RunFailure> failures) {
  std::vector<RunFailure> result;
  for (const RunFailure& each : failures) {
    const bool same = !result.empty() && result.back().scenario == each.scenario &&
                      result.back().seed == each.seed && result.back().message == each.message;
    if (same) {
      result.back().estimator += ", " + each.estimator;
    } else {
      result.push_back(each);
    }
  }
  return result;
}

std::string markdown_list(std::span<const RunFailure> failures) {
  std::string text;
  for (const RunFailure& each : joined(failures)) text += markdown_item(each);
  return text;
}

Json failures_json(std::span<const RunFailure> failures) {
  Json list = Json::array();
  for (const RunFailure& each : failures) {
    list.push_back({{"scenario", each.scenario},
                    {"seed", each.seed ? Json(*each.seed) : Json()},
                    {"estimator", each.estimator},
                    {"message", each.message}});
  }
  return list;
}

}  // namespace aims
