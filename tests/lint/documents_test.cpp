// SPDX-License-Identifier: BSD-3-Clause
// Holds the links, pictures, paths and scenario names of documents against the source tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <regex>
#include <set>

#include "tests/lint/documents.hpp"

namespace aims::lint {
namespace {

namespace fs = std::filesystem;

/// The fragment that GitHub gives a heading: lower case, blanks as hyphens, no punctuation.
std::string fragment_of(const std::string& heading) {
  std::string fragment;
  for (const char letter : heading) {
    const auto byte = static_cast<unsigned char>(letter);
    if (std::isalnum(byte) || letter == '_' || letter == '-' || byte >= 128) {
      fragment += static_cast<char>(std::tolower(byte));
    } else if (letter == ' ') {
      fragment += '-';
    }
  }
  return fragment;
}

std::set<std::string> fragments_of(const fs::path& document) {
  std::set<std::string> fragments;
  const std::regex heading("^#+ +(.*[^ ]) *$");
  for (const Line& line : read_lines(document)) {
    std::smatch match;
    if (std::regex_match(line.text, match, heading)) fragments.insert(fragment_of(match[1]));
  }
  return fragments;
}

/// Every match of `pattern`'s first group in the lines of all documents.
std::vector<Line> matches_in_documents(const std::regex& pattern) {
  std::vector<Line> found;
  for (const fs::path& document : documents()) {
    for (const Line& line : read_lines(document)) {
      const auto end = std::sregex_iterator();
      for (auto match = std::sregex_iterator(line.text.begin(), line.text.end(), pattern);
           match != end; ++match) {
        found.push_back({line.source, line.number, (*match)[1]});
      }
    }
  }
  return found;
}

TEST(Documents, LinksAndPicturesExist) {
  for (const Line& link : matches_in_documents(std::regex(R"(\]\(([^)\s]+)\))"))) {
    if (link.text.starts_with("http")) continue;
    const std::size_t hash = link.text.find('#');
    const fs::path folder = fs::path(link.source).parent_path();
    const std::string file = link.text.substr(0, hash);
    const fs::path target = file.empty() ? fs::path(link.source) : (folder / file);
    EXPECT_TRUE(fs::exists(fs::path(AIMS_SOURCE_DIR) / target)) << place(link) << ": " << link.text;
    if (hash == std::string::npos) continue;
    EXPECT_TRUE(fragments_of(target.lexically_normal()).contains(link.text.substr(hash + 1)))
        << place(link) << ": no heading for " << link.text;
  }
}

TEST(Documents, EveryPictureIsShown) {
  std::set<std::string> shown;
  for (const Line& link : matches_in_documents(std::regex(R"(\]\(([^)\s]+\.(?:png|svg|webp))\))"))) {
    shown.insert(fs::path(link.text).filename().string());
  }
  for (const auto& entry : fs::directory_iterator(fs::path(AIMS_SOURCE_DIR) / "docs")) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".png" && extension != ".svg" && extension != ".webp") continue;
    EXPECT_TRUE(shown.contains(entry.path().filename().string())) << entry.path() << " is unused";
  }
}

TEST(Documents, NamedFilesExist) {
  const std::regex span(
      R"(`((?:core|estimator|sim|recordings|bench|render|tests|scripts|models|scenarios|live|docs|cmake)/[\w./-]*)`)");
  for (const Line& path : matches_in_documents(span)) {
    EXPECT_TRUE(fs::exists(fs::path(AIMS_SOURCE_DIR) / path.text))
        << place(path) << ": " << path.text << " does not exist";
  }
}

/// Cells of `independent_recordings`, which are named as scenarios are.
std::set<std::string> names_of_cells() {
  const std::regex quoted("\"([a-z0-9_]+_[0-9]+)\"");
  std::set<std::string> names;
  for (const Line& line : read_lines(fs::path(AIMS_SOURCE_DIR) / "tests/independent/cells.cpp")) {
    const auto end = std::sregex_iterator();
    for (auto match = std::sregex_iterator(line.text.begin(), line.text.end(), quoted);
         match != end; ++match) {
      names.insert((*match)[1]);
    }
  }
  return names;
}

TEST(Documents, NamedScenariosExist) {
  std::set<std::string> names = names_of_cells();
  names.insert("sigma_0");  // a symbol of the same form
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(AIMS_SOURCE_DIR) / "scenarios")) {
    names.insert(entry.path().stem().string());
  }
  const std::regex numbered(R"(\b([a-z]+(?:_[a-z]+)*_[0-9]+(?:_[0-9]+)?)\b)");
  for (const Line& span : matches_in_documents(std::regex("`([^`]*)`"))) {
    const auto end = std::sregex_iterator();
    for (auto match = std::sregex_iterator(span.text.begin(), span.text.end(), numbered);
         match != end; ++match) {
      EXPECT_TRUE(names.contains((*match)[1]))
          << place(span) << ": no scenario " << (*match)[1];
    }
  }
}

TEST(Sources, NameDocumentsThatExist) {
  const std::regex name(R"(\b(docs/[\w/-]+\.md)\b)");
  for (const char* folder : {"core", "estimator", "sim", "recordings", "bench", "render", "live",
                             "scenarios", "scripts", "tests"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(AIMS_SOURCE_DIR) / folder)) {
      const std::set<std::string> kinds{".hpp", ".cpp", ".yaml", ".sh", ".txt", ".ts", ".py"};
      const fs::path file = fs::relative(entry.path(), AIMS_SOURCE_DIR);
      if (!kinds.contains(file.extension().string())) continue;
      if (file.string().find("node_modules") != std::string::npos) continue;
      for (const Line& line : read_lines(file)) {
        std::smatch match;
        if (!std::regex_search(line.text, match, name)) continue;
        EXPECT_TRUE(fs::exists(fs::path(AIMS_SOURCE_DIR) / match[1].str()))
            << place(line) << ": " << match[1] << " does not exist";
      }
    }
  }
}

TEST(Documents, LinesOfProseFitTheWidth) {
  for (const fs::path& document : documents()) {
    bool code = false;
    for (const Line& line : read_lines(document)) {
      if (line.text.starts_with("```")) code = !code;
      const bool table = line.text.starts_with("|");
      const bool link = line.text.find("](") != std::string::npos;
      const bool command = line.text.find("`aims ") != std::string::npos;
      if (code || table || link || command) continue;
      const auto letters = std::count_if(line.text.begin(), line.text.end(), [](char byte) {
        return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;  // UTF-8: first bytes alone
      });
      EXPECT_LE(letters, 120) << place(line);
    }
  }
}

}  // namespace
}  // namespace aims::lint
