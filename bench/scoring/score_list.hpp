// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "bench/metrics/scores.hpp"
#include "bench/scoring/json_text.hpp"

namespace aims {

enum class Better { kSmaller, kLarger, kNeither };

/// "smaller", "larger", "neither".
constexpr std::string_view name_of(Better better) {
  constexpr std::string_view kNames[] = {"smaller", "larger", "neither"};
  return kNames[static_cast<int>(better)];
}

/// One score of an estimate: the only place that knows its key, how it is shown and its value.
struct Score {
  /// Of scores.json, scores.csv, `expect:` and objectives. A score of several numbers is an object
  /// there, whose numbers have keys below this one: "m_list_percent.a-b". "*" is any part.
  const char* key;
  std::string_view title;  ///< of columns; empty: never one
  std::string_view unit;
  int digits = 3;  ///< behind the point
  Better better = Better::kSmaller;
  double floor = 0.0;  ///< of a headline score: a change below this [unit] is of no interest
  /// Its number, text or object; null when undefined. None for what scores of a trajectory lack:
  /// what depends on the run.
  Json (*value)(const Scores& scores) = nullptr;
  bool (*present)(const Scores& scores) = nullptr;  ///< whether it has the key; none: always
};

/// All scores, in the order of scores.json.
std::span<const Score> score_list();

/// Of the keys of a re-optimized trajectory's scores.
inline constexpr const char* kOptimizedPrefix = "optimized.";

/// The score of that key, or of the closest one above it; `key` is dotted and one of the list.
const Score& score_at(std::string_view key);

/// Which is better of the score of that key; of one that the list lacks, less.
Better better_of(std::string_view key);

/// The unit of the score of that key; empty for one without, and for one that the list lacks.
std::string_view unit_of(std::string_view key);

/// "ATE yaw [m]".
std::string title_with_unit(const Score& score);

/// What many runs are summed up by: the headline, ATE after alignment by heading and translation;
/// the ATE aligned at the start; the heading error; M_list over all segments; M_end; the largest
/// height error. Keys are those of numbers ("m_list_percent.all").
inline constexpr std::size_t kHeadlineCount = 6;
const std::array<Score, kHeadlineCount>& headline_scores();

/// Limits of the position error within which an estimate stayed.
inline constexpr std::size_t kSuccessCount = 2;
const std::array<Score, kSuccessCount>& success_scores();

/// True for scores that depend on the machine and the moment.
bool is_timing(std::string_view score_key);

/// What scores.json holds of any estimate: the values of the list.
Json scores_json(const Scores& scores);

/// The number, or null for none and for what is not finite.
Json json_of(const std::optional<double>& value);

/// That of a member of a part that may be missing.
template <class Part, class Member>
Json json_of(const std::optional<Part>& part, Member Part::*member) {
  return part ? json_of(std::optional<double>((*part).*member)) : Json();
}

}  // namespace aims
