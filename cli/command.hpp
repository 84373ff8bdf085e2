// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

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

/// Smallest and largest value of an option.
struct Limits {
  double low = 0.0;
  double high = 0.0;
};

enum class Presence { kOptional, kRequired };

/// What a setting is of: the help shows it, and only keys of a scenario are completed.
inline constexpr const char* kScenarioSetting = "KEY=VALUE";
inline constexpr const char* kGroupSetting = "GROUP.KEY=VALUE";  ///< recording, scoring, ...

/// A command of `aims` while it is declared. Options fill variables, which must live until the
/// action has run; a variable's value before that is the default. An empty value is an error.
/// `names` is one spelling or several, e.g. "-o,--out".
class Command {
 public:
  Command(CLI::App& app, int& exit_code) : app_(&app), exit_code_(&exit_code) {}

  /// One value, or any number of them, without a flag.
  void argument(const std::string& name, std::string& value, const std::string& help,
                Presence presence = Presence::kRequired);
  void arguments(const std::string& name, std::vector<std::string>& values, const std::string& help,
                 Presence presence = Presence::kOptional);

  void option(const std::string& names, std::string& value, const std::string& help,
              Presence presence = Presence::kOptional);
  void option(const std::string& names, std::filesystem::path& value, const std::string& help,
              Presence presence = Presence::kOptional);
  void option(const std::string& names, int& value, Limits limits, const std::string& help);
  void option(const std::string& names, double& value, Limits limits, const std::string& help);
  void option(const std::string& names, std::optional<int>& value, Limits limits,
              const std::string& help);
  void option(const std::string& names, std::optional<double>& value, Limits limits,
              const std::string& help);
  /// One of `choices`.
  void choice(const std::string& names, std::string& value, const std::vector<std::string>& choices,
              const std::string& help, Presence presence = Presence::kOptional);
  /// Values separated by commas.
  void list(const std::string& names, std::vector<std::string>& values, const std::string& help);
  /// One value each time; may be given several times.
  void repeatable(const std::string& names, std::vector<std::string>& values,
                  const std::string& help, Presence presence = Presence::kOptional);
  /// The same, of settings: `kind` is one of those above.
  void settings(const std::string& names, std::vector<std::string>& values, const char* kind,
                const std::string& help);
  void flag(const std::string& names, bool& value, const std::string& help);
  /// Makes giving both an error.
  void exclude(const std::string& name, const std::string& other);

  /// Text below the options: examples, exit codes.
  void footer(const std::string& text);
  /// What the command does when it is given; returns the exit code.
  void action(std::function<int()> run);
  /// A command below this one, which then expects one of them.
  Command subcommand(const std::string& name, const std::string& summary);
  /// The whole program with all its declarations.
  const CLI::App& program() const;

 private:
  CLI::App* app_;
  int* exit_code_;
};

/// A command of the program. `declare` gets the folder in which bare scenario names are looked up.
struct CommandEntry {
  const char* name;
  const char* summary;
  void (*declare)(Command command, const std::filesystem::path& scenario_folder);
};

/// The whole program.
struct Program {
  std::string name;
  std::string description;
  std::string footer;
  std::string version;
  std::span<const CommandEntry> commands;
  std::span<const ExternalCommand> external;  ///< listed in the help where they are installed
  std::filesystem::path scenario_folder;
};

/// Runs the command that the arguments give; its exit code, or that of a usage error, which is one
/// line on standard error with a near match for an unknown command or option. An exception is one
/// line and the code of an internal error.
int run_program(const Program& program, int argc, char** argv);

/// Exit codes of the `aims` command.
enum ExitCode : int {
  kOk = 0,
  kExpectationFailed = 1,  ///< an expectation or an estimator failed; jobs are missing
  kBadInput = 2,           ///< usage, configuration or files
  kInternal = 3,           ///< a defect of this program
  kInvalidRun = 4,         ///< a run is invalid (bench/scoring/validity.hpp), or an estimate
  kInterrupted = 130,      ///< Ctrl-C; results so far are written; likewise 129 and 143
};

}  // namespace aims
