// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_config.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <utility>

#include "core/files/text_file.hpp"
#include "core/files/yaml_assigner.hpp"
#include "core/files/yaml_document.hpp"
#include "core/text.hpp"

namespace aims {

namespace fs = std::filesystem;

struct YamlFiles::Parsed {
  struct Document {
    std::string name;  ///< of its file
    YAML::Node node;
  };
  fs::path named;
  /// Of each file its bases, the first of all in front, and the file itself.
  std::map<fs::path, std::vector<Document>> files;
};

namespace {

/// What a document names as its base, and where.
struct BaseName {
  std::string given;
  std::string place;  ///< "file:line:column"
};

Result<std::optional<BaseName>> base_of(const YAML::Node& document, const std::string& name) {
  for (const auto& entry : document) {
    if (!entry.first.IsScalar() || entry.first.Scalar() != kBaseKey) continue;
    const std::string here =
        place(name, entry.second.IsNull() ? entry.first.Mark() : entry.second.Mark());
    if (!entry.second.IsScalar() || entry.second.Scalar().empty()) {
      return failure(
          fmt::format("{}: base: expected a scenario or the path of a YAML file, found {}", here,
                      kind_of(entry.second)));
    }
    return BaseName{entry.second.Scalar(), here};
  }
  return std::nullopt;
}

/// Appends the bases of `file` and the file itself; `chain` holds the files that are based on it.
Result<void> parse_file(const fs::path& file, const fs::path& named, std::vector<fs::path> chain,
                        std::vector<YamlFiles::Parsed::Document>& parsed) {
  const auto text = read_text_file(file, kLargestYaml);
  if (!text) return tl::unexpected(text.error());
  const auto document = parse_document(*text, file.string());
  if (!document) return tl::unexpected(document.error());
  const auto base = base_of(*document, file.string());
  if (!base) return tl::unexpected(base.error());
  if (*base) {
    const auto& [given, here] = **base;
    const auto found = find_base(file, given, named);
    if (!found) return failure(fmt::format("{}: {}", here, found.error().message));
    chain.push_back(fs::weakly_canonical(file));
    if (std::find(chain.begin(), chain.end(), fs::weakly_canonical(*found)) != chain.end()) {
      return failure(fmt::format("{}: base: '{}' is based on itself", here, found->string()));
    }
    if (auto based = parse_file(*found, named, chain, parsed); !based) return based;
  }
  parsed.push_back({file.string(), *document});
  return {};
}

/// The outcome of `load`, with exceptions as errors and every message on one line.
template <class Load>
Result<void> reported(const std::string& name, const Load& load) {
  std::string message;
  try {
    Result<void> loaded = load();
    if (loaded) return loaded;
    message = loaded.error().message;
  } catch (const std::exception& error) {
    message = fmt::format("{}: {}", name, error.what());
  }
  return failure(line_text(message));
}

/// Replaces a list by the value of a setting, which has YAML's form.
Result<void> set_list(const ListField& list, const std::string& setting, const std::string& value,
                      const SettingTarget& target) {
  const std::string name = "--set " + setting;
  return reported(name, [&]() -> Result<void> {
    const auto node = parse_value(value, name);
    if (!node) return tl::unexpected(node.error());
    return YamlAssigner({name, false}, target).assign_list(list, *node, *node);
  });
}

/// The dotted group `group` of a map within maps that hold nothing else; an empty map without it.
YAML::Node group_alone(const YAML::Node& map, const std::string& group) {
  YAML::Node alone(YAML::NodeType::Map);
  if (!map.IsMap()) return alone;
  const std::size_t dot = group.find('.');
  for (const auto& entry : map) {
    if (!entry.first.IsScalar() || entry.first.Scalar() != group.substr(0, dot)) continue;
    alone[entry.first] =
        dot == std::string::npos ? entry.second : group_alone(entry.second, group.substr(dot + 1));
  }
  return alone;
}

/// The list that a setting "list=[...]" replaces, or nullptr.
const ListField* named_list(const std::string& setting, const Fields& fields) {
  const std::string key = setting.substr(0, setting.find('='));
  const auto& lists = fields.lists();
  const auto found = std::find_if(lists.begin(), lists.end(),
                                  [&key](const ListField& each) { return each.key == key; });
  return found == lists.end() ? nullptr : &*found;
}

/// Applies "key=value".
Result<void> apply_setting(const std::string& setting, const Fields& fields,
                           const SettingTarget& target) {
  const auto equals = setting.find('=');
  if (equals == std::string::npos || equals == 0) {
    return failure(line_text(fmt::format("--set {}: expected key=value or @FILE", setting)));
  }
  const std::string key = setting.substr(0, equals);
  const std::string value = setting.substr(equals + 1);
  if (const ListField* list = named_list(setting, fields)) {
    return set_list(*list, setting, value, target);
  }
  const auto done = assign(fields, key, value);
  if (!done) {
    return failure(line_text(fmt::format("--set {}: {}", setting, done.error().message)));
  }
  if (target.assigned != nullptr) {
    target.assigned->push_back({key, fmt::format("--set {}: ", setting)});
  }
  return {};
}

Result<void> load_file(const fs::path& file, const SettingTarget& target,
                       YamlFiles::Parsed& parsed) {
  return reported(file.string(), [&]() -> Result<void> {
    auto found = parsed.files.find(file);
    if (found == parsed.files.end()) {
      std::vector<YamlFiles::Parsed::Document> documents;
      auto done = parse_file(file, parsed.named, {}, documents);
      if (!done) return done;
      found = parsed.files.emplace(file, std::move(documents)).first;
    }
    for (const YamlFiles::Parsed::Document& each : found->second) {
      auto assigned = YamlAssigner({each.name}, target).assign_map(each.node, "");
      if (!assigned) return assigned;
    }
    return {};
  });
}

}  // namespace

YamlFiles::YamlFiles(fs::path named) : parsed_(std::make_shared<Parsed>()) {
  parsed_->named = std::move(named);
}

Result<void> load_config(const fs::path& file, const CollectFields& collect,
                         std::vector<AssignedKey>* assigned, const YamlFiles& files) {
  return load_file(file, {collect, assigned}, files.parsed());
}

Result<void> load_keys(const fs::path& file, std::span<const std::string> keys,
                       const CollectFields& collect, const YamlFiles& files) {
  return load_file(file, {collect, nullptr, {keys.begin(), keys.end()}}, files.parsed());
}

Result<void> load_config_text(std::string_view text, const std::string& name,
                              const CollectFields& collect) {
  return reported(name, [&]() -> Result<void> {
    const auto document = parse_document(std::string(text), name);
    if (!document) return tl::unexpected(document.error());
    const auto base = base_of(*document, name);
    if (!base) return tl::unexpected(base.error());
    if (*base) {
      return failure((*base)->place + ": base: expected none; only a file may name another");
    }
    return YamlAssigner({name}, {collect}).assign_map(*document, "");
  });
}

Result<void> load_group_text(std::string_view text, const std::string& name,
                             const std::string& group, const CollectFields& collect) {
  return reported(name, [&]() -> Result<void> {
    const auto document = parse_document(std::string(text), name);
    if (!document) return tl::unexpected(document.error());
    const YAML::Node alone = group_alone(*document, group);
    return YamlAssigner({name}, {collect}).assign_map(alone, "");
  });
}

Result<std::optional<std::vector<std::string>>> read_texts(const fs::path& file,
                                                           std::span<const std::string> settings,
                                                           const std::string& key,
                                                           const YamlFiles& files) {
  std::vector<std::string> texts;
  std::vector<AssignedKey> assigned;
  const CollectFields collect = [&] {
    Fields fields;
    fields.texts(key, texts, {});
    return fields;
  };
  const SettingTarget target = {collect, &assigned, {key}};
  const auto read = [&](const fs::path& from) { return load_file(from, target, files.parsed()); };
  Result<void> done;
  if (!file.empty()) done = read(file);
  for (const std::string& setting : settings) {
    if (done && setting.starts_with('@')) done = read(setting.substr(1));
    if (done && setting.starts_with(key + "=")) done = apply_setting(setting, collect(), target);
  }
  if (!done) return tl::unexpected(done.error());
  if (assigned.empty()) return std::nullopt;
  return texts;
}

Result<void> apply_overrides(const CollectFields& collect, std::span<const std::string> settings,
                             std::vector<AssignedKey>* assigned, const YamlFiles& files) {
  const SettingTarget target = {collect, assigned};
  Fields fields = collect();
  for (const std::string& setting : settings) {
    auto applied = setting.starts_with('@') ? load_file(setting.substr(1), target, files.parsed())
                                            : apply_setting(setting, fields, target);
    if (!applied) return applied;
    if (setting.starts_with('@') || named_list(setting, fields) != nullptr) {
      fields = collect();
    }
  }
  return {};
}

}  // namespace aims
