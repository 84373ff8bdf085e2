// SPDX-License-Identifier: BSD-3-Clause
#include "tests/lint/documents.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace aims::lint {

namespace fs = std::filesystem;

std::vector<Line> split_lines(const std::string& source, const std::string& text) {
  std::vector<Line> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back({source, static_cast<int>(lines.size()) + 1, line});
  }
  return lines;
}

std::vector<Line> read_lines(const fs::path& file) {
  std::ifstream stream(fs::path(AIMS_SOURCE_DIR) / file);
  std::ostringstream text;
  text << stream.rdbuf();
  return split_lines(file.string(), text.str());
}

std::vector<fs::path> documents() {
  std::vector<fs::path> files{"README.md"};
  const fs::path source(AIMS_SOURCE_DIR);
  for (const auto& entry : fs::recursive_directory_iterator(source / "docs")) {
    if (entry.path().extension() == ".md") files.push_back(entry.path().lexically_relative(source));
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string place(const Line& line) { return line.source + ":" + std::to_string(line.number); }

}  // namespace aims::lint
