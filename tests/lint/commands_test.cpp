// SPDX-License-Identifier: BSD-3-Clause
// Holds the command lines of documents against the help of the `aims` program.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/lint/documents.hpp"

namespace aims::lint {
namespace {

/// What `aims ARGUMENTS` prints, in the source folder.
std::string output_of(const std::string& arguments) {
  const std::string command =
      "cd '" AIMS_SOURCE_DIR "' && '" AIMS_PROGRAM "' " + arguments + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string output;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.append(buffer.data(), count);
  }
  pclose(pipe);
  return output;
}

/// The names below "Subcommands:" in a help text.
std::vector<std::string> subcommands(const std::string& help) {
  std::vector<std::string> names;
  const std::regex entry("^  ([a-z][a-z-]*) .*");
  bool inside = false;
  std::istringstream stream(help);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (line.starts_with("Subcommands:")) {
      inside = true;
    } else if (inside && std::regex_match(line, match, entry)) {
      names.push_back(match[1]);
    } else if (!line.starts_with("  ")) {
      inside = false;
    }
  }
  return names;
}

/// Help text by command, "" for the program itself, "study ablation" for nested ones.
const std::map<std::string, std::string>& help_by_command() {
  static const std::map<std::string, std::string> all = [] {
    std::map<std::string, std::string> texts{{"", output_of("--help")}};
    std::vector<std::string> open{""};
    while (!open.empty()) {
      const std::string parent = open.back();
      open.pop_back();
      for (const std::string& name : subcommands(texts.at(parent))) {
        const std::string command = parent.empty() ? name : parent + " " + name;
        texts[command] = output_of(command + " --help");
        open.push_back(command);
      }
    }
    return texts;
  }();
  return all;
}

/// The words of a command line up to a pipe, a comment or the next command.
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) {
    if (word == "|" || word == "&&" || word == ";" || word == "&" || word.starts_with("#")) break;
    const bool last = word.ends_with(";");
    words.push_back(last ? word.substr(0, word.size() - 1) : word);
    if (last) break;
  }
  return words;
}

/// Lines of a document with shell continuations joined.
std::vector<Line> joined_lines(const std::filesystem::path& document) {
  std::vector<Line> joined;
  bool open = false;
  for (const Line& line : read_lines(document)) {
    if (open) {
      joined.back().text += line.text;
    } else {
      joined.push_back(line);
    }
    open = joined.back().text.ends_with("\\");
    if (open) joined.back().text.pop_back();
  }
  return joined;
}

/// Every `aims ...` command line of the documents: in code blocks and in code spans.
std::vector<Line> command_lines() {
  std::vector<Line> commands;
  const std::regex start("(?:^|[ ;`(])(?:build/release/)?aims +(?=[a-z-])");
  const std::regex span("`([^`]*)`");
  for (const std::filesystem::path& document : documents()) {
    bool block = false;
    for (const Line& line : joined_lines(document)) {
      if (line.text.starts_with("```")) {
        block = !block;
        continue;
      }
      std::vector<std::string> texts;
      if (block || line.text.starts_with("    ")) texts.push_back(line.text);
      for (auto it = std::sregex_iterator(line.text.begin(), line.text.end(), span);
           !block && it != std::sregex_iterator(); ++it) {
        if ((*it)[1].str().find("aims ") != std::string::npos) texts.push_back((*it)[1]);
      }
      for (const std::string& text : texts) {
        for (auto it = std::sregex_iterator(text.begin(), text.end(), start);
             it != std::sregex_iterator(); ++it) {
          const auto begin = static_cast<std::size_t>(it->position() + it->length());
          commands.push_back({line.source, line.number, text.substr(begin)});
        }
      }
    }
  }
  return commands;
}

/// Splits `words` into the command and its arguments: "study ablation", then the rest.
std::string take_command(std::vector<std::string>& words) {
  std::string command;
  while (!words.empty()) {
    const std::string next = command.empty() ? words.front() : command + " " + words.front();
    if (!help_by_command().contains(next)) break;
    command = next;
    words.erase(words.begin());
  }
  return command;
}

/// Dotted keys of `aims config corridor`.
/// Keys of a scenario, those of an estimator also relative to it. Only settings that have an effect
/// are printed: one of our own estimators has all parts, of LINS one preset closes loops.
std::set<std::string> configuration_keys() {
  std::set<std::string> keys;
  std::vector<std::pair<std::size_t, std::string>> open;
  const std::regex entry("^( *)(?:- )?([a-zA-Z_0-9]+):.*");
  const std::regex relative("estimators\\.[a-z_0-9]+\\.(.*)");
  std::istringstream stream(output_of(
      "config corridor --set 'run=[aims, aims_d, tfs, tfs_clean, tfs_plus, lio, leg, "
      "fast_lio2, leg_kilo, lego_loam, lins, lins_published, lio_sam, loam, x_icp, dcreg, bievr, "
      "all=aims_d+degeneracy.enabled=true]'"));
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, entry)) continue;
    const auto depth = static_cast<std::size_t>(match.length(1));
    while (!open.empty() && open.back().first >= depth) open.pop_back();
    const std::string key =
        open.empty() ? match[2].str() : open.back().second + "." + match[2].str();
    keys.insert(key);
    std::smatch below;
    if (std::regex_match(key, below, relative)) keys.insert(below[1]);
    open.emplace_back(depth, key);
  }
  return keys;
}

