// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/pose_columns.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace aims {
namespace {

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, name) != names.end();
}

/// A name in lower case without its unit, and that unit.
struct Heading {
  std::string name, unit;
};

Heading heading_of(std::string_view cell) {
  Heading heading;
  const std::size_t bracket = std::min(cell.find_first_of("[("), cell.size());
  heading.name = cell.substr(0, bracket);
  if (bracket < cell.size()) {
    const std::string_view rest = cell.substr(bracket + 1);
    heading.unit = rest.substr(0, rest.find_first_of("])"));
  }
  const auto lower = [](unsigned char c) { return static_cast<char>(std::tolower(c)); };
  std::ranges::transform(heading.name, heading.name.begin(), lower);
  std::ranges::transform(heading.unit, heading.unit.begin(), lower);
  while (!heading.name.empty() && heading.name.back() == ' ') heading.name.pop_back();
  const std::size_t last = heading.name.rfind('_');
  if (heading.unit.empty() && last != std::string::npos && last > 0) {
    const std::string unit = heading.name.substr(last + 1);
    if (is_one_of(unit, {"ns", "us", "ms", "s", "sec", "nsec", "m", "cm", "mm", "deg", "rad"})) {
      heading.unit = unit;
      heading.name.resize(last);
    }
  }
  return heading;
}

std::string last_part(const std::string& name) { return name.substr(name.rfind('.') + 1); }

bool is_stamp(const Heading& heading) {
  const std::string name = last_part(heading.name);
  return name.ends_with("timestamp") ||
         is_one_of(name, {"t", "time", "timestamps", "stamp", "sec", "secs", "seconds"});
}

bool is_nanoseconds(const Heading& heading) {
  return is_one_of(last_part(heading.name),
                   {"nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds"});
}

StampUnit unit_of(const Heading& heading) {
  if (is_one_of(heading.unit, {"ns", "nsec"})) return StampUnit::kNanoseconds;
  if (heading.unit == "us") return StampUnit::kMicroseconds;
  if (heading.unit == "ms") return StampUnit::kMilliseconds;
  if (is_one_of(heading.unit, {"s", "sec"})) return StampUnit::kSeconds;
  return StampUnit::kByDigits;
}

/// Whether the name is of that component of a quaternion, or of a position.
bool is_component(const std::string& name, char component, bool of_quaternion) {
  const std::string part = last_part(name);
  if (part.empty() || part.back() != component) return false;
  const bool rotation = part.front() == 'q' || name.find("quat") != std::string::npos ||
                        name.find("orientation") != std::string::npos ||
                        name.find("rotation") != std::string::npos;
  if (rotation != of_quaternion) return false;
  const std::string before = part.substr(0, part.size() - 1);
  const bool apart = before.empty() || std::isalnum(static_cast<unsigned char>(before.back())) == 0;
  return apart || is_one_of(before, {"t", "p", "q", "pos", "quat"});
}

std::optional<std::size_t> column_of(const std::vector<Heading>& headings, char component,
                                     bool of_quaternion) {
  for (std::size_t i = 0; i < headings.size(); ++i) {
    if (is_component(headings[i].name, component, of_quaternion)) return i;
  }
  return std::nullopt;
}

/// `rostopic echo -p` has the record time in front of the stamp of the header.
std::optional<std::size_t> stamp_column(const std::vector<Heading>& headings) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < headings.size(); ++i) {
    if (headings[i].name.ends_with("header.stamp")) return i;
    if (!found && is_stamp(headings[i])) found = i;
  }
  return found;
}

/// With roll, pitch and yaw where the header names all three.
PoseColumns with_angles(const std::vector<Heading>& headings, PoseColumns columns) {
  constexpr std::array<std::string_view, 3> kNames = {"roll", "pitch", "yaw"};
  std::array<std::size_t, 3> angles{};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto found = std::ranges::find_if(
        headings, [&](const Heading& each) { return last_part(each.name) == kNames[i]; });
    if (found == headings.end()) return columns;
    angles[i] = static_cast<std::size_t>(found - headings.begin());
    columns.rpy_in_degrees = columns.rpy_in_degrees || is_one_of(found->unit, {"deg", "degrees"});
    columns.rpy_has_unit = columns.rpy_has_unit || !found->unit.empty();
  }
  columns.rpy = angles;
  return columns;
}

