// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"

namespace aims {

/// Collects the field list of a configuration afresh; called again after a list was resized.
using CollectFields = std::function<Fields()>;

/// How to collect the fields of `config`, which must outlive the result.
template <class Config>
CollectFields collector_of(Config& config) {
  return [&config] { return fields_of(config); };
}

/// Reads a YAML file into a configuration; fields that the file does not name keep their values.
/// `base: other.yaml` (relative to the file) or `base: name` (beside the file, else in the folder
/// `named` and below) is read first; a list replaces the base's list. Errors are one line,
/// `file:line:column: key: ...`; the configuration is then partly changed. The keys that were set
/// are appended to `assigned`.
Result<void> load_config(const std::filesystem::path& file, const CollectFields& collect,
                         std::vector<AssignedKey>* assigned = nullptr,
                         const std::filesystem::path& named = {});

/// As `load_config`, from YAML text, which errors call `name` and which has no `base`.
Result<void> load_config_text(std::string_view text, const std::string& name,
                              const CollectFields& collect);

/// As `load_config_text` of the group `group` ("a" or "a.b") of the text alone, whatever stands
/// outside of it.
Result<void> load_group_text(std::string_view text, const std::string& name,
                             const std::string& group, const CollectFields& collect);

/// Applies settings in order: "key=value", "list=[...]" in YAML's form, which replaces the list, or
/// "@FILE" for a YAML file as of `load_config`. Errors name the offending `--set`, or the file. The
/// keys that were set are appended to `assigned`.
Result<void> apply_overrides(const CollectFields& collect, std::span<const std::string> settings,
                             std::vector<AssignedKey>* assigned = nullptr,
                             const std::filesystem::path& named = {});

/// The list of texts `key` of the top level after `load_config` and `apply_overrides`, whatever
/// else the file (empty: none) and the settings hold; nothing without that key.
Result<std::optional<std::vector<std::string>>> read_texts(const std::filesystem::path& file,
                                                           std::span<const std::string> settings,
                                                           const std::string& key,
                                                           const std::filesystem::path& named = {});

/// `load_config` into any configuration that has a `describe`.
template <class Config>
requires requires(Fields& fields, Config& config) { describe(fields, config); }
Result<void> load_config(const std::filesystem::path& file, Config& config,
                         std::vector<AssignedKey>* assigned = nullptr,
                         const std::filesystem::path& named = {}) {
  return load_config(file, collector_of(config), assigned, named);
}

/// `load_config_text` into any configuration that has a `describe`.
template <class Config>
requires requires(Fields& fields, Config& config) { describe(fields, config); }
Result<void> load_config_text(std::string_view text, const std::string& name, Config& config) {
  return load_config_text(text, name, collector_of(config));
}

/// `apply_overrides` to any configuration that has a `describe`.
template <class Config>
requires requires(Fields& fields, Config& config) { describe(fields, config); }
Result<void> apply_overrides(Config& config, std::span<const std::string> settings,
                             std::vector<AssignedKey>* assigned = nullptr,
                             const std::filesystem::path& named = {}) {
  return apply_overrides(collector_of(config), settings, assigned, named);
}

}  // namespace aims
