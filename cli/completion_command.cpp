// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "bench/scenario/catalogue.hpp"
#include "bench/scenario/scenario.hpp"
#include "cli/command.hpp"
#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Values that a script asks the program for, and a word for options without a value.
constexpr const char* kScenarios = "@scenarios";
constexpr const char* kEstimators = "@estimators";
constexpr const char* kKeys = "@keys";
constexpr const char* kFlag = "@flag";

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

/// What may follow the option: words, or one of the names above; empty: a file or any text.
std::string values_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return kFlag;
  const std::string type = option.get_type_name();  // of a choice "TEXT:{none,lz4}"
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}');
  if (open < close && close != std::string::npos) {
    std::string words = type.substr(open + 1, close - open - 1);
    std::replace(words.begin(), words.end(), ',', ' ');
    return words;
  }
  const std::string name = option.get_single_name();
  if (name == "scenario" || name == "scenarios" || name == "source") return kScenarios;
  if (type == kScenarioSetting) return kKeys;
  if (name == "estimators" || name == "estimator" || name == "baselines") return kEstimators;
  return "";
}

/// The bodies of three `case "$1" in` of a shell, in which $1 is a command, "" or "study compare".
struct Cases {
  std::string words;    ///< commands below the command, or values of its arguments
  std::string options;  ///< its options
  std::string values;   ///< "command option": what may follow the option
};

std::string branch(const std::string& patterns, const std::string& words) {
  return fmt::format("    {}) echo \"{}\" ;;\n", patterns, words);
}

void add_option(const CLI::Option& option, const std::string& path, std::string& words,
                std::string& options, Cases& cases) {
  const std::string values = values_of(option);
  const std::vector<std::string> names = names_of(option);
  if (names.empty()) {
    if (!values.empty()) words += (words.empty() ? "" : " ") + values;
    return;
  }
  std::string patterns;
  for (const std::string& name : names) {
    patterns += fmt::format("{}\"{} {}\"", patterns.empty() ? "" : "|", path, name);
  }
  const std::vector<std::string>& long_names = option.get_lnames();
  options += (options.empty() ? "" : " ") +
             (long_names.empty() ? names.front() : "--" + long_names.front());
  if (!values.empty()) cases.values += branch(patterns, values);
}

void add_command(const CLI::App& command, const std::string& path, Cases& cases) {
  std::string words;
  std::string options;
  for (const CLI::Option* each : command.get_options()) {
    add_option(*each, path, words, options, cases);
  }
  const auto below = command.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* each : below) words += (words.empty() ? "" : " ") + each->get_name();
  if (!words.empty()) cases.words += branch(fmt::format("\"{}\"", path), words);
  if (!options.empty()) cases.options += branch(fmt::format("\"{}\"", path), options);
  for (const CLI::App* each : below) {
    const std::string name = each->get_name();
    if (each->get_help_ptr() == nullptr) {  // a program of its own
      cases.options += fmt::format("    \"{0}\") _aims_options_of \"$2\" {0} ;;\n", name);
      continue;
    }
    add_command(*each, path.empty() ? name : path + " " + name, cases);
  }
}

/// Shell functions that hold what the program declares, in words that bash and zsh share.
std::string declared(const CLI::App& program) {
  Cases cases;
  add_command(program, "", cases);
  return fmt::format(
      "_aims_words() {{\n  case \"$1\" in\n{}  esac\n}}\n\n"
      "_aims_options() {{\n  case \"$1\" in\n{}  esac\n}}\n\n"
      "_aims_values() {{\n  case \"$1 $2\" in\n{}  esac\n}}\n\n"
      "# Options of a command that is a program of its own.\n"
      "_aims_options_of() {{\n"
      "  \"$1\" \"$2\" --help 2>/dev/null | grep -oE -- '--[a-z][a-z_-]*' | sort -u\n"
      "}}\n\n"
      "# Words as they are, or names that the program knows.\n"
      "_aims_names() {{\n"
      "  case \"$2\" in\n"
      "    \"@flag\") ;;\n"
      "    \"@\"*) \"$1\" completion \"${{2#@}}\" 2>/dev/null ;;\n"
      "    *) echo \"$2\" ;;\n"
      "  esac\n"
      "}}\n\n",
      cases.words, cases.options, cases.values);
}