/// Puts in the columns of the position, each with the unit of its heading.
void set_position(const std::vector<Heading>& headings, std::size_t axis, std::size_t column,
                  PoseColumns& columns) {
  columns.position[axis] = column;
  const std::string& unit = headings[column].unit;
  columns.position_decimals = unit == "mm" ? 3 : unit == "cm" ? 2 : 0;
}

/// Whether a name, or what is behind its last underscore, is a direction.
std::optional<std::size_t> direction_column(const std::vector<Heading>& headings,
                                            std::initializer_list<std::string_view> names) {
  for (std::size_t i = 0; i < headings.size(); ++i) {
    const std::string part = last_part(headings[i].name);
    if (is_one_of(part, names) || is_one_of(part.substr(part.rfind('_') + 1), names)) return i;
  }
  return std::nullopt;
}

/// The columns of x, y and z, else of east, north, and up or down; false without.
bool find_position(const std::vector<Heading>& headings, PoseColumns& columns) {
  std::array<std::optional<std::size_t>, 3> found;
  for (std::size_t i = 0; i < 3; ++i) found[i] = column_of(headings, "xyz"[i], false);
  if (!found[0] || !found[1] || !found[2]) {
    found = {direction_column(headings, {"e", "east", "easting"}),
             direction_column(headings, {"n", "north", "northing"}),
             direction_column(headings, {"u", "up", "h", "height", "altitude", "elevation"})};
    const auto down = direction_column(headings, {"d", "down"});
    columns.is_down = !found[2] && down;
    if (columns.is_down) found[2] = down;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!found[i]) return false;
    set_position(headings, i, *found[i], columns);
  }
  return true;
}

}  // namespace

std::size_t PoseColumns::least() const {
  std::size_t last = std::max(stamp, nanoseconds.value_or(0));
  for (const std::size_t each : position) last = std::max(last, each);
  if (quaternion_xyzw) {
    for (const std::size_t each : *quaternion_xyzw) last = std::max(last, each);
  }
  if (rpy) {
    for (const std::size_t each : *rpy) last = std::max(last, each);
  }
  if (matrix) last = std::max(last, *matrix + 11);
  return last + 1;
}

std::optional<PoseColumns> named_columns(std::span<const std::string_view> header) {
  std::vector<Heading> headings;
  for (const std::string_view cell : header) headings.push_back(heading_of(cell));
  const auto stamp = stamp_column(headings);
  if (!stamp) return std::nullopt;
  PoseColumns columns;
  columns.stamp = *stamp;
  columns.unit = unit_of(headings[*stamp]);
  const auto nanoseconds = std::ranges::find_if(headings, is_nanoseconds);
  if (nanoseconds != headings.end()) {
    columns.nanoseconds = static_cast<std::size_t>(nanoseconds - headings.begin());
  }
  // Axes of attitudes beside a position that points down are of no one convention.
  if (!find_position(headings, columns)) return std::nullopt;
  if (columns.is_down) return columns;
  std::array<std::size_t, 4> quaternion{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto column = column_of(headings, "xyzw"[i], true);
    if (!column) return with_angles(headings, columns);
    quaternion[i] = *column;
  }
  columns.quaternion_xyzw = quaternion;
  return columns;
}

bool names_degrees(std::span<const std::string_view> header) {
  return std::ranges::any_of(header, [](std::string_view cell) {
    const std::string name = last_part(heading_of(cell).name);
    return is_one_of(name, {"lat", "latitude", "lon", "lng", "long", "longitude"});
  });
}

PoseColumns ordered_columns(std::size_t columns, bool w_first) {
  PoseColumns ordered;
  if (columns == 13 || columns == 17) ordered.matrix = 1;
  if (columns < 8 || ordered.matrix) return ordered;
  ordered.quaternion_xyzw =
      w_first ? std::array<std::size_t, 4>{5, 6, 7, 4} : std::array<std::size_t, 4>{4, 5, 6, 7};
  return ordered;
}

}  // namespace aims
