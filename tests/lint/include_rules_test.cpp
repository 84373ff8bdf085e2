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
    {"estimator/interface", {"core/", "estimator/interface/"}},
    {"estimator/filter", {"core/", "estimator/interface/", "estimator/filter/"}},
    {"estimator/degeneracy", {"core/", "estimator/filter/", "estimator/degeneracy/"}},
    {"estimator/legs", {"core/", "estimator/filter/", "estimator/legs/"}},
    {"estimator/ground", {"core/", "estimator/filter/", "estimator/ground/"}},
    {"estimator/lidar",
     {"core/", "estimator/filter/", "estimator/degeneracy/", "estimator/lidar/"}},
    {"estimator/constrained",
     {"core/", "estimator/filter/", "estimator/degeneracy/", "estimator/lidar/",
      "estimator/constrained/"}},
    {"estimator/aims",
     {"core/", "estimator/interface/", "estimator/filter/", "estimator/degeneracy/",
      "estimator/legs/", "estimator/ground/", "estimator/lidar/", "estimator/constrained/",
      "estimator/aims/"}},
    {"estimator/baselines",
     {"core/", "estimator/interface/", "estimator/filter/", "estimator/lidar/",
      "estimator/baselines/"}},
    {"estimator/python", {"core/", "estimator/interface/", "estimator/python/"}},
    {"sim", {"core/", "sim/"}},
    {"sim/environment", {"core/", "sim/environment/"}},
    {"sim/robot", {"core/", "sim/environment/", "sim/robot/"}},
    {"sim/sensors",
     {"sim/run_seeds.hpp", "core/", "sim/environment/", "sim/robot/", "sim/sensors/"}},
    {"sim/links", {"core/", "sim/links/"}},
    {"recordings", {"core/", "recordings/"}},
    {"recordings/bag", {"core/", "recordings/bag/", "recordings/messages/message_type.hpp"}},
    {"recordings/mcap", {"core/", "recordings/bag/", "recordings/mcap/", "recordings/messages/"}},
    {"recordings/csv", {"core/", "recordings/bag/", "recordings/csv/", "recordings/messages/"}},
    {"recordings/pcap", {"core/", "recordings/bag/", "recordings/messages/", "recordings/pcap/"}},
    {"recordings/rosbag2",
     {"core/", "recordings/bag/", "recordings/mcap/", "recordings/messages/",
      "recordings/rosbag2/"}},
    {"recordings/source",
     {"core/", "recordings/bag/", "recordings/csv/", "recordings/mcap/", "recordings/messages/",
      "recordings/legs/", "recordings/pcap/", "recordings/rosbag2/", "recordings/source/"}},
    {"recordings/messages", {"core/", "recordings/messages/", "recordings/event_counts.hpp"}},
    {"recordings/clouds",
     {"core/", "recordings/messages/", "recordings/clouds/", "recordings/recording_config.hpp",
      "recordings/event_counts.hpp", "recordings/reading_notes.hpp"}},
    {"recordings/frames",
     {"core/", "recordings/messages/", "recordings/frames/", "recordings/recording_config.hpp",
      "recordings/event_counts.hpp", "recordings/reading_notes.hpp"}},
    {"recordings/legs",
     {"core/", "recordings/messages/", "recordings/legs/", "recordings/recording_config.hpp",
      "recordings/event_counts.hpp", "recordings/reading_notes.hpp"}},
    {"recordings/topics",
     {"core/", "recordings/bag/", "recordings/messages/", "recordings/topics/",
      "recordings/recording_config.hpp"}},
    {"recordings/trajectories",
     {"core/", "recordings/bag/", "recordings/frames/", "recordings/messages/",
      "recordings/source/", "recordings/topics/", "recordings/trajectories/"}},
    {"recordings/stream",
     {"core/", "recordings/bag/", "recordings/messages/", "recordings/clouds/",
      "recordings/frames/", "recordings/legs/", "recordings/source/", "recordings/topics/",
      "recordings/stream/", "recordings/recording_config.hpp", "recordings/event_counts.hpp",
      "recordings/reading_notes.hpp"}},
    {"bench/metrics", {"core/", "bench/metrics/"}},
    {"bench/scoring", {"core/", "estimator/", "bench/metrics/", "bench/scoring/"}},
    {"bench/estimate",
     {"core/", "estimator/", "recordings/", "bench/metrics/", "bench/scoring/", "bench/estimate/"}},
    {"bench/scenario",
     {"core/", "estimator/", "sim/", "bench/metrics/", "bench/scoring/", "bench/estimate/",
      "bench/scenario/"}},
    {"bench/run",
     {"core/", "estimator/", "sim/", "recordings/", "bench/metrics/", "bench/scoring/",
      "bench/estimate/", "bench/scenario/", "bench/run/"}},
    {"bench/jobs",
     {"core/", "estimator/", "sim/", "bench/metrics/", "bench/scoring/", "bench/estimate/",
      "bench/scenario/", "bench/run/", "bench/jobs/"}},
    {"bench/studies",
     {"core/", "estimator/", "sim/", "bench/metrics/", "bench/scoring/", "bench/estimate/",
      "bench/scenario/", "bench/run/", "bench/jobs/", "bench/studies/"}},
    {"bench/tuning",
     {"core/", "estimator/", "bench/metrics/", "bench/scoring/", "bench/estimate/",
      "bench/scenario/", "bench/run/", "bench/jobs/", "bench/tuning/"}},
    {"cli",
     {"core/", "estimator/estimator_spec.hpp", "recordings/inspection/", "bench/", "render/",
      "cli/"}},
    {"render/plots", {"core/", "render/plots/", "sim/environment/scene.hpp"}},
    {"render/scene",
     {"core/", "render/plots/", "render/scene/", "sim/environment/", "sim/robot/truth.hpp"}},
    {"render/film",
     {"core/", "estimator/", "bench/metrics/", "bench/scoring/", "bench/estimate/",
      "bench/scenario/", "bench/run/", "render/film/", "render/plots/", "render/scene/", "sim/"}},
    {"render/results",
     {"core/", "estimator/", "bench/metrics/", "bench/scoring/", "bench/estimate/",
      "bench/scenario/", "bench/run/", "bench/studies/", "bench/tuning/", "render/plots/",
      "render/scene/", "render/results/", "sim/"}},
    {"render/page", {"core/", "bench/", "render/page/", "render/plots/", "sim/"}},
    {"lab",
     {"core/", "estimator/", "sim/", "recordings/", "bench/", "cli/", "render/", "lab/",
      "tests/support/"}},
    {"live", {"core/", "estimator/", "recordings/", "live/"}},
    {"python",
     {"core/", "estimator/", "sim/simulation.hpp", "recordings/", "bench/scoring/",
      "bench/estimate/", "bench/scenario/", "bench/run/", "bench/jobs/", "python/"}},
    {"tests/independent",
     {"core/", "recordings/", "tests/independent/", "tests/support/temporary_folder.hpp"}},
};

