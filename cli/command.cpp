// SPDX-License-Identifier: BSD-3-Clause
#include "cli/command.hpp"

#include <fmt/format.h>

#include <unistd.h>
#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include "cli/json_output.hpp"
#include "cli/terminal.hpp"
#include "core/config.hpp"
#include "core/text.hpp"

namespace aims {

namespace fs = std::filesystem;

fs::path find_external(const ExternalCommand& command, const fs::path& program,
                       const std::string& search_path) {
  const std::string file = std::string("aims_") + command.name;
  std::vector<fs::path> folders = {program.parent_path()};
  for (const std::string& folder : split(search_path, ':')) {
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

namespace {

CLI::Option* require(CLI::Option* option, Presence presence) {
  return option->required(presence == Presence::kRequired);
}

/// Refuses nan, which no range excludes.
CLI::Validator is_number() {
  return {[](std::string& value) {
            return value.find("nan") != std::string::npos ? "expected a number, got nan" : "";
          },
          ""};
}

/// A number in the limits, which the help shows.
template <class Number, class Value>
void add_number(CLI::App& app, const std::string& names, Value& value, Limits limits,
                const std::string& help) {
  app.add_option(names, value, help)
      ->check(CLI::Range(static_cast<Number>(limits.low), static_cast<Number>(limits.high)))
      ->check(is_number());
}

/// Refuses a value that was given as ''.
CLI::Validator not_empty() {
  return {[](std::string& value) { return value.empty() ? "expected a value, got ''" : ""; }, ""};
}

/// "run", "study ablation": every command below `app`, or those alone of that last word.
std::vector<std::string> paths_below(const CLI::App& app, const std::string& prefix = "") {
  std::vector<std::string> paths;
  for (const CLI::App* each : app.get_subcommands([](const CLI::App*) { return true; })) {
    const std::string path = prefix + each->get_name();
    const auto below = paths_below(*each, path + " ");
    paths.insert(paths.end(), below.begin(), below.end());
    if (below.empty()) paths.push_back(path);
  }
  return paths;
}

/// The command nearest to `word`, which may be one of the words of its path.
std::string near_command(const CLI::App& root, const std::string& word) {
  const auto paths = paths_below(root);
  std::vector<std::string> words;
  for (const std::string& path : paths) words.push_back(path.substr(path.rfind(' ') + 1));
  const std::string near = near_match(word, words);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (words[i] == near) return paths[i];
  }
  return "";
}

std::string path_of(const CLI::App& app) {
  const CLI::App* parent = app.get_parent();
  return parent == nullptr ? app.get_name() : path_of(*parent) + " " + app.get_name();
}

/// What is wrong with the words that name the command; empty when they do name one.
std::string unknown_command(const CLI::App& root, std::span<char*> words) {
  const CLI::App* app = &root;
  for (const char* given : words) {
    const std::string word = given;
    const auto below = app->get_subcommands([](const CLI::App*) { return true; });
    if (below.empty() || word.starts_with('-')) return "";
    const auto found = std::find_if(below.begin(), below.end(),
                                    [&](const CLI::App* each) { return each->get_name() == word; });
    if (found == below.end()) {
      const std::string near = near_command(root, word);
      if (!near.empty()) {
        return fmt::format("unknown command '{}'; did you mean 'aims {}'?", word, near);
      }
      std::vector<std::string> names;
      for (const CLI::App* each : below) names.push_back(each->get_name());
      return fmt::format("unknown command '{}'; expected one of {} (`{} --help` describes them)",
                         word, fmt::join(names, ", "), path_of(*app));
    }
    app = *found;
  }
  return "";
}

/// The command that was given last, e.g. `ablation` of `aims study ablation`.
const CLI::App& given_command(const CLI::App& app) {
  const auto given = app.get_subcommands();
  return given.empty() ? app : given_command(*given.back());
}

/// The first argument that the command does not know, with its nearest option.
std::string unknown_argument(const CLI::App& command, const std::vector<std::string>& left) {
  const auto option = std::find_if(left.begin(), left.end(),
                                   [](const std::string& each) { return each.starts_with('-'); });
  if (option == left.end()) return fmt::format("unexpected argument '{}'", left.front());
  const std::string name = option->substr(0, option->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* each : command.get_options()) {
    for (const std::string& known : each->get_lnames()) names.push_back("--" + known);
  }
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    return fmt::format("option '{}' stands before its command; give it after '{}'", name,
                       command.get_name());
  }
  const std::string near = near_match(name, names);
  return near.empty() ? fmt::format("unknown option '{}'", name)
                      : fmt::format("unknown option '{}'; did you mean '{}'?", name, near);
}

int usage_error(const std::string& path, const std::string& message, bool json) {
  if (json) print_json({{"error", message}});
  print_error(fmt::format("{}: {} (see {} --help)", path, message, path));
  return kBadInput;
}

int parse(CLI::App& app, int argc, char** argv) try {
  app.parse(argc, argv);
  return kOk;
} catch (const CLI::ExtrasError&) {
  const CLI::App& command = given_command(app);
  const bool json = wants_json({argv, static_cast<std::size_t>(argc)});
  return usage_error(path_of(command), unknown_argument(command, app.remaining(true)), json);
} catch (const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
  const bool json = wants_json({argv, static_cast<std::size_t>(argc)});
  return usage_error(path_of(given_command(app)), error.what(), json);
}

}  // namespace

void Command::argument(const std::string& name, std::string& value, const std::string& help,
                       Presence presence) {
  require(app_->add_option(name, value, help), presence);
}

void Command::arguments(const std::string& name, std::vector<std::string>& values,
                        const std::string& help, Presence presence) {
  require(app_->add_option(name, values, help), presence);
}

void Command::option(const std::string& names, std::string& value, const std::string& help,
                     Presence presence) {
  require(app_->add_option(names, value, help), presence)->check(not_empty());
}

void Command::option(const std::string& names, std::filesystem::path& value,
                     const std::string& help, Presence presence) {
  require(app_->add_option(names, value, help), presence)->check(not_empty());
}

void Command::option(const std::string& names, int& value, Limits limits, const std::string& help) {
  add_number<int>(*app_, names, value, limits, help);
}

void Command::option(const std::string& names, double& value, Limits limits,
                     const std::string& help) {
  add_number<double>(*app_, names, value, limits, help);
}

void Command::option(const std::string& names, std::optional<int>& value, Limits limits,
                     const std::string& help) {
  add_number<int>(*app_, names, value, limits, help);
}

void Command::option(const std::string& names, std::optional<double>& value, Limits limits,
                     const std::string& help) {
  add_number<double>(*app_, names, value, limits, help);
}

void Command::choice(const std::string& names, std::string& value,
                     const std::vector<std::string>& choices, const std::string& help,
                     Presence presence) {
  require(app_->add_option(names, value, help), presence)->check(CLI::IsMember(choices));
}

void Command::list(const std::string& names, std::vector<std::string>& values,
                   const std::string& help) {
  app_->add_option(names, values, help)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(not_empty());
}

void Command::repeatable(const std::string& names, std::vector<std::string>& values,
                         const std::string& help, Presence presence) {
  require(app_->add_option(names, values, help + "; repeatable"), presence)
      ->allow_extra_args(false);
}

void Command::settings(const std::string& names, std::vector<std::string>& values, const char* kind,
                       const std::string& help) {
  repeatable(names, values, help);
  app_->get_option(names)->type_name(kind);
}

void Command::flag(const std::string& names, bool& value, const std::string& help) {
  app_->add_flag(names, value, help);
}

void Command::exclude(const std::string& name, const std::string& other) {
  app_->get_option(name)->excludes(app_->get_option(other));
}

void Command::footer(const std::string& text) { app_->footer(text); }

void Command::action(std::function<int()> run) {
  app_->callback([run = std::move(run), exit_code = exit_code_] { *exit_code = run(); });
}

Command Command::subcommand(const std::string& name, const std::string& summary) {
  app_->require_subcommand(1);
  return Command(*app_->add_subcommand(name, summary), *exit_code_);
}

const CLI::App& Command::program() const {
  const CLI::App* app = app_;
  while (app->get_parent() != nullptr) app = app->get_parent();
  return *app;
}

namespace {

int run_commands(const Program& program, int argc, char** argv) {
  const std::span<char*> words(argv, static_cast<std::size_t>(argc));
  for (const ExternalCommand& each : program.external) {
    if (argc > 1 && std::string(argv[1]) == each.name) return run_external(each, words.subspan(1));
  }
  int exit_code = kOk;
  CLI::App app(program.description, program.name);
  app.footer(program.footer);
  app.set_version_flag("--version", program.version);
  Command root(app, exit_code);
  for (const CommandEntry& each : program.commands) {
    each.declare(root.subcommand(each.name, each.summary), program.scenario_folder);
  }
  for (const ExternalCommand& each : program.external) {
    CLI::App* command = app.add_subcommand(each.name, each.summary);
    command->set_help_flag();                             // which its program has
    if (find_external(each).empty()) command->group("");  // hidden
  }
  if (const std::string wrong = unknown_command(app, words.subspan(1)); !wrong.empty()) {
    print_error(fmt::format("{}: {}", program.name, wrong));
    return kBadInput;
  }
  const int parsed = parse(app, argc, argv);
  return parsed == kOk ? exit_code : parsed;
}

}  // namespace

int run_program(const Program& program, int argc, char** argv) {
  // Beyond a limit of the size of files (ulimit -f) writing is then an error, not the end.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const int exit_code = run_commands(program, argc, argv);
    if (const auto finished = finish_output(); !finished) {
      print_error(fmt::format("{}: {}", program.name, finished.error().message));
      return exit_code == kOk ? kBadInput : exit_code;
    }
    return exit_code;
  } catch (const std::filesystem::filesystem_error& error) {
    // A path that cannot be followed, e.g. a loop of links or a name that is too long.
    print_error(
        fmt::format("{}: {}: {}", program.name, error.path1().string(), error.code().message()));
    return kBadInput;
  } catch (const std::bad_alloc&) {
    print_error(program.name + ": not enough memory (ulimit -v states the limit of this shell)");
    return kInternal;
  } catch (const std::exception& error) {
    print_error(fmt::format("{}: internal error: {}", program.name, error.what()));
    return kInternal;
  }
}

}  // namespace aims