constexpr const char* kBashFunction = R"sh(_aims() {
  local program="$1" cur="${COMP_WORDS[COMP_CWORD]}" path="" previous="" word below kind names
  local -a before=("${COMP_WORDS[@]:1:COMP_CWORD-1}")
  [[ $cur == "=" ]] && cur=""
  for word in "${before[@]}"; do
    below=" $(_aims_words "$path") "
    [[ $below == *" $word "* && $below != *"@"* ]] && path="${path:+$path }$word"
    [[ $word != "=" ]] && previous="$word"
  done
  kind=""
  [[ $previous == -* ]] && kind="$(_aims_values "$path" "$previous")"
  if [[ $previous == -* && $kind != "@flag" ]]; then
    names="$(_aims_names "$program" "$kind")"
  elif [[ $cur == -* ]]; then
    names="$(_aims_options "$path" "$program")"
  else
    names="$(_aims_names "$program" "$(_aims_words "$path")")"
  fi
  word=""
  [[ $cur == *,* ]] && word="${cur%,*},"
  COMPREPLY=($(compgen -P "$word" -W "$names" -- "${cur##*,}"))
  [[ $kind == "@keys" ]] && compopt -o nospace 2>/dev/null
  return 0
}

complete -o default -F _aims aims
)sh";

constexpr const char* kZshFunction = R"sh(_aims() {
  local program="${words[1]}" cur="${words[CURRENT]}" at_path="" previous="" word below kind names
  local -a before
  before=("${(@)words[2,CURRENT-1]}")
  for word in "${before[@]}"; do
    below=" $(_aims_words "$at_path") "
    [[ $below == *" $word "* && $below != *"@"* ]] && at_path="${at_path:+$at_path }$word"
    previous="$word"
  done
  if [[ $cur == --*=* ]]; then
    previous="${cur%%=*}"
    compset -P '*='
  fi
  kind=""
  [[ $previous == -* ]] && kind="$(_aims_values "$at_path" "$previous")"
  if [[ $previous == -* && $kind != "@flag" ]]; then
    names="$(_aims_names "$program" "$kind")"
  elif [[ $cur == -* ]]; then
    names="$(_aims_options "$at_path" "$program")"
  else
    names="$(_aims_names "$program" "$(_aims_words "$at_path")")"
  fi
  compset -P '*,'
  local -a no_space
  [[ $kind == "@keys" ]] && no_space=(-S "")
  [[ -n $names ]] && compadd $no_space -- ${=names}
  [[ -z $names || $names == *$'\n'* ]] && _files
  return 0
}

_aims "$@"
)sh";

/// A script that lets bash complete the commands of `program`, their options and the values of
/// these. What it knows comes from the declarations; names of scenarios and estimators it asks the
/// program for (`aims completion scenarios`).
std::string bash_completion(const CLI::App& program) {
  return "# bash completion of aims, written by `aims completion bash`\n\n" + declared(program) +
         kBashFunction;
}

/// The same for zsh, the text of a file `_aims` in a folder of `fpath`.
std::string zsh_completion(const CLI::App& program) {
  return "#compdef aims\n# zsh completion of aims, written by `aims completion zsh`\n\n" +
         declared(program) + kZshFunction;
}

int print_scenarios(const fs::path& folder) {
  const auto files = scenario_files(folder);
  if (!files) return bad_input("completion", files.error());
  for (const fs::path& file : *files) print_out("{}\n", file.stem().string());
  return kOk;
}

int print_estimators() {
  for (const CatalogueEntry& each : estimator_catalogue()) print_out("{}\n", each.name);
  return kOk;
}

/// What --set takes: "lidar.range_sigma=".
int print_keys() {
  Scenario scenario;
  for (const Parameter& each : fields_of(scenario).parameters()) print_out("{}=\n", each.key);
  return kOk;
}

}  // namespace

void declare_completion(Command command, const fs::path& scenarios) {
  auto what = std::make_shared<std::string>();
  command.choice("what", *what, {"bash", "zsh", "scenarios", "estimators", "keys"},
                 "The script of a shell, or the names that it asks for", Presence::kRequired);
  command.footer(
      "Installed packages have the scripts in place. Elsewhere:\n"
      "  source <(aims completion bash)\n"
      "  aims completion zsh > ~/.zfunc/_aims    # a folder of fpath");
  command.action([what, command, scenarios] {
    if (*what == "scenarios") return print_scenarios(scenarios);
    if (*what == "estimators") return print_estimators();
    if (*what == "keys") return print_keys();
    const CLI::App& program = command.program();
    print_out("{}", *what == "bash" ? bash_completion(program) : zsh_completion(program));
    return static_cast<int>(kOk);
  });
}

}  // namespace aims
