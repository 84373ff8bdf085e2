// SPDX-License-Identifier: BSD-3-Clause
#include "cli/external_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>
#include <vector>

#include "cli/exit_code.hpp"
#include "cli/terminal.hpp"

namespace aims {

namespace fs = std::filesystem;

fs::path find_external(const ExternalCommand& command, const fs::path& program,
                       const std::string& search_path) {
  const std::string file = std::string("aims_") + command.name;
  std::vector<fs::path> folders = {program.parent_path()};
  std::istringstream listed(search_path);
  for (std::string folder; std::getline(listed, folder, ':');) {
    if (!folder.empty()) folders.emplace_back(folder);
  }
  for (const fs::path& folder : folders) {
    std::error_code none;
    const fs::path candidate = folder / file;
    if (fs::is_regular_file(candidate, none) && access(candidate.c_str(), X_OK) == 0) {
      return candidate;
    }
  }
  return {};
}

fs::path find_external(const ExternalCommand& command) {
  const char* path = std::getenv("PATH");
  return find_external(command, fs::read_symlink("/proc/self/exe"), path == nullptr ? "" : path);
}

int run_external(const ExternalCommand& command, std::span<char*> arguments) {
  const fs::path file = find_external(command);
  if (file.empty()) {
    print_error(
        fmt::format("aims {0}: the program aims_{0} is not installed: sudo apt install "
                    "./{1}_*.deb, or build the target aims_{0} (docs/live.md)",
                    command.name, command.package));
    return kBadInput;
  }
  std::vector<char*> words(arguments.begin(), arguments.end());
  words.push_back(nullptr);
  execv(file.c_str(), words.data());
  print_error(fmt::format("aims {}: {}: {}", command.name, file.string(), std::strerror(errno)));
  return kBadInput;
}

}  // namespace aims
