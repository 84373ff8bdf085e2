// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/health_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/scoring/json_text.hpp"

namespace aims {
namespace {

constexpr std::size_t kMostReasons = 3;

/// The reasons that lasted longest.
std::string timed_text(const HealthSummary& summary) {
  std::vector<std::pair<double, std::string>> longest;
  for (const auto& [reason, seconds] : summary.reasons) longest.emplace_back(seconds, reason);
  std::ranges::sort(longest, std::greater<>());
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < std::min(kMostReasons, longest.size()); ++i) {
    texts.push_back(fmt::format("{} {:.1f} s", longest[i].second, longest[i].first));
  }
  if (longest.size() > texts.size()) texts.emplace_back("...");
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// The same after those of the recording, whose warnings say how long what they name lasts.
std::string reasons_text(const HealthSummary& summary) {
  const std::string timed = timed_text(summary);
  const auto& all = summary.of_recording;
  if (all.empty()) return timed;
  const auto most = std::min(kMostReasons, all.size());
  return fmt::format("{}{}{}{}",
                     fmt::join(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(most), ", "),
                     all.size() > most ? ", ..." : "", timed.empty() ? "" : "; ", timed);
}

constexpr const char* kNotJudged = "not judged";

}  // namespace

Json health_json(const HealthSummary& summary) {
  return {{"worst", summary.judged ? std::string(name_of(summary.worst)) : kNotJudged},
          {"healthy_s", summary.healthy_s},
          {"degraded_s", summary.degraded_s},
          {"invalid_s", summary.invalid_s},
          {"reasons", reasons_text(summary)},
          {"text", text_of(summary)}};
}

std::string text_of(const HealthSummary& summary) {
  if (!summary.too_short.empty()) return summary.too_short;
  if (!summary.judged || summary.worst == HealthState::kHealthy) return {};
  if (summary.worst == HealthState::kStarting) return "never started";
  std::vector<std::string> states;
  if (summary.invalid_s > 0.0 || summary.worst == HealthState::kInvalid) {
    states.push_back(fmt::format("invalid for {:.1f} s", summary.invalid_s));
  }
  if (summary.degraded_s > 0.0 || summary.worst == HealthState::kDegraded) {
    states.push_back(fmt::format("degraded for {:.1f} s", summary.degraded_s));
  }
  const std::string reasons = reasons_text(summary);
  return fmt::format("{}{}", fmt::join(states, ", "), reasons.empty() ? "" : " (" + reasons + ")");
}

std::vector<std::string> health_lines(const RunRecord& run) {
  std::vector<std::string> lines;
  const auto estimators = run.scores.find("estimators");
  if (estimators == run.scores.end()) return lines;
  for (const auto& [name, scores] : estimators->items()) {
    const auto health = scores.find("health");
    if (health == scores.end()) continue;
    const std::string worst = value_in(*health, "worst", "");
    if (worst == kNotJudged) continue;
    std::vector<std::string> parts;
    if (worst != name_of(HealthState::kHealthy)) parts.push_back(value_in(*health, "text", worst));
    const double unnoticed = value_in(*health, "healthy_while_wrong_s", 0.0);
    if (unnoticed >= kLeastUnnoticed) {
      parts.push_back(fmt::format("healthy for {:.1f} s while wrong", unnoticed));
    }
    if (parts.empty()) continue;
    lines.push_back(fmt::format("{} seed {}: {}", name, run.seed, fmt::join(parts, "; ")));
  }
  return lines;
}

CsvTable health_table(std::span<const HealthRow> rows) {
  CsvTable table({"stamp_s", "state", "reasons", "position_sigma_m"});
  add_health_rows(rows, table);
  return table;
}

void add_health_rows(std::span<const HealthRow> rows, CsvTable& table) {
  for (const HealthRow& row : rows) {
    table.add(to_seconds(row.stamp)).add(name_of(row.state));
    table.add(fmt::format("{}", fmt::join(row.reasons, "; "))).add(row.position_sigma);
    table.end_row();
  }
}

}  // namespace aims
