// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/segment_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/files/number_lines.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

std::optional<Segment> parse_timed(std::string_view entry) {
  const std::size_t equals = entry.find('=');
  const std::size_t colon = entry.find(':', equals);
  if (equals == 0 || colon == std::string_view::npos) return std::nullopt;
  const auto begin = parse_stamp(entry.substr(equals + 1, colon - equals - 1));
  const auto end = parse_stamp(entry.substr(colon + 1));
  if (!begin || !end || *begin >= *end) return std::nullopt;
  return Segment{std::string(entry.substr(0, equals)), *begin, *end};
}

Result<void> check_name(const SegmentList& list, const std::string& name) {
  const auto timed = std::find_if(list.timed.begin(), list.timed.end(),
                                  [&name](const Segment& each) { return each.name == name; });
  const auto named = std::find(list.named.begin(), list.named.end(), name);
  if (timed == list.timed.end() && named == list.named.end() && name != "all") return {};
  return failure(fmt::format("--segments: '{}': expected a name of its own", name));
}

Result<void> add(std::string_view entry, SegmentList& list) {
  const std::string name(entry.substr(0, entry.find('=')));
  if (auto checked = check_name(list, name); !checked) return checked;
  const bool has_time = name.size() < entry.size();
  const auto timed = has_time ? parse_timed(entry) : std::nullopt;
  if (timed) {
    list.timed.push_back(*timed);
  } else if (!has_time && name.find('-') != std::string::npos) {
    list.named.push_back(name);
  } else {
    return failure(
        fmt::format("--segments: '{}': expected NAME=START:END in seconds, or FROM-TO of two "
                    "reference points",
                    entry));
  }
  return {};
}

}  // namespace

Result<SegmentList> parse_segments(std::string_view text) {
  SegmentList list;
  while (!text.empty()) {
    auto added = add(take_until(text, ','), list);
    if (!added) return tl::unexpected(added.error());
  }
  return list;
}

Result<std::vector<Segment>> resolve_segments(const SegmentList& list,
                                              std::span<const WaypointTime> waypoint_times,
                                              const Trajectory& truth) {
  std::vector<Segment> segments = list.timed;
  for (const Segment& each : segments) {
    if (each.begin >= truth.front().stamp && each.end <= truth.back().stamp) continue;
    return failure(
        fmt::format("--segments: '{}': {} to {} s is not within the truth's stamps, {} "
                    "to {} s",
                    each.name, stamp_text(each.begin), stamp_text(each.end),
                    stamp_text(truth.front().stamp), stamp_text(truth.back().stamp)));
  }
  for (const std::string& name : list.named) {
    const std::vector<Segment> found = segments_named(waypoint_times, {&name, 1});
    if (found.empty()) {
      std::vector<std::string> points;
      for (const WaypointTime& each : waypoint_times) points.push_back(each.point);
      return failure(
          fmt::format("--segments: '{}': no way between two such waypoint_times; passed are: {}",
                      name, points.empty() ? "none" : fmt::format("{}", fmt::join(points, ", "))));
    }
    segments.insert(segments.end(), found.begin(), found.end());
  }
  std::stable_sort(segments.begin(), segments.end(),
                   [](const Segment& a, const Segment& b) { return a.begin < b.begin; });
  return segments;
}

}  // namespace aims
