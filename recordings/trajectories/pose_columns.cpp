// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/pose_columns.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include "core/text.hpp"

namespace aims {

bool MotiveHeader::take(const std::vector<std::string_view>& cells) {
  const auto has = [&](std::string_view word) { return std::ranges::count(cells, word) > 0; };
  const bool groups = has("Rotation") && has("Position");
  begun_ = begun_ || groups || (!cells.empty() && cells[0] == "Format Version");
  if (!begun_ || !names_.empty()) return false;
  if (has("Millimeters")) unit_ = "mm";
  if (has("Centimeters")) unit_ = "cm";
  if (groups) groups_.assign(cells.begin(), cells.end());
  if (groups_.empty() || cells.empty() || cells[0] != "Frame") return true;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::string name(cells[i]);
    const bool grouped = i < groups_.size() && !groups_[i].empty();
    if (grouped) name = groups_[i] + '.' + name;
    if (grouped && groups_[i] == "Position") name += " [" + unit_ + ']';
    names_.push_back(std::move(name));
  }
  return true;
}

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
  heading.name = lower_case(cell.substr(0, bracket));
  if (bracket < cell.size()) {
    const std::string_view rest = cell.substr(bracket + 1);
    heading.unit = lower_case(rest.substr(0, rest.find_first_of("])")));
  }
  std::ranges::replace(heading.name, '/', '.');  // as PlotJuggler writes fields
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

/// What is behind the last point, without underscores in front.
std::string last_part(const std::string& name) {
  const std::string part = name.substr(name.rfind('.') + 1);
  return part.substr(std::min(part.find_first_not_of('_'), part.size()));
}

enum class Quantity { kUnknown, kPose, kMotion };

Quantity quantity_of_word(std::string_view word) {
  if (is_one_of(word, {"vel", "acc", "v", "gyro", "omega", "linear", "angular", "twist"}) ||
      word.starts_with("veloc") || word.starts_with("accel")) {
    return Quantity::kMotion;
  }
  const bool pose = is_one_of(word, {"p", "pos", "position", "positions", "translation", "q",
                                     "quat", "quaternion", "orientation", "rotation"});
  return pose ? Quantity::kPose : Quantity::kUnknown;
}

/// What a column holds, by the last word of its name that tells, or its unit.
Quantity quantity_of(const Heading& heading) {
  if (heading.unit.find("/s") != std::string::npos) return Quantity::kMotion;
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  std::string_view name = heading.name;
  while (!name.empty()) {
    std::size_t begin = name.size();
    while (begin > 0 && is_letter(name[begin - 1])) --begin;
    const Quantity found = quantity_of_word(name.substr(begin));
    if (found != Quantity::kUnknown) return found;
    name = name.substr(0, begin > 0 ? begin - 1 : 0);
  }
  return Quantity::kUnknown;
}

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
  if (is_one_of(heading.unit, {"s", "sec", "seconds"})) return StampUnit::kSeconds;
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

/// The first column that a pose may have by `fits`, one that is named as of a pose in front of
/// others; never one of a motion.
template <typename Fits>
std::optional<std::size_t> pose_column(const std::vector<Heading>& headings, const Fits& fits) {
  for (const Quantity wanted : {Quantity::kPose, Quantity::kUnknown}) {
    for (std::size_t i = 0; i < headings.size(); ++i) {
      if (fits(headings[i].name) && quantity_of(headings[i]) == wanted) return i;
    }
  }
  return std::nullopt;
}

std::optional<std::size_t> column_of(const std::vector<Heading>& headings, char component,
                                     bool of_quaternion) {
  return pose_column(headings, [&](const std::string& name) {
    return is_component(name, component, of_quaternion);
  });
}

/// Whether the name is of a header's stamp, or its seconds.
bool is_header_stamp(const std::string& name) {
  const std::size_t found = name.rfind("header.stamp");
  if (found == std::string::npos) return false;
  return is_one_of(name.substr(found), {"header.stamp", "header.stamp.sec", "header.stamp.secs"});
}

/// `rostopic echo -p` and PlotJuggler have the record time in front of the stamp of the header.
std::optional<std::size_t> stamp_column(const std::vector<Heading>& headings) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < headings.size(); ++i) {
    if (is_header_stamp(headings[i].name)) return i;
    if (!found && is_stamp(headings[i])) found = i;
  }
  return found;
}

/// The column of nanoseconds beside that of seconds, if it is one.
std::optional<std::size_t> nanoseconds_column(const std::vector<Heading>& headings,
                                              std::size_t seconds) {
  const auto group = [](const std::string& name) { return name.substr(0, name.rfind('.') + 1); };
  const Heading& stamp = headings[seconds];
  if (!is_one_of(last_part(stamp.name), {"sec", "secs", "seconds"})) return std::nullopt;
  for (std::size_t i = 0; i < headings.size(); ++i) {
    if (is_nanoseconds(headings[i]) && group(headings[i].name) == group(stamp.name)) return i;
  }
  return std::nullopt;
}

/// With roll, pitch and yaw where the header names all three.
PoseColumns with_angles(const std::vector<Heading>& headings, PoseColumns columns) {
  constexpr std::array<std::string_view, 3> kNames = {"roll", "pitch", "yaw"};
  std::array<std::size_t, 3> angles{};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto found = std::ranges::find_if(headings, [&](const Heading& each) {
      return last_part(each.name) == kNames[i] && quantity_of(each) != Quantity::kMotion;
    });
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
  return pose_column(headings, [&](const std::string& name) {
    const std::string part = last_part(name);
    return is_one_of(part, names) || is_one_of(part.substr(part.rfind('_') + 1), names);
  });
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
  columns.nanoseconds = nanoseconds_column(headings, *stamp);
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

bool names_motion(std::span<const std::string_view> header) {
  constexpr std::size_t kStamp = 1, kPosition = 3;
  if (header.size() < kStamp + kPosition) return false;
  return std::ranges::all_of(header.subspan(kStamp, kPosition), [](std::string_view cell) {
    return quantity_of(heading_of(cell)) == Quantity::kMotion;
  });
}

PoseColumns with_y_up(PoseColumns columns) {
  std::swap(columns.position[1], columns.position[2]);
  if (columns.quaternion_xyzw)
    std::swap((*columns.quaternion_xyzw)[1], (*columns.quaternion_xyzw)[2]);
  columns.y_is_up = true;
  return columns;
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
