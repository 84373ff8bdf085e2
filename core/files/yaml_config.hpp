// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
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

/// YAML files with their bases; each is parsed once, however often it is read.
class YamlFiles {
 public:
  /// A base that a file names alone is looked up beside the file, else in `named` and below.
  explicit YamlFiles(std::filesystem::path named = {});

  struct Parsed;
  Parsed& parsed() const { return *parsed_; }

 private:
  std::shared_ptr<Parsed> parsed_;
};

/// Reads a YAML file into a configuration; fields that the file does not name keep their values.
/// `base: other.yaml` (relative to the file) or `base: name` (as `YamlFiles` finds it) is read
/// first; a list replaces the base's list. Errors are one line,
/// `file:line:column: key: ...`; the configuration is then partly changed. The keys that were set
/// are appended to `assigned`.
Result<void> load_config(const std::filesystem::path& file, const CollectFields& collect,
                         std::vector<AssignedKey>* assigned = nullptr,
                         const YamlFiles& files = YamlFiles());

/// As `load_config`, from YAML text, which errors call `name` and which has no `base`.
Result<void> load_config_text(std::string_view text, const std::string& name,
                              const CollectFields& collect);

/// As `load_config` of these keys of the top level alone, whatever else the file and its bases
/// hold: what a listing needs of a file, at a fraction of the cost.
Result<void> load_keys(const std::filesystem::path& file, std::span<const std::string> keys,
                       const CollectFields& collect, const YamlFiles& files = YamlFiles());

/// As `load_config_text` of the group `group` ("a" or "a.b") of the text alone, whatever stands
/// outside of it.
Result<void> load_group_text(std::string_view text, const std::string& name,
                             const std::string& group, const CollectFields& collect);

/// Applies settings in order: "key=value", "list=[...]" in YAML's form, which replaces the list, or
/// "@FILE" for a YAML file as of `load_config`. Errors name the offending `--set`, or the file. The
/// keys that were set are appended to `assigned`.
Result<void> apply_overrides(const CollectFields& collect, std::span<const std::string> settings,
                             std::vector<AssignedKey>* assigned = nullptr,
                             const YamlFiles& files = YamlFiles());

/// The list of texts `key` of the top level after `load_config` and `apply_overrides`, whatever
/// else the file (empty: none) and the settings hold; nothing without that key.
Result<std::optional<std::vector<std::string>>> read_texts(const std::filesystem::path& file,
                                                           std::span<const std::string> settings,
                                                           const std::string& key,
                                                           const YamlFiles& files = YamlFiles());

/// `load_config` into any configuration that has a `describe`.
template <class Config>
requires requires(Fields& fields, Config& config) { describe(fields, config); }
Result<void> load_config(const std::filesystem::path& file, Config& config,
                         std::vector<AssignedKey>* assigned = nullptr,
                         const YamlFiles& files = YamlFiles()) {
  return load_config(file, collector_of(config), assigned, files);
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
                             const YamlFiles& files = YamlFiles()) {
  return apply_overrides(collector_of(config), settings, assigned, files);
}

}  // namespace aims
