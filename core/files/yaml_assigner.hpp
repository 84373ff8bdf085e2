// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/files/yaml_config.hpp"

namespace YAML {
class Node;
}  // namespace YAML

namespace aims {

/// Where settings go, and the list of those that were set (none: null).
struct SettingTarget {
  const CollectFields& collect;
  std::vector<AssignedKey>* assigned = nullptr;
  std::vector<std::string> only = {};  ///< the only keys of the top level that are set; none: any
};

/// Where settings come from.
struct SettingSource {
  std::string name;     ///< of the file, or "--set key=value"
  bool is_file = true;  ///< with lines and columns
};

/// Writes the settings of one YAML map or list into a configuration.
class YamlAssigner {
 public:
  YamlAssigner(SettingSource source, const SettingTarget& target);

  /// Assigns all entries of `map`, whose keys are below `prefix`; skips `base` at the top level.
  Result<void> assign_map(const YAML::Node& map, const std::string& prefix);

  /// Replaces the list by the entries of `value`, whose position errors name, or that of its key
  /// `name` where it is empty.
  Result<void> assign_list(const ListField& list, const YAML::Node& name, const YAML::Node& value);

 private:
  Result<void> assign_entry(const YAML::Node& name, const YAML::Node& value,
                            const std::string& key);
  Result<void> assign_value(const Parameter& parameter, const std::string& key,
                            const YAML::Node& name, const YAML::Node& value) const;
  Result<void> assign_item(const YAML::Node& name, const YAML::Node& item, const std::string& key);
  std::vector<Parameter> parameters_below(const std::string& key) const;
  bool is_group(const std::string& key) const;
  void note(const std::string& key, const YAML::Node& node);
  std::string where(const YAML::Node& node) const;
  Result<void> error(const YAML::Node& node, const std::string& key,
                     const std::string& message) const;

  SettingSource source_;
  SettingTarget target_;
  Fields fields_;
};

}  // namespace aims
