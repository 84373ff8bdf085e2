// SPDX-License-Identifier: BSD-3-Clause
// Holds the source tree against the table "who may include whom" of docs/architecture.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Prefixes of the project's own headers that each folder may include.
const std::map<std::string, std::vector<std::string>> kAllowed = {
    {"core", {"core/"}},
    {"estimator", {"core/", "estimator/"}},
    {"sim", {"core/", "sim/"}},
    {"eval", {"core/", "eval/"}},
    {"io", {"core/", "io/"}},
    {"render",
     {"core/", "render/", "sim/environment/scene", "sim/truth.hpp", "sim/quadruped_model.hpp"}},
    {"harness", {"core/", "estimator/", "sim/", "eval/", "io/", "render/", "harness/"}},
    {"report",
     {"core/", "eval/", "io/", "render/", "harness/", "report/", "sim/environment/scene",
      "sim/environment/triangles.hpp"}},
    {"app", {"core/", "harness/", "report/", "app/"}},
    {"ros", {"core/", "estimator/", "io/", "harness/", "ros/"}},
};

/// Prefixes of third-party headers and the folders that may include them, in which kind of file.
struct Confinement {
  std::string header;
  std::vector<std::string> folders;
  bool in_headers;
};
const std::vector<Confinement> kConfined = {
    {"mujoco/", {"sim", "render"}, false},
    {"embree3/", {"sim", "report"}, false},
    {"GL/", {"render"}, false},
    {"cairo", {"render"}, false},
    {"yaml-cpp/", {"io"}, false},
    {"SQLiteCpp/", {"harness"}, false},
    {"pagmo/", {"harness"}, false},
    {"zlib.h", {"render", "report"}, false},
    {"CLI/", {"app", "ros"}, true},
    {"ros/ros.h", {"ros"}, false},
};

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const std::string& prefix) { return text.starts_with(prefix); });
}

std::vector<fs::path> sources_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".hpp" || extension == ".cpp") files.push_back(entry.path());
  }
  return files;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The header named by an include line, or empty.
std::string included(const std::string& line) {
  if (!line.starts_with("#include ")) return {};
  return line.substr(10, line.find_last_of("\">") - 10);
}

bool is_own(const std::string& header) {
  return std::any_of(kAllowed.begin(), kAllowed.end(),
                     [&](const auto& each) { return header.starts_with(each.first + "/"); });
}

TEST(IncludeRules, EachFolderIncludesOnlyWhatTheTableAllows) {
  for (const auto& [folder, allowed] : kAllowed) {
    for (const fs::path& file : sources_in(fs::path(AIMS_SOURCE_DIR) / folder)) {
      for (const std::string& line : lines_of(file)) {
        const std::string header = included(line);
        if (!is_own(header)) continue;
        EXPECT_TRUE(starts_with_any(header, allowed)) << file << " includes " << header;
      }
    }
  }
}

TEST(IncludeRules, ThirdPartyHeadersStayInTheirFolders) {
  for (const auto& [folder, unused] : kAllowed) {
    for (const fs::path& file : sources_in(fs::path(AIMS_SOURCE_DIR) / folder)) {
      for (const std::string& line : lines_of(file)) {
        for (const Confinement& rule : kConfined) {
          if (!included(line).starts_with(rule.header)) continue;
          EXPECT_TRUE(starts_with_any(folder, rule.folders)) << file << ": " << line;
          EXPECT_TRUE(rule.in_headers || file.extension() == ".cpp") << file << ": " << line;
        }
      }
    }
  }
}

TEST(SourceFiles, StartWithTheLicence) {
  for (const auto& [folder, unused] : kAllowed) {
    for (const fs::path& file : sources_in(fs::path(AIMS_SOURCE_DIR) / folder)) {
      const std::vector<std::string> lines = lines_of(file);
      ASSERT_FALSE(lines.empty()) << file;
      EXPECT_EQ(lines.front(), "// SPDX-License-Identifier: BSD-3-Clause") << file;
    }
  }
}

}  // namespace
}  // namespace aims
