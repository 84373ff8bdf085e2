// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_config.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/files/atomic_file.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBaseKey = "base";

/// "file:line:column" of a mark; the file alone when the parser left no mark.
std::string place(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return file;
  return fmt::format("{}:{}:{}", file, mark.line + 1, mark.column + 1);
}

/// The text with a space in place of every control character.
std::string one_line(std::string text) {
  const auto is_control = [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; };
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

std::string kind_of(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  if (node.IsNull()) return "nothing";
  return fmt::format("'{}'", node.Scalar());
}

/// The one document of a text, which must be a map.
Result<YAML::Node> parse_document(const std::string& text, const std::string& file) {
  std::vector<YAML::Node> documents;
  try {
    documents = YAML::LoadAll(text);
  } catch (const YAML::Exception& error) {
    return failure(fmt::format("{}: not valid YAML: {}", place(file, error.mark), error.msg));
  } catch (const std::exception& error) {
    return failure(fmt::format("{}: not valid YAML: {}", file, error.what()));
  }
  if (documents.empty() || documents.front().IsNull()) {
    return failure(fmt::format("{}: expected a map of settings, the file is empty", file));
  }
  if (documents.size() > 1) {
    return failure(fmt::format("{}: expected one YAML document, found {}",
                               place(file, documents[1].Mark()), documents.size()));
  }
  if (!documents.front().IsMap()) {
    return failure(fmt::format("{}: expected a map of settings, found {}",
                               place(file, documents.front().Mark()), kind_of(documents.front())));
  }
  return documents.front();
}

/// Where settings go, and the list of those that were set (none: null).
struct Target {
  const CollectFields& collect;
  std::vector<AssignedKey>* assigned;
};

/// Writes the settings of one YAML map into a configuration.
class Assigner {
 public:
  Assigner(std::string file, const Target& target)
      : file_(std::move(file)), target_(target), fields_(target.collect()) {}

  /// Assigns all entries of `map`, whose keys are below `prefix`; skips `base` at the top level.
  Result<void> assign_map(const YAML::Node& map, const std::string& prefix) {
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
      if (auto assigned = assign_entry(entry.first, entry.second, key); !assigned) return assigned;
    }
    return {};
  }

 private:
  Result<void> assign_entry(const YAML::Node& name, const YAML::Node& value,
                            const std::string& key) {
    if (name.Scalar().find('.') != std::string::npos) {
      return error(name, key, "expected nested maps, not a dotted key");
    }
    const std::vector<const Parameter*> parameters = fields_.matching(key);
    for (const Parameter* parameter : parameters) {
      if (auto done = assign_value(*parameter, key, name, value); !done) return done;
    }
    if (!parameters.empty()) {
      if (target_.assigned != nullptr) {
        target_.assigned->push_back({key, place(file_, name.Mark()) + ": ", true});
      }
      return {};
    }
    const auto& lists = fields_.lists();
    const auto list = std::find_if(lists.begin(), lists.end(),
                                   [&key](const ListField& each) { return each.key == key; });
    if (list != lists.end()) return assign_list(*list, name, value);
    if (!is_group(key)) {
      return failure(
          fmt::format("{}: {}", place(file_, name.Mark()), unknown_key_message(fields_, key)));
    }
    if (!value.IsMap())
      return error(at(name, value), key, "expected a map, found " + kind_of(value));
    return assign_map(value, key);
  }

  Result<void> assign_value(const Parameter& parameter, const std::string& key,
                            const YAML::Node& name, const YAML::Node& value) {
    const auto refuse = [&] {
      return error(at(name, value), key,
                   fmt::format("expected {}, found {}", parameter.expected, shown(value)));
    };
    if (parameter.sequence != value.IsSequence()) return refuse();
    if (!value.IsSequence() && !value.IsScalar()) return refuse();
    const auto text = flow_text(value);
    if (!text || !parameter.assign(*text)) return refuse();
    return {};
  }

  Result<void> assign_list(const ListField& list, const YAML::Node& name, const YAML::Node& value) {
    const std::string key = list.key;
    if (!value.IsSequence()) {
      return error(at(name, value), key, "expected a list of maps, found " + kind_of(value));
    }
    list.resize(0);
    list.resize(value.size());
    fields_ = target_.collect();
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string item_key = fmt::format("{}.{}", key, i);
      if (!value[i].IsMap()) {
        return error(at(name, value[i]), item_key, "expected a map, found " + kind_of(value[i]));
      }
      if (auto assigned = assign_map(value[i], item_key); !assigned) return assigned;
    }
    return {};
  }

  bool is_group(const std::string& key) const {
    const auto inside = [&key](const auto& each) { return key_matches(key, each.key, true); };
    return std::any_of(fields_.parameters().begin(), fields_.parameters().end(), inside) ||
           std::any_of(fields_.lists().begin(), fields_.lists().end(), inside);
  }

  /// The scalar itself, or "[a, b]" of a sequence of scalars; nothing for anything deeper.
  static std::optional<std::string> flow_text(const YAML::Node& value) {
    if (value.IsScalar()) return value.Scalar();
    std::vector<std::string> entries;
    for (const auto& entry : value) {
      if (!entry.IsScalar()) return std::nullopt;
      entries.push_back(entry.Scalar());
    }
    return sequence_text(entries);
  }

  static std::string shown(const YAML::Node& value) {
    const auto text = value.IsSequence() ? flow_text(value) : std::nullopt;
    return text ? *text : kind_of(value);
  }

  /// The node whose position an error names: the value, or its key if the value is empty.
  static YAML::Node at(const YAML::Node& name, const YAML::Node& value) {
    return value.Mark().is_null() || value.IsNull() ? name : value;
  }

  Result<void> error(const YAML::Node& node, const std::string& key,
                     const std::string& message) const {
    return failure(fmt::format("{}: {}: {}", place(file_, node.Mark()), key, message));
  }

  std::string file_;
  Target target_;
  Fields fields_;
};

