// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/scenario/catalogue.hpp"
#include "bench/scoring/json_text.hpp"
#include "cli/command.hpp"
#include "core/config.hpp"
#include "recordings/inspection/bag_check.hpp"
#include "recordings/inspection/bag_info.hpp"

namespace aims {

/// --json: one JSON document on standard output and nothing else. Its keys are in
/// docs/result-files.md.
void add_json(Command& command, bool& json);

/// Prints the document.
void print_json(const Json& json);

/// Prints the error as that of the command; with `json` also as a document {"error": ...}.
int refuse(const char* command, const Error& error, bool json);

/// What a command came to: its exit code and what --json prints.
struct Answer {
  int exit_code = 0;
  Json document;
};

/// Runs a command that prints text as it goes and returns its document. With `json` the text goes
/// to standard error, and the document, or {"error": ...}, alone to standard output.
int answer(const char* command, bool json, const std::function<Result<Answer>()>& run);

/// True when --json is among the words of a command line, whatever else is wrong with them.
bool wants_json(std::span<char* const> words);

/// What `aims list` shows; schema aims.list/1.
Json list_json(const std::filesystem::path& folder, std::span<const ListedScenario> files);

/// Parameters with value, documentation and whether they have an effect; schema aims.config/1.
Json config_json(const std::string& name, const Fields& fields);

/// What `aims info` shows; schema aims.info/1.
Json info_json(const BagInfo& info);

/// What `aims check` shows; schema aims.check/1.
Json check_json(const std::filesystem::path& bag, const std::vector<RequirementCheck>& checks);

}  // namespace aims
