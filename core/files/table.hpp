// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace aims {

/// A table of texts: a header and rows of equal length. The first column is left-aligned, the
/// others right-aligned.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// The table without columns while its text is wider than `width`: those whose titles begin with a
/// text of `least`, the first of them first, and never the first column. Their titles are added to
/// `left_out`.
TextTable narrowed(TextTable table, std::size_t width, std::span<const char* const> least,
                   std::vector<std::string>& left_out);

/// The table with aligned columns and a rule under the header, a line per row.
std::string to_text(const TextTable& table);

/// The table as a tabular of LaTeX with the rules of booktabs; every character stands for itself.
std::string to_latex(const TextTable& table);

/// The table as Markdown.
std::string to_markdown(const TextTable& table);

}  // namespace aims
