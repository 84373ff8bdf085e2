// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aims::lint {

/// A line of a document or of a command's output.
struct Line {
  std::string source;  ///< file below the source folder, or the command that printed the line
  int number = 0;      ///< from 1
  std::string text;
};

/// The lines of `text`, which `source` printed.
std::vector<Line> split_lines(const std::string& source, const std::string& text);

/// The lines of `file`, a path below the source folder.
std::vector<Line> read_lines(const std::filesystem::path& file);

/// README.md, docs/*.md, paths below the source folder.
std::vector<std::filesystem::path> documents();

/// "file:line" for messages.
std::string place(const Line& line);

}  // namespace aims::lint
