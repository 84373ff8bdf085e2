// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/pose_table.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/files/iso_time.hpp"
#include "core/files/number_lines.hpp"
#include "core/text.hpp"
#include "recordings/trajectories/angle_unit.hpp"
#include "recordings/trajectories/pose_columns.hpp"
#include "recordings/trajectories/table_cells.hpp"

namespace aims {
namespace {

constexpr std::size_t kColumns = 8;
constexpr std::size_t kPositionColumns = 4;

/// A number, or a date and time.
bool is_stamp(std::string_view word) {
  return is_number_with_comma(word) || parse_iso_time(word).has_value();
}

bool is_digits(std::string_view word) {
  return !word.empty() &&
         std::ranges::all_of(word, [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// By the digits in front of the point, also where those are written as 1.7e18.
StampUnit unit_by_digits(std::string_view stamp) {
  std::string whole(stamp.substr(0, stamp.find('.')));
  if (!is_digits(stamp)) {
    const auto value = parse_number(stamp, false);
    if (value && std::isfinite(*value)) whole = fmt::format("{:.0f}", std::trunc(*value));
  }
  if (!is_digits(whole)) return StampUnit::kSeconds;
  if (whole.size() >= 17) return StampUnit::kNanoseconds;
  if (whole.size() == 16) return StampUnit::kMicroseconds;
  return whole.size() == 13 ? StampUnit::kMilliseconds : StampUnit::kSeconds;
}

int decimals_of(StampUnit unit) {
  switch (unit) {
    case StampUnit::kNanoseconds:
      return 9;
    case StampUnit::kMicroseconds:
      return 6;
    case StampUnit::kMilliseconds:
      return 3;
    default:
      return 0;
  }
}

/// How the rows of a table are read.
struct RowLayout {
  char separator = ',';
  PoseColumns columns;
  int decimals = 0;  ///< by which the unit of the stamps lies below seconds

  /// A number as the TUM format has it: decimal commas become points, an empty cell NaN.
  std::string number(std::string_view cell) const {
    if (cell.empty()) return "nan";
    std::string text(cell);
    if (separator != ',' && std::ranges::count(text, ',') == 1) {
      text[text.find(',')] = '.';
    }
    return text;
  }

  double value(std::string_view cell) const {
    return parse_number(number(cell), false).value_or(std::numeric_limits<double>::quiet_NaN());
  }

  static std::string negated(const std::string& number) {
    if (number == "nan") return number;
    if (number.starts_with('-')) return number.substr(1);
    return '-' + number.substr(number.starts_with('+') ? 1 : 0);
  }

  static std::string text_of(const Eigen::Quaterniond& q) {
    return fmt::format(" {} {} {} {}", q.x(), q.y(), q.z(), q.w());
  }

  /// " qx qy qz qw" of R = Rz(yaw) Ry(pitch) Rx(roll).
  std::string angles_text(const std::vector<std::string_view>& cells) const {
    const double unit = columns.rpy_in_degrees ? std::numbers::pi / 180.0 : 1.0;
    const Eigen::Vector3d angles = unit * angles_of(cells);
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    for (int i = 2; i >= 0; --i) {
      q = q * Eigen::AngleAxisd(angles[i], Eigen::Vector3d::Unit(i));
    }
    return text_of(q);
  }

  Eigen::Vector3d angles_of(const std::vector<std::string_view>& cells) const {
    const auto& rpy = *columns.rpy;
    return {value(cells[rpy[0]]), value(cells[rpy[1]]), value(cells[rpy[2]])};
  }

  /// " x y z qx qy qz qw" of a 3x4 matrix.
  std::string matrix_text(const std::vector<std::string_view>& cells) const {
    Eigen::Matrix3d R;
    std::string text;
    for (Eigen::Index i = 0; i < 12; ++i) {
      const std::string_view cell = cells[*columns.matrix + static_cast<std::size_t>(i)];
      if (i % 4 == 3) {
        text += ' ' + number(cell);
      } else {
        R(i / 4, i % 4) = value(cell);
      }
    }
    // What is no rotation shows in the norm, which is 1 otherwise.
    const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    const bool rotates = off < 0.01 && R.determinant() > 0.0;
    return text + text_of(rotates ? Eigen::Quaterniond(R).normalized()
                                  : Eigen::Quaterniond(2.0, 0.0, 0.0, 0.0));
  }

  std::string row(const std::vector<std::string_view>& cells) const {
    std::string stamp = number(cells[columns.stamp]);
    if (const auto date = parse_iso_time(cells[columns.stamp])) {
      stamp = stamp_text(date->time);
    } else if (columns.nanoseconds) {
      const std::string_view part = cells[*columns.nanoseconds];
      if (is_digits(part) && part.size() <= 9) stamp += fmt::format(".{:0>9}", part);
    } else {
      stamp = stamp_in_seconds(stamp, decimals);
    }
    std::string text = std::move(stamp);
    if (columns.matrix) return text + matrix_text(cells) + '\n';
    for (std::size_t i = 0; i < 3; ++i) {
      std::string axis = number(cells[columns.position[i]]);
      if (i == 2 ? columns.is_down : i == 1 && columns.y_is_up) axis = negated(axis);
      text += ' ' + stamp_in_seconds(axis, columns.position_decimals);
    }
    if (columns.quaternion_xyzw) {
      for (std::size_t i = 0; i < 4; ++i) {
        const std::string part = number(cells[(*columns.quaternion_xyzw)[i]]);
        text += ' ' + (i == 1 && columns.y_is_up ? negated(part) : part);
      }
    } else if (columns.rpy) {
      text += angles_text(cells);
    }
    return text + '\n';
  }
};

/// Reads a table line by line.
class TableReader {
 public:
  /// `in_degrees`: roll, pitch and yaw without a unit.
  TableReader(const std::string& name, int decimals, bool in_degrees,
              std::vector<std::string>& notes)
      : name_(name), decimals_(decimals), angles_in_degrees_(in_degrees), notes_(notes) {}

  const AngleUnit& angle_unit() const { return angle_unit_; }

  /// The row of a line, a line end where it has none.
  Result<std::string> read(std::string_view line) {
    ++number_;
    line = without_comment(line);
    const char separator = layout_ ? layout_->separator : separator_of(line);
    const auto cells = cells_of(line, separator);
    if (!layout_ && motive_.take(cells)) return take_motive();
    const std::size_t stamp = named_ ? named_->stamp : 0;
    const bool names =
        cells.size() >= std::max(kPositionColumns, stamp + 1) && !is_stamp(cells[stamp]);
    if (!layout_ && names && !is_comment(line) && is_row(cells)) {
      return failure(fmt::format(
          "{}:{}: expected a number, or a date as 2023-05-01T12:00:00.5Z, as stamp, found '{}'",
          name_, number_, cells[stamp]));
    }
    if (is_comment(line) || (!layout_ && names)) {
      if (!named_ && cells.size() >= kPositionColumns) take_header(cells, is_comment(line));
      return std::string("\n");
    }
    if (!layout_) {
      if (auto begun = begin(cells, separator); !begun) return tl::unexpected(begun.error());
    }
    // Blanks separate as many numbers as TUM or positions have, or columns that are named.
    const bool odd = separator == ' ' && !named_ && !layout_->columns.matrix &&
                     cells.size() != kPositionColumns && cells.size() != kColumns;
    if (odd || cells.size() < layout_->columns.least()) return wrong_number(cells.size());
    if (layout_->columns.rpy && !layout_->columns.rpy_has_unit) {
      const double unit = std::pow(10.0, -layout_->decimals);
      angle_unit_.add(unit * layout_->value(cells[layout_->columns.stamp]),
                      layout_->angles_of(cells));
    }
    return layout_->row(cells);
  }

 private:
  /// Whether the cells are those of a row and no names.
  static bool is_row(const std::vector<std::string_view>& cells) {
    return std::ranges::count_if(cells, is_number_with_comma) >= 3;
  }

  /// The columns of an export of Motive, whose worlds have y up.
  std::string take_motive() {
    const std::vector<std::string_view> names(motive_.names().begin(), motive_.names().end());
    named_ = named_columns(names);
    header_size_ = names.size();
    if (named_) {
      named_ = with_y_up(*named_);
      notes_.push_back(
          fmt::format("{}: export of Motive: its first rigid body is read, y taken as up", name_));
    }
    return "\n";
  }

  /// The names of the columns, each with its unit.
  void take_header(std::vector<std::string_view> cells, bool comment) {
    std::vector<std::string_view> names;
    for (const std::string_view cell : cells) {
      const bool unit = !names.empty() && (cell.starts_with('[') || cell.starts_with('('));
      if (unit && cell.data() > names.back().data()) {
        const auto end = static_cast<std::size_t>(cell.data() - names.back().data()) + cell.size();
        names.back() = {names.back().data(), end};
      } else {
        names.push_back(cell);
      }
    }
    named_ = named_columns(names);
    in_degrees_ = in_degrees_ || names_degrees(names);
    in_motion_ = names_motion(names);
    if (!named_ && comment) return;
    of_comment_ = comment;
    header_size_ = names.size();
  }

  /// Whether a comment names other columns than the rows have.
  bool is_other_header(const std::vector<std::string_view>& cells) const {
    std::size_t filled = cells.size();
    while (filled > 0 && cells[filled - 1].empty()) --filled;
    return named_ && of_comment_ && header_size_ != filled && header_size_ != cells.size();
  }

  Result<void> begin(const std::vector<std::string_view>& cells, char separator) {
    if (in_degrees_ && !named_) {
      return failure(
          fmt::format("{}:{}: expected positions in metres, found latitude and "
                      "longitude: convert them to a local frame (ENU, UTM)",
                      name_, number_));
    }
    if (in_motion_ && !named_) {
      return failure(fmt::format(
          "{}:{}: expected columns of a position (x, y, z), found velocities or accelerations",
          name_, number_));
    }
    if (is_other_header(cells)) {
      notes_.push_back(
          fmt::format("{}: a comment names {} columns, the rows have {}: taken in "
                      "order",
                      name_, header_size_, cells.size()));
      named_.reset();
    } else if (!named_ && header_size_ > 0) {
      notes_.push_back(
          fmt::format("{}: the header names no x, y, z: the columns are taken in order", name_));
    }
    layout_ = RowLayout{separator, {}, 0};
    const auto unit = unit_by_digits(cells[0]);
    layout_->columns =
        named_ ? *named_ : ordered_columns(cells.size(), unit == StampUnit::kNanoseconds);
    PoseColumns& columns = layout_->columns;
    if (!columns.rpy_has_unit) columns.rpy_in_degrees = angles_in_degrees_;
    if (columns.is_down) {
      notes_.push_back(fmt::format(
          "{}: north, east, down: taken as x = east, y = north, z = up; attitudes are not read",
          name_));
    }
    if (columns.unit == StampUnit::kByDigits && columns.stamp < cells.size()) {
      columns.unit = unit_by_digits(cells[columns.stamp]);
      if (columns.unit == StampUnit::kMicroseconds || columns.unit == StampUnit::kMilliseconds) {
        notes_.push_back(fmt::format("{}: stamps of {} digits: taken as {}", name_,
                                     cells[columns.stamp].size(),
                                     columns.unit == StampUnit::kMicroseconds ? "µs" : "ms"));
      }
    }
    if (columns.stamp < cells.size()) note_date(cells[columns.stamp]);
    const bool seconds = decimals_of(columns.unit) == 0 && !columns.nanoseconds;
    layout_->decimals = seconds ? decimals_ : decimals_of(columns.unit);
    const std::size_t read = kPositionColumns + (columns.nanoseconds ? 1 : 0);
    if (!columns.has_attitude() && cells.size() > read) {
      notes_.push_back(fmt::format("{}: {} {} of {} columns are read: stamp and position", name_,
                                   named_ ? "by their names" : "the first", read, cells.size()));
    }
    return {};
  }

  void note_date(std::string_view stamp) {
    const auto date = parse_iso_time(stamp);
    if (!date) return;
    notes_.push_back(fmt::format("{}: stamps are dates (ISO 8601): read as seconds since 1970{}",
                                 name_, date->has_zone ? "" : ", without a zone taken as UTC"));
  }

  tl::unexpected<Error> wrong_number(std::size_t found) const {
    const bool positions = !layout_->columns.has_attitude();
    if (layout_->separator == ' ' && !named_) {
      return failure(fmt::format(
          "{}:{}: expected 8 columns (TUM: stamp x y z qx qy qz qw), 12 (KITTI poses) or 4 "
          "(positions: stamp x y z), found {}",
          name_, number_, found));
    }
    return failure(fmt::format("{}:{}: expected at least {} columns: stamp, position{}, found {}",
                               name_, number_, layout_->columns.least(),
                               positions ? "" : ", quaternion", found));
  }

  const std::string& name_;
  int decimals_;            ///< of stamps of no other unit
  bool angles_in_degrees_;  ///< that have no unit
  AngleUnit angle_unit_;    ///< that the rows tell
  std::vector<std::string>& notes_;
  std::optional<PoseColumns> named_;
  std::size_t header_size_ = 0;  ///< columns that it names
  bool of_comment_ = false;      ///< the header is a comment
  bool in_degrees_ = false;      ///< the header names latitude or longitude
  bool in_motion_ = false;       ///< the header names velocities where positions are expected
  MotiveHeader motive_;
  std::optional<RowLayout> layout_;
  int number_ = 0;
};

/// Whether a comment in front of rows of so many numbers names columns of another order or unit.
bool names_other_order(std::string_view text, std::size_t count) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (!is_comment(line)) return false;
    const auto cells = cells_of(line, ' ');
    if (names_degrees(cells)) return true;
    const auto named = cells.size() == count ? named_columns(cells) : std::nullopt;
    if (!named) continue;
    const PoseColumns usual = ordered_columns(count, false);
    return named->stamp != usual.stamp || named->position != usual.position ||
           named->position_decimals != 0 || named->is_down ||
           (named->quaternion_xyzw && named->quaternion_xyzw != usual.quaternion_xyzw);
  }
  return false;
}

/// The rows of the text, each on its line.
Result<std::string> rows_of(std::string_view text, TableReader& reader) {
  std::string out;
  while (!text.empty()) {
    auto row = reader.read(take_line(text));
    if (!row) return row;
    out += *row;
  }
  return out;
}

}  // namespace

bool is_pose_table(std::string_view text) {
  const std::size_t feed = std::min(text.find('\n'), text.size());
  const std::size_t carriage = text.find('\r');
  if (carriage < feed && carriage + 1 != feed) return true;
  LineReader lines(text, "");
  const auto line = lines.next();
  if (!line) return false;
  const auto words = words_of(*line);
  const std::size_t count = words.size();
  if (count != kPositionColumns && count != kColumns && count != 12) return true;
  if (!std::ranges::all_of(words, [](auto word) { return parse_number(word, false).has_value(); }))
    return true;
  if (names_other_order(text, count)) return true;
  return count != 12 && unit_by_digits(words[0]) != StampUnit::kSeconds;
}

std::string stamp_in_seconds(std::string_view stamp, int decimals) {
  if (decimals == 0) return std::string(stamp);
  const bool negative = stamp.starts_with('-');
  const std::string_view digits = stamp.substr(negative ? 1 : 0);
  if (digits.find_first_not_of("0123456789.") != std::string_view::npos) {
    const auto number = parse_number(stamp, false);
    return number ? fmt::format("{:.9f}", *number * std::pow(10.0, -decimals)) : std::string(stamp);
  }
  const std::size_t dot = std::min(digits.find('.'), digits.size());
  std::string whole(digits.substr(0, dot));
  const auto moved = static_cast<std::size_t>(decimals);
  if (whole.size() <= moved) whole.insert(0, moved + 1 - whole.size(), '0');
  const std::size_t point = whole.size() - moved;
  return fmt::format("{}{}.{}{}", negative ? "-" : "", whole.substr(0, point), whole.substr(point),
                     digits.substr(std::min(dot + 1, digits.size())));
}

Result<std::string> tum_of_pose_table(std::string_view text, const std::string& name, int decimals,
                                      std::vector<std::string>& notes) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  TableReader reader(name, decimals, false, notes);
  auto rows = rows_of(text, reader);
  const AngleUnit& unit = reader.angle_unit();
  if (!rows || !unit.is_beyond_turn()) return rows;
  notes.push_back(fmt::format(
      "{}: roll, pitch, yaw of no unit reach {:.4g}: taken as {} (a header of 'yaw [rad]' or "
      "'yaw [deg]' states it)",
      name, unit.largest(), unit.is_degrees() ? "degrees" : "unwrapped radians"));
  if (!unit.is_degrees()) return rows;
  std::vector<std::string> repeated;
  TableReader in_degrees(name, decimals, true, repeated);
  return rows_of(text, in_degrees);
}

}  // namespace aims
