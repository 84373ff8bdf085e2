// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/waypoint_times.hpp"

#include <fmt/format.h>

#include <optional>

#include "core/files/number_lines.hpp"
#include "core/files/text_file.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::string_view kHeader = "point,stamp_s";

std::string_view without_return(std::string_view line) {
  return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

/// Removes the quoted name from the front of `rest`; nothing when its quote never closes.
std::optional<std::string> take_quoted(std::string_view& rest) {
  std::string name;
  for (std::size_t i = 1; i < rest.size(); ++i) {
    if (rest[i] == '"' && (i + 1 >= rest.size() || rest[i + 1] != '"')) {
      rest = rest.substr(i + 1);
      return name;
    }
    if (rest[i] == '"') ++i;
    name += rest[i];
  }
  return std::nullopt;
}

std::optional<std::string> take_name(std::string_view& rest) {
  if (rest.starts_with('"')) return take_quoted(rest);
  std::string name(rest.substr(0, rest.find(',')));
  rest.remove_prefix(name.size());
  return name;
}

std::optional<WaypointTime> parse_row(std::string_view line) {
  std::string_view rest = without_return(line);
  auto name = take_name(rest);
  if (!name || name->empty() || !rest.starts_with(',')) return std::nullopt;
  const auto stamp = parse_stamp(rest.substr(1));
  if (!stamp) return std::nullopt;
  return WaypointTime{std::move(*name), *stamp};
}

}  // namespace

Result<std::vector<WaypointTime>> parse_waypoint_times(std::string_view text,
                                                       const std::string& name) {
  std::vector<WaypointTime> waypoint_times;
  LineReader lines(text, name);
  const auto header = lines.next();
  if (!header) return failure(fmt::format("{}:1: expected the header '{}'", name, kHeader));
  if (without_return(*header) != kHeader) {
    return lines.error(fmt::format("expected the header '{}', found '{}'", kHeader, *header));
  }
  while (const auto line = lines.next_record()) {
    auto waypoint_time = parse_row(*line);
    if (!waypoint_time) {
      return lines.error(
          fmt::format("expected a point and its stamp in seconds, as a,12.5; found '{}'", *line));
    }
    if (!waypoint_times.empty() && waypoint_time->stamp < waypoint_times.back().stamp) {
      return lines.error(fmt::format("expected a stamp not before {}, found {}",
                                     stamp_text(waypoint_times.back().stamp),
                                     stamp_text(waypoint_time->stamp)));
    }
    waypoint_times.push_back(std::move(*waypoint_time));
  }
  return waypoint_times;
}

Result<std::vector<WaypointTime>> read_waypoint_times(const std::filesystem::path& file) {
  const auto text = read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse_waypoint_times(*text, file.string());
}

}  // namespace aims