Result<void> load_file(const fs::path& file, const Target& target, std::vector<fs::path> chain);

/// Loads the document's `base`, if any.
Result<void> load_base(const YAML::Node& document, const std::string& name,
                       const Target& target, const std::vector<fs::path>& chain) {
  for (const auto& entry : document) {
    if (!entry.first.IsScalar() || entry.first.Scalar() != kBaseKey) continue;
    const std::string here =
        place(name, entry.second.IsNull() ? entry.first.Mark() : entry.second.Mark());
    if (!entry.second.IsScalar() || entry.second.Scalar().empty()) {
      return failure(fmt::format("{}: base: expected the path of a YAML file, found {}", here,
                                 kind_of(entry.second)));
    }
    const fs::path base = fs::path(name).parent_path() / entry.second.Scalar();
    const fs::path canonical = fs::weakly_canonical(base);
    if (std::find(chain.begin(), chain.end(), canonical) != chain.end()) {
      return failure(fmt::format("{}: base: '{}' is based on itself", here, base.string()));
    }
    std::error_code ignored;
    if (!fs::exists(base, ignored)) {
      return failure(fmt::format("{}: base: no such file '{}'", here, base.string()));
    }
    return load_file(base, target, chain);
  }
  return {};
}

Result<void> load_document(const std::string& text, const std::string& name,
                           const Target& target, const std::vector<fs::path>& chain) {
  const auto document = parse_document(text, name);
  if (!document) return tl::unexpected(document.error());
  if (auto based = load_base(*document, name, target, chain); !based) return based;
  return Assigner(name, target).assign_map(*document, "");
}

Result<void> load_file(const fs::path& file, const Target& target, std::vector<fs::path> chain) {
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  chain.push_back(fs::weakly_canonical(file));
  return load_document(*text, file.string(), target, chain);
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
  return failure(one_line(std::move(message)));
}

}  // namespace

Result<void> load_config(const fs::path& file, const CollectFields& collect,
                         std::vector<AssignedKey>* assigned) {
  return reported(file.string(), [&] { return load_file(file, {collect, assigned}, {}); });
}

Result<void> load_config_text(std::string_view text, const std::string& name,
                              const CollectFields& collect) {
  return reported(name, [&] {
    return load_document(std::string(text), name, {collect, nullptr}, {fs::weakly_canonical(name)});
  });
}

Result<void> apply_overrides(const CollectFields& collect, std::span<const std::string> settings,
                             std::vector<AssignedKey>* assigned) {
  Fields fields = collect();
  for (const std::string& setting : settings) {
    if (setting.starts_with('@')) {
      if (auto loaded = load_config(setting.substr(1), collect, assigned); !loaded) return loaded;
      fields = collect();
      continue;
    }
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0) {
      return failure(fmt::format("--set {}: expected key=value or @FILE", setting));
    }
    const std::string_view whole = setting;
    const auto done = assign(fields, whole.substr(0, equals), whole.substr(equals + 1));
    if (!done) return failure(fmt::format("--set {}: {}", setting, done.error().message));
    if (assigned == nullptr) continue;
    assigned->push_back({setting.substr(0, equals), fmt::format("--set {}: ", setting)});
  }
  return {};
}

}  // namespace aims