TEST(ProgramHelp, ListsItsCommands) {
  for (const char* command : {"run", "suite", "sweep", "tune", "estimate", "score", "config"}) {
    EXPECT_TRUE(help_by_command().contains(command)) << command;
  }
}

TEST(ShippedScenarios, AllLoad) {
  const std::vector<Line> lines = split_lines("aims list", output_of("list"));
  EXPECT_GT(lines.size(), 100U);
  for (const Line& line : lines) {
    EXPECT_EQ(line.text.find("does not load"), std::string::npos) << line.text;
  }
}

/// Commands that another package installs: without it the help does not list them.
const std::set<std::string> kExternal = {"live", "play", "watch"};

TEST(DocumentedCommands, NameCommandsAndOptionsOfTheProgram) {
  const std::regex option("(--?[a-zA-Z][a-z-]*).*");
  const std::vector<Line> lines = command_lines();
  EXPECT_GT(lines.size(), 20u);
  for (const Line& line : lines) {
    std::vector<std::string> words = words_of(line.text);
    const std::string command = take_command(words);
    if (command.empty() && !words.empty() && kExternal.contains(words.front())) continue;
    EXPECT_TRUE(!command.empty() || words.empty() || words.front().starts_with("-"))
        << place(line) << ": the program has no command \"" << words.front() << "\"";
    const std::string& help = help_by_command().at(command);
    for (const std::string& word : words) {
      std::smatch match;
      if (!std::regex_match(word, match, option)) continue;
      const std::regex whole("(^|[\\s,])" + match[1].str() + "($|[\\s,=])");
      EXPECT_TRUE(std::regex_search(help, whole))
          << place(line) << ": aims " << command << " has no option " << match[1];
    }
  }
}

TEST(DocumentedCommands, SetKeysOfTheConfiguration) {
  const std::set<std::string> keys = configuration_keys();
  EXPECT_TRUE(keys.contains("estimators.aims.degeneracy.eta"));
  const std::regex assignment(R"((?:^|[ '"+])([a-z_]+(?:\.[a-z_0-9]+)+)=)");
  const std::regex entry_of_list(R"(\.[0-9]+\..*)");  // its list is a key
  for (const Line& line : command_lines()) {
    for (auto it = std::sregex_iterator(line.text.begin(), line.text.end(), assignment);
         it != std::sregex_iterator(); ++it) {
      const std::string key = (*it)[1];
      if (key.starts_with("recording.")) continue;  // of bags, in no scenario
      EXPECT_TRUE(keys.contains(std::regex_replace(key, entry_of_list, "")))
          << place(line) << ": no key " << key;
    }
  }
}

/// Scores of the run itself, whose first name is also a group of the configuration.
const std::set<std::string> kRunScores = {"robot.fell", "robot.end", "robot.valid",
                                          "robot.invalid_reason", "robot.wall_contact_fraction"};

/// Counts of LIO-SAM, whose first name is also a group of LOAM's configuration.
const std::set<std::string> kCounts = {"odometry.speed", "odometry.bias"};

TEST(DocumentedKeys, AreKeysOfTheConfiguration) {
  const std::set<std::string> keys = configuration_keys();
  std::set<std::string> groups;  // first names of keys
  for (const std::string& key : keys) {
    if (const std::size_t dot = key.find('.'); dot != std::string::npos) {
      groups.insert(key.substr(0, dot));
    }
  }
  const std::regex span("`([a-z_]+)((?:\\.[a-z_0-9]+)+)`");
  for (const std::filesystem::path& document : documents()) {
    for (const Line& line : read_lines(document)) {
      for (auto it = std::sregex_iterator(line.text.begin(), line.text.end(), span);
           it != std::sregex_iterator(); ++it) {
        if (!groups.contains((*it)[1])) continue;
        const std::string name = (*it)[1].str() + (*it)[2].str();
        if (name.ends_with(".csv") || name.ends_with(".json") || name.ends_with(".png")) continue;
        if (kRunScores.contains(name) || kCounts.contains(name)) continue;
        EXPECT_TRUE(keys.contains(name)) << place(line) << ": no key " << name;
      }
    }
  }
}

}  // namespace
}  // namespace aims::lint
