// SPDX-License-Identifier: BSD-3-Clause
// Lines of tables as text, and their cells.
#pragma once

#include <string_view>
#include <vector>

namespace aims {

/// Takes the next line, which may end in a carriage return alone.
std::string_view take_line(std::string_view& text);

/// An empty line too.
bool is_comment(std::string_view line);

/// Without a comment behind the row.
std::string_view without_comment(std::string_view line);

/// The sign between the cells of a line; a blank for any number of blanks and tabs.
char separator_of(std::string_view line);

/// Without blanks and quotes around them, and the sign of a comment in front.
std::vector<std::string_view> cells_of(std::string_view line, char separator);

/// A number whose decimals may follow a comma.
bool is_number_with_comma(std::string_view word);

}  // namespace aims
