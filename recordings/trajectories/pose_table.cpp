// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/trajectories/pose_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <vector>

#include "core/files/number_lines.hpp"

namespace aims {
namespace {

constexpr std::size_t kColumns = 8;
constexpr std::size_t kPositionColumns = 4;
constexpr std::size_t kNanosecondDigits = 16;  ///< of a stamp, at least

std::string_view trimmed(std::string_view cell) {
  const std::size_t first = cell.find_first_not_of(" \t\r\"#");
  if (first == std::string_view::npos) return {};
  return cell.substr(first, cell.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  const char separator = line.find(',') != std::string_view::npos ? ',' : ';';
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t end = std::min(line.find(separator), line.size());
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == line.size()) return cells;
    line.remove_prefix(end + 1);
  }
}

/// Where the header names the w of the quaternion, if it does.
std::optional<std::size_t> column_of_w(const std::vector<std::string_view>& header) {
  for (std::size_t i = 4; i < std::min(header.size(), kColumns); ++i) {
    std::string name(header[i].substr(0, header[i].find_first_of(" [(")));
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    if (name.ends_with('w')) return i;
  }
  return std::nullopt;
}

bool is_nanoseconds(std::string_view stamp) {
  return stamp.size() >= kNanosecondDigits &&
         std::ranges::all_of(stamp, [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::string seconds_of(std::string_view stamp) {
  if (!is_nanoseconds(stamp)) return std::string(stamp);
  return fmt::format("{}.{}", stamp.substr(0, stamp.size() - 9), stamp.substr(stamp.size() - 9));
}

/// How the rows of a table are read.
struct RowLayout {
  bool positions = false;  ///< stamp and position alone
  bool w_first = false;

  std::size_t columns() const { return positions ? kPositionColumns : kColumns; }

  std::string row(const std::vector<std::string_view>& cells) const {
    std::string text =
        fmt::format("{} {} {} {}", seconds_of(cells[0]), cells[1], cells[2], cells[3]);
    const std::size_t x = w_first ? 5 : 4;
    if (!positions) {
      text +=
          fmt::format(" {} {} {} {}", cells[x], cells[x + 1], cells[x + 2], cells[w_first ? 4 : 7]);
    }
    return text + '\n';
  }
};

}  // namespace

bool is_pose_table(std::string_view text) {
  LineReader lines(text, "");
  const auto line = lines.next();
  return line && line->find_first_of(",;") != std::string_view::npos;
}

Result<std::string> tum_of_pose_table(std::string_view text, const std::string& name,
                                      std::vector<std::string>& notes) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::string out;
  std::optional<std::size_t> w;
  std::optional<RowLayout> layout;
  int number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    const auto cells = cells_of(line);
    const bool comment = line.find_first_not_of(" \t\r") == std::string_view::npos ||
                         line[line.find_first_not_of(" \t\r")] == '#';
    const bool header =
        !layout && cells.size() >= kPositionColumns && !parse_number(cells[0], false);
    if (comment || header) {
      if (!w && cells.size() >= kColumns) w = column_of_w(cells);
      out += '\n';
      continue;
    }
    if (!layout) {
      layout = RowLayout{cells.size() < kColumns, w ? *w == 4 : is_nanoseconds(cells[0])};
      if (layout->positions && cells.size() > kPositionColumns) {
        notes.push_back(fmt::format("{}: the first 4 of {} columns are read: stamp and position",
                                    name, cells.size()));
      }
    }
    if (cells.size() < layout->columns()) {
      return failure(fmt::format("{}:{}: expected at least {}, found {}", name, number,
                                 layout->positions ? "4 columns: stamp and position"
                                                   : "8 columns: stamp, position, quaternion",
                                 cells.size()));
    }
    out += layout->row(cells);
  }
  return out;
}

}  // namespace aims