/// Prefixes of third-party headers and the folders that may include them, in which kind of file.
struct Confinement {
  std::string header;
  std::vector<std::string> folders;
  bool in_headers;
};
const std::vector<Confinement> kConfined = {
    {"mujoco/", {"sim", "render/scene"}, false},
    {"embree3/", {"sim", "render/page"}, false},
    {"GL/", {"render/scene"}, false},
    {"cairo", {"render"}, false},
    {"yaml-cpp/", {"core"}, false},
    {"sqlite3.h", {"core"}, false},
    {"pagmo/", {"bench/tuning"}, false},
    {"zlib.h", {"core", "render/page"}, false},
    {"webp/", {"render/film"}, false},
    {"CLI/", {"cli", "lab", "live", "tests/independent"}, true},
    {"ros/ros.h", {"live"}, false},
    {"dds/", {"live"}, false},
    {"httplib.h", {"live"}, false},
    {"pybind11/", {"python"}, true},
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
  return !header.empty() && fs::is_regular_file(fs::path(AIMS_SOURCE_DIR) / header);
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

TEST(IncludeRules, BaselinesAreIncludedByTheRegistryAlone) {
  for (const auto& [folder, unused] : kAllowed) {
    for (const fs::path& file : sources_in(fs::path(AIMS_SOURCE_DIR) / folder)) {
      const std::string name = fs::relative(file, AIMS_SOURCE_DIR).string();
      if (name.starts_with("estimator/baselines/") || name == "estimator/registry.cpp") continue;
      for (const std::string& line : lines_of(file)) {
        EXPECT_FALSE(included(line).starts_with("estimator/baselines/")) << file << ": " << line;
      }
    }
  }
}

TEST(IncludeRules, TheVocabularyIncludesNoFileFormat) {
  for (const fs::path& file : sources_in(fs::path(AIMS_SOURCE_DIR) / "core")) {
    if (file.parent_path().filename() == "files") continue;
    for (const std::string& line : lines_of(file)) {
      EXPECT_FALSE(included(line).starts_with("core/files/")) << file << ": " << line;
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

// Names in files may hold any bytes, which print_out makes safe for a terminal.
TEST(Commands, PrintThroughTheTerminal) {
  for (const fs::path& file : sources_in(fs::path(AIMS_SOURCE_DIR) / "cli")) {
    for (const std::string& line : lines_of(file)) {
      EXPECT_EQ(line.find("fmt::print(\""), std::string::npos) << file << ": " << line;
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
