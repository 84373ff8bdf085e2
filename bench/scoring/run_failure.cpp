// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/run_failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>

#include "bench/metrics/success.hpp"
#include "bench/scoring/json_text.hpp"
#include "bench/scoring/validity.hpp"
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
  return json_array(failures, [](const RunFailure& each) {
    return Json{{"scenario", each.scenario},
                {"seed", each.seed ? Json(*each.seed) : Json()},
                {"estimator", each.estimator},
                {"message", each.message}};
  });
}

namespace {

struct Words {
  FailureReason reason;
  const char* text;
};

constexpr std::array kWords = {
    Words{FailureReason::kErrorLimit, "error beyond the limit of a success"},
    Words{FailureReason::kGap, "gap: no poses for too long"},
    Words{FailureReason::kStartsLate, "starts late: no poses near the start"},
    Words{FailureReason::kEndsEarly, "ends early: no poses near the end"},
    Words{FailureReason::kNoPoses, "no poses"},
    Words{FailureReason::kNoOverlap, "no poses in the time of the truth"},
    Words{FailureReason::kInvalid, "invalid pose"},
    Words{FailureReason::kCoverage, "too little of the time tracked"},
    Words{FailureReason::kInterrupted, "interrupted"}};

std::string words_of(const std::string& reason) {
  const auto found = std::ranges::find_if(
      kWords, [&](const Words& each) { return name_of(each.reason) == reason; });
  return found == kWords.end() ? reason : found->text;
}

/// What failed first, and whether poses are missing beside an error beyond the limit.
struct Reason {
  std::string first;
  bool and_partial = false;

  auto operator<=>(const Reason&) const = default;
};

/// Of the runs that failed by one reason.
struct Failed {
  std::size_t runs = 0;
  std::optional<double> first;  ///< earliest time, from the truth's start [s]
  std::optional<double> last;
};

/// "gap: no poses for too long, at 10.0 to 12.3 s"; a late start has no time of its own.
std::string reason_text(const Reason& reason, const Failed& failed) {
  std::string text = words_of(reason.first);
  const std::string also = reason.and_partial ? "; poses are missing, too" : "";
  if (!failed.first || reason.first == name_of(FailureReason::kStartsLate)) return text + also;
  text += fmt::format(", at {:.1f}", *failed.first);
  if (*failed.last - *failed.first >= 0.05) text += fmt::format(" to {:.1f}", *failed.last);
  return text + " s" + also;
}

/// The failures of an estimator by their reasons, but for errors and crashes, which are listed on
/// their own; `runs`: how many valid ones it has, with those.
std::map<Reason, Failed> failures_of(std::span<const RunRecord> records,
                                     const std::string& estimator, std::size_t& runs) {
  std::map<Reason, Failed> failures;
  for (const RunRecord& run : records) {
    const Json& scores = estimator_in(run, estimator);
    if (!is_valid_run(run) || (scores.is_null() && !failed_in(run, estimator))) continue;
    ++runs;
    if (scores.is_null()) continue;
    const std::string reason = value_in(scores, "diverged_reason", "");
    if (value_in(scores, "success", false) || reason.empty()) continue;
    const bool is_error = reason == name_of(FailureReason::kErrorLimit);
    Failed& failed = failures[{reason, is_error && is_partial(scores)}];
    ++failed.runs;
    const double start = value_in(value_in(run.scores, "truth", Json()), "start_s", 0.0);
    const auto at = number_at(scores, "diverged_at_s");
    if (!at) continue;
    failed.first = std::min(*at - start, failed.first.value_or(*at - start));
    failed.last = std::max(*at - start, failed.last.value_or(*at - start));
  }
  return failures;
}

}  // namespace

std::vector<std::string> failure_lines(std::span<const RunRecord> runs) {
  std::vector<std::string> lines;
  for (const std::string& name : estimators_in(runs)) {
    std::size_t valid = 0;
    for (const auto& [reason, failed] : failures_of(runs, name, valid)) {
      const bool is_error = reason.first == name_of(FailureReason::kErrorLimit);
      if (runs.size() == 1 && is_error && !reason.and_partial) continue;
      const std::string seeds =
          runs.size() > 1 ? fmt::format(" on {} of {} seeds", failed.runs, valid) : "";
      lines.push_back(fmt::format("{}{}: {}", name, seeds, reason_text(reason, failed)));
    }
  }
  return lines;
}

}  // namespace aims
