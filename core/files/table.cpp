// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string_view>

#include "core/text.hpp"

namespace aims {
namespace {

/// The cells as one line each: names in them may hold anything.
std::vector<std::string> shown(const std::vector<std::string>& cells) {
  std::vector<std::string> texts;
  for (const std::string& cell : cells) texts.push_back(name_text(cell));
  return texts;
}

std::vector<std::size_t> column_widths(const TextTable& table) {
  std::vector<std::size_t> widths;
  for (const std::string& cell : table.header) widths.push_back(cell.size());
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  return widths;
}

/// Characters of a line.
std::size_t total_width(const std::vector<std::size_t>& widths) {
  return std::accumulate(widths.begin(), widths.end(), 2 * (widths.size() - 1));
}

std::string line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string text = fmt::format("{:<{}}", cells.front(), widths.front());
  for (std::size_t i = 1; i < cells.size(); ++i) {
    text += fmt::format("  {:>{}}", cells[i], widths[i]);
  }
  return text + "\n";
}

/// A cell of a Markdown table, with bars escaped.
std::string escaped(const std::string& cell) {
  std::string text;
  for (const char c : name_text(cell)) text += c == '|' ? std::string("\\|") : std::string(1, c);
  return text;
}

/// A cell of a LaTeX table, in which no character commands anything.
std::string latex_cell(const std::string& cell) {
  std::string text;
  for (const char c : name_text(cell)) {
    if (std::string_view("&%$#_{}").find(c) != std::string_view::npos) {
      text += std::string("\\") + c;
    } else if (c == '\\') {
      text += "\\textbackslash{}";
    } else if (c == '~' || c == '^') {
      text += std::string("\\") + c + "{}";
    } else if (c == '<' || c == '>' || c == '|') {
      text += fmt::format("${}$", c);
    } else {
      text += c;
    }
  }
  return text;
}

std::string latex_row(const std::vector<std::string>& cells) {
  std::string text;
  for (const std::string& cell : cells) text += (text.empty() ? "" : " & ") + latex_cell(cell);
  return text + " \\\\\n";
}

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string text = "|";
  for (const std::string& cell : cells) text += fmt::format(" {} |", escaped(cell));
  return text + "\n";
}

}  // namespace

TextTable narrowed(TextTable table, std::size_t width, std::span<const char* const> least,
                   std::vector<std::string>& left_out) {
  for (const char* title : least) {
    for (std::size_t i = table.header.size(); i-- > 1;) {
      if (total_width(column_widths(table)) <= width) return table;
      if (!table.header[i].starts_with(title)) continue;
      const auto at = static_cast<std::ptrdiff_t>(i);
      left_out.push_back(table.header[i]);
      table.header.erase(table.header.begin() + at);
      for (auto& row : table.rows) row.erase(row.begin() + at);
    }
  }
  return table;
}

std::string to_text(const TextTable& given) {
  if (given.header.empty()) return "";
  TextTable table = {shown(given.header), {}};
  for (const auto& row : given.rows) table.rows.push_back(shown(row));
  const std::vector<std::size_t> widths = column_widths(table);
  std::string text = line(table.header, widths) + std::string(total_width(widths), '-') + "\n";
  for (const auto& row : table.rows) text += line(row, widths);
  return text;
}

std::string to_latex(const TextTable& table) {
  if (table.header.empty()) return "";
  std::string text =
      fmt::format("\\begin{{tabular}}{{l{}}}\n\\toprule\n{}\\midrule\n",
                  std::string(table.header.size() - 1, 'r'), latex_row(table.header));
  for (const auto& row : table.rows) text += latex_row(row);
  return text + "\\bottomrule\n\\end{tabular}\n";
}

std::string to_markdown(const TextTable& table) {
  if (table.header.empty()) return "";
  std::string text = markdown_row(table.header) + "|---|";
  for (std::size_t i = 1; i < table.header.size(); ++i) text += "---:|";
  text += "\n";
  for (const auto& row : table.rows) text += markdown_row(row);
  return text;
}

}  // namespace aims
