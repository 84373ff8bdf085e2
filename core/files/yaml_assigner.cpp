// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_assigner.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "core/files/yaml_document.hpp"

namespace aims {
namespace {

/// The scalar itself, or "[a, b]" of a sequence of scalars, where `rows` also of a list of such;
/// nothing for anything deeper.
std::optional<std::string> flow_text(const YAML::Node& value, bool rows = false) {
  if (value.IsScalar()) return value.Scalar();
  std::vector<std::string> entries;
  for (const auto& entry : value) {
    if (rows && entry.IsSequence()) {
      for (const auto& number : entry) {
        if (!number.IsScalar()) return std::nullopt;
        entries.push_back(number.Scalar());
      }
      continue;
    }
    if (!entry.IsScalar()) return std::nullopt;
    entries.push_back(entry.Scalar());
  }
  return sequence_text(entries);
}

std::string shown(const YAML::Node& value) {
  const auto text = value.IsSequence() ? flow_text(value) : std::nullopt;
  return text ? *text : kind_of(value);
}

/// The node whose position an error names: the value, or its key if the value is empty.
YAML::Node at(const YAML::Node& name, const YAML::Node& value) {
  return value.Mark().is_null() || value.IsNull() ? name : value;
}

}  // namespace

YamlAssigner::YamlAssigner(SettingSource source, const SettingTarget& target)
    : source_(std::move(source)), target_(target), fields_(target.collect()) {}

Result<void> YamlAssigner::assign_map(const YAML::Node& map, const std::string& prefix) {
  std::vector<std::string> seen;
  for (const auto& entry : map) {
    if (!entry.first.IsScalar()) {
      return error(entry.first, prefix.empty() ? "top level" : prefix,
                   "expected a name as key, found " + kind_of(entry.first));
    }
    const std::string name = entry.first.Scalar();
    const std::string key = prefix.empty() ? name : prefix + "." + name;
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
      return error(entry.first, key, "duplicate key; expected each key once");
    }
    seen.push_back(name);
    if (prefix.empty() && name == kBaseKey) continue;
    const auto& only = target_.only;
    const bool skipped = !only.empty() && std::find(only.begin(), only.end(), name) == only.end();
    if (prefix.empty() && skipped) continue;
    if (auto assigned = assign_entry(entry.first, entry.second, key); !assigned) return assigned;
  }
  return {};
}

Result<void> YamlAssigner::assign_list(const ListField& list, const YAML::Node& name,
                                       const YAML::Node& value) {
  const std::string key = list.key;
  if (!value.IsSequence()) {
    return error(at(name, value), key, "expected a list of maps, found " + kind_of(value));
  }
  list.resize(0);
  list.resize(value.size());
  fields_ = target_.collect();
  for (std::size_t i = 0; i < value.size(); ++i) {
    auto assigned = assign_item(name, value[i], fmt::format("{}.{}", key, i));
    if (!assigned) return assigned;
  }
  return {};
}

Result<void> YamlAssigner::assign_entry(const YAML::Node& name, const YAML::Node& value,
                                        const std::string& key) {
  if (name.Scalar().find('.') != std::string::npos) {
    return error(name, key, "expected nested maps, not a dotted key");
  }
  const std::vector<const Parameter*> parameters = fields_.matching(key);
  for (const Parameter* parameter : parameters) {
    if (auto done = assign_value(*parameter, key, name, value); !done) return done;
  }
  if (!parameters.empty()) {
    note(key, name);
    return {};
  }
  const auto& lists = fields_.lists();
  const auto list = std::find_if(lists.begin(), lists.end(),
                                 [&key](const ListField& each) { return each.key == key; });
  if (list != lists.end()) return assign_list(*list, name, value);
  if (!is_group(key)) {
    return failure(fmt::format("{}: {}", where(name), unknown_key_message(fields_, key)));
  }
  if (!value.IsMap()) return error(at(name, value), key, "expected a map, found " + kind_of(value));
  return assign_map(value, key);
}

Result<void> YamlAssigner::assign_value(const Parameter& parameter, const std::string& key,
                                        const YAML::Node& name, const YAML::Node& value) const {
  const auto refuse = [&] {
    return error(at(name, value), key,
                 fmt::format("expected {}, found {}{}", parameter.expected, shown(value),
                             option_proposal(parameter, shown(value))));
  };
  if (is_sequence(parameter) != value.IsSequence()) return refuse();
  if (!value.IsSequence() && !value.IsScalar()) return refuse();
  const auto text = flow_text(value, parameter.kind == ParameterKind::kNumbers);
  if (!text || !parameter.assign(*text)) return refuse();
  return {};
}

/// One entry of a list: a map, or all its values in the order of description.
Result<void> YamlAssigner::assign_item(const YAML::Node& name, const YAML::Node& item,
                                       const std::string& key) {
  if (item.IsMap()) return assign_map(item, key);
  const std::vector<Parameter> values = parameters_below(key);
  std::string names;
  for (const Parameter& each : values) names += ", " + each.key.substr(key.size() + 1);
  const std::string expected =
      fmt::format("expected a map or a list [{}]", names.empty() ? names : names.substr(2));
  if (!item.IsSequence()) {
    return error(at(name, item), key, fmt::format("{}, found {}", expected, kind_of(item)));
  }
  if (item.size() != values.size()) {
    return error(at(name, item), key, fmt::format("{}, found {} values", expected, item.size()));
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    auto assigned = assign_value(values[i], values[i].key, item, item[i]);
    if (!assigned) return assigned;
    note(values[i].key, item[i]);
  }
  return {};
}

/// The parameters of the group `key`.
std::vector<Parameter> YamlAssigner::parameters_below(const std::string& key) const {
  std::vector<Parameter> below;
  for (const Parameter& each : fields_.parameters()) {
    if (each.key.starts_with(key + ".")) below.push_back(each);
  }
  return below;
}

bool YamlAssigner::is_group(const std::string& key) const {
  const auto inside = [&key](const auto& each) { return key_matches(key, each.key, true); };
  return std::any_of(fields_.parameters().begin(), fields_.parameters().end(), inside) ||
         std::any_of(fields_.lists().begin(), fields_.lists().end(), inside);
}

/// Remembers that the key was set.
void YamlAssigner::note(const std::string& key, const YAML::Node& node) {
  if (target_.assigned == nullptr) return;
  target_.assigned->push_back({key, where(node) + ": ", source_.is_file});
}

std::string YamlAssigner::where(const YAML::Node& node) const {
  return source_.is_file ? place(source_.name, node.Mark()) : source_.name;
}

Result<void> YamlAssigner::error(const YAML::Node& node, const std::string& key,
                                 const std::string& message) const {
  return failure(fmt::format("{}: {}: {}", where(node), key, message));
}

}  // namespace aims
