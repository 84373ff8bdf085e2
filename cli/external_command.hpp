// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace aims {

/// A command that is a program of its own, `aims_NAME`, which another package may install.
struct ExternalCommand {
  const char* name;
  const char* summary;
  const char* package;  ///< that has the program
};

/// The file of `aims_NAME`: in the folder of `program`, else in one of `search_path`, which has
/// folders separated by ':'. Empty: there is none that can be executed.
std::filesystem::path find_external(const ExternalCommand& command,
                                    const std::filesystem::path& program,
                                    const std::string& search_path);

/// As above, of the running program and $PATH.
std::filesystem::path find_external(const ExternalCommand& command);

/// Becomes the command's program, which gets `arguments` (argv[0] is that of the command). Returns
/// only where there is none: then the exit code, and the error is printed.
int run_external(const ExternalCommand& command, std::span<char*> arguments);

}  // namespace aims
