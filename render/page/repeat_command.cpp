// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/repeat_command.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "core/shell_word.hpp"
#include "render/page/page_data.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// A path that was given in the working directory, as seen from `folder`. One that is not there any
/// more stays as it was given.
std::string seen_from(const fs::path& folder, const fs::path& given) {
  std::error_code code;
  if (given.is_absolute() || !fs::exists(given, code)) return given.string();
  const fs::path there = fs::relative(given, folder, code);
  return code || there.empty() ? given.string() : there.string();
}

/// First parts of the modules of "python:package.module.Class" in the text.
std::set<std::string> python_modules(const std::string& text) {
  constexpr std::string_view kMark = "python:";
  std::set<std::string> modules;
  for (std::size_t at = text.find(kMark); at != std::string::npos; at = text.find(kMark, at + 1)) {
    const std::size_t begin = at + kMark.size();
    const std::size_t end = text.find('.', begin);
    if (end != std::string::npos) modules.insert(text.substr(begin, end - begin));
  }
  return modules;
}

/// The working directory and those of PYTHONPATH.
std::vector<fs::path> python_folders() {
  std::vector<fs::path> folders = {"."};
  const char* path = std::getenv("PYTHONPATH");
  std::istringstream parts(path == nullptr ? "" : path);
  for (std::string part; std::getline(parts, part, ':');) {
    if (!part.empty()) folders.emplace_back(part);
  }
  return folders;
}

/// "PYTHONPATH=../.. ", with the folders in which the modules lie; empty without any module.
std::string python_path(const std::set<std::string>& modules, const fs::path& folder) {
  std::vector<std::string> folders;
  for (const std::string& module : modules) {
    std::string found = "FOLDER_OF_" + module;
    for (const fs::path& each : python_folders()) {
      std::error_code ignored;
      if (!fs::exists(each / (module + ".py"), ignored) && !fs::exists(each / module, ignored)) {
        continue;
      }
      found = seen_from(folder, each);
      break;
    }
    if (std::ranges::find(folders, found) == folders.end()) folders.push_back(std::move(found));
  }
  if (folders.empty()) return "";
  return fmt::format("PYTHONPATH={} ", shell_word(fmt::format("{}", fmt::join(folders, ":"))));
}

}  // namespace

Json repeat_command_json(const RunFolder& run) {
  if (run.config_yaml.empty()) return {};
  const std::string path = python_path(python_modules(run.config_yaml), run.path);
  if (run.estimate.is_object()) {
    const Json bag = member(run.estimate, "bag");
    if (!bag.is_string()) return {};
    return fmt::format("{}aims estimate {} --config config.yaml --out again", path,
                       shell_word(seen_from(run.path, bag.get<std::string>())));
  }
  const Json seed = member(run.scores, "seed");
  const std::string seeds =
      seed.is_number_unsigned() ? fmt::format(" --seed {}", seed.get<std::uint64_t>()) : "";
  return fmt::format("{}aims run config.yaml{} --out again", path, seeds);
}

}  // namespace aims
