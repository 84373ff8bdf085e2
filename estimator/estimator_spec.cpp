// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/estimator_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "core/file_name.hpp"
#include "estimator/python/python_estimator.hpp"
#include "estimator/registry.hpp"

namespace aims {
namespace {

bool allowed_in_label(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

bool is_registered(std::string_view name) { return check_estimator_name(name).has_value(); }

/// The text split at each '+' before a setting; a '+' inside a number ("1e+3") does not split.
std::vector<std::string> pieces_of(std::string_view text) {
  std::vector<std::string> pieces;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('+', begin), text.size());
    const std::string piece(text.substr(begin, end - begin));
    const bool setting = piece.find('=') != std::string::npos;
    if (pieces.empty() || setting || pieces.size() == 1) {
      pieces.push_back(piece);
    } else {
      pieces.back() += "+" + piece;
    }
    begin = end + 1;
  }
  return pieces;
}

/// A label made of the name and its settings.
std::string made_label(const EstimatorSpec& spec) {
  std::string label = spec.name;
  for (const auto& [key, value] : spec.settings) label += "-" + key + "-" + value;
  std::replace_if(
      label.begin(), label.end(), [](char c) { return !allowed_in_label(c); }, '_');
  return label;
}

/// The parts of the text, unchecked.
EstimatorSpec split(std::string_view text) {
  const std::vector<std::string> pieces = pieces_of(text);
  EstimatorSpec spec;
  const std::size_t equals = pieces.front().find('=');
  spec.name = equals == std::string::npos ? pieces.front() : pieces.front().substr(equals + 1);
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const std::size_t at = pieces[i].find('=');
    const bool has_value = at != std::string::npos;
    spec.settings.emplace_back(pieces[i].substr(0, at), has_value ? pieces[i].substr(at + 1) : "");
  }
  spec.label = equals == std::string::npos ? made_label(spec) : pieces.front().substr(0, equals);
  return spec;
}

/// "a, b" of all keys.
std::string keys_text(const Fields& fields) {
  std::string text;
  for (const Parameter& each : fields.parameters()) text += ", " + each.key;
  return text.substr(std::min<std::size_t>(text.size(), 2));
}

/// The configuration with the settings of the spec, whether they have an effect or not.
Result<std::unique_ptr<EstimatorConfig>> assigned_config(const EstimatorSpec& spec,
                                                         const EstimatorConfigs& base) {
  const EstimatorConfig* own = base.find(spec.name);
  if (own == nullptr && is_python_name(spec.name)) {
    EstimatorConfigs with_python;
    if (auto added = with_python.add_python(spec.name); !added) {
      return tl::unexpected(added.error());
    }
    return assigned_config(spec, with_python);
  }
  if (own == nullptr) return tl::unexpected(check_estimator_name(spec.name).error());
  std::unique_ptr<EstimatorConfig> config = own->clone();
  const Fields fields = fields_of(*config);
  for (const auto& [key, value] : spec.settings) {
    if (is_python_name(spec.name) && fields.find(key) == nullptr) {
      return failure(fmt::format("{}; {} has {}", unknown_key_message(fields, key), spec.name,
                                 keys_text(fields)));
    }
    if (auto done = assign(fields, key, value); !done) return tl::unexpected(done.error());
  }
  return config;
}

/// Per key of the estimator `name`, why it is idle in all specs of `run`; empty: it is not.
std::map<std::string, std::string> idle_keys(std::string_view name,
                                             std::span<const std::string> run,
                                             const EstimatorConfigs& base) {
  std::map<std::string, std::string> idle;
  for (const std::string& text : run) {
    const EstimatorSpec spec = split(text);
    if (spec.name != name) continue;
    const auto config = assigned_config(spec, base);
    if (!config) continue;
    const Fields fields = fields_of(**config);
    for (const Parameter& parameter : fields.parameters()) {
      std::string& reason = idle.try_emplace(parameter.key, parameter.idle).first->second;
      if (parameter.idle.empty()) reason.clear();
    }
  }
  return idle;
}

constexpr std::string_view kDoesNotRun = " does not run";

/// Adds the classes in Python by their labels.
void describe_python(Fields& fields, const std::vector<std::string>& run,
                     EstimatorConfigs& configs) {
  std::map<std::string, int> labels;  // of each class
  for (const std::string& text : run) ++labels[split(text).name];
  for (const std::string& text : run) {
    const EstimatorSpec spec = split(text);
    EstimatorConfig* config = is_python_name(spec.name) ? configs.find(spec.name) : nullptr;
    if (config == nullptr) continue;
    Fields own = fields_of(*config);
    own.set_idle([&](const Parameter& parameter) -> std::string {
      if (labels[spec.name] > 1) {
        return spec.name + " has several labels; expected LABEL=NAME+key=value";
      }
      return parameter.key == kPythonCodeHash ? "it follows from the files" : "";
    });
    fields.group_of("estimators." + spec.label, std::move(own));
  }
}

/// Whether the key of a file configures only estimators that do not run.
bool of_others(const AssignedKey& assigned, const Fields& fields) {
  if (!assigned.from_file || !assigned.key.starts_with("estimators.")) return false;
  const std::vector<const Parameter*> parameters = fields.matching(assigned.key);
  if (assigned.key.find('*') != std::string::npos) {
    return std::all_of(parameters.begin(), parameters.end(),
                       [](const Parameter* each) { return !each->idle.empty(); });
  }
  return !parameters.empty() && parameters.front()->idle.ends_with(kDoesNotRun);
}

Result<void> check_label(const EstimatorSpec& spec, std::string_view text) {
  if (spec.label.empty() || !std::all_of(spec.label.begin(), spec.label.end(), allowed_in_label)) {
    return failure(
        fmt::format("'{}': the label '{}' has characters other than letters, digits, - and _", text,
                    spec.label));
  }
  const bool itself = spec.label == spec.name && spec.settings.empty();
  if (itself || !is_registered(spec.label)) return {};
  if (spec.label == spec.name) {
    return failure(fmt::format(
        "'{}': the label '{}' is that of the estimator without settings; choose another "
        "label, or keep the name with --set estimators.{}.KEY=VALUE",
        text, spec.label, spec.name));
  }
  return failure(
      fmt::format("'{}': the label '{}' is the name of another estimator; choose another label",
                  text, spec.label));
}

}  // namespace

Result<EstimatorSpec> parse_estimator_spec(std::string_view text) {
  EstimatorSpec spec = split(text);
  const bool is_python = is_python_name(spec.name);
  const auto known = is_python ? check_python_name(spec.name) : check_estimator_name(spec.name);
  if (!known) return tl::unexpected(known.error());
  if (auto fits = check_label(spec, text); !fits) return tl::unexpected(fits.error());
  for (const auto& [key, value] : spec.settings) {
    if (!key.empty() && !value.empty()) continue;
    return failure(fmt::format("'{}': expected key=value after each '+'", text));
  }
  if (is_python) return spec;
  if (auto config = assigned_config(spec, {}); !config) {
    return failure(fmt::format("'{}': {}", text, config.error().message));
  }
  return spec;
}

std::string text_of(const EstimatorSpec& spec) {
  return spec.label == spec.name ? unlabelled_text(spec) : spec.label + "=" + unlabelled_text(spec);
}

std::string unlabelled_text(const EstimatorSpec& spec) {
  std::string text = spec.name;
  for (const auto& [key, value] : spec.settings) text += fmt::format("+{}={}", key, value);
  return text;
}

Result<std::unique_ptr<EstimatorConfig>> config_with(const EstimatorSpec& spec,
                                                     const EstimatorConfigs& base) {
  auto config = assigned_config(spec, base);
  if (!config) return config;
  std::vector<AssignedKey> assigned;
  for (const auto& [key, value] : spec.settings) assigned.push_back({key, ""});
  if (auto acts = check_effect(fields_of(**config), assigned); !acts) {
    return tl::unexpected(acts.error());
  }
  if (auto right = (*config)->check(); !right) return tl::unexpected(right.error());
  return config;
}

Requirements requirements_of(std::string_view spec, const EstimatorConfigs& base) {
  const auto config = assigned_config(split(spec), base);
  return config ? (*config)->requirements() : Requirements();
}

Result<void> add_python_estimators(std::span<const std::string> run, EstimatorConfigs& configs) {
  for (const std::string& text : run) {
    if (auto added = configs.add_python(split(text).name); !added) return added;
  }
  return {};
}

void describe_estimators(Fields& fields, const std::vector<std::string>& run,
                         EstimatorConfigs& configs) {
  for (const std::string& name : estimator_names()) {
    Fields own = fields_of(*configs.find(name));
    const std::map<std::string, std::string> idle = idle_keys(name, run, configs);
    own.set_idle([&](const Parameter& parameter) {
      const auto found = idle.find(parameter.key);
      return found == idle.end() ? name + std::string(kDoesNotRun) : found->second;
    });
    fields.group_of("estimators." + name, std::move(own));
  }
  describe_python(fields, run, configs);
}

Result<void> check_effects(const Fields& fields, std::vector<AssignedKey> assigned, bool run_chosen,
                           std::span<const std::string> run, const EstimatorConfigs& configs) {
  if (run_chosen) {
    std::erase_if(assigned, [&](const AssignedKey& each) { return of_others(each, fields); });
  }
  if (auto acts = check_effect(fields, assigned); !acts) return acts;
  for (const std::string& text : run) {
    const auto config = config_with(split(text), configs);
    if (!config) return failure(fmt::format("run: '{}': {}", text, config.error().message));
  }
  return {};
}

std::string label_of(std::string_view spec) { return split(spec).label; }

std::vector<std::string> labels_of(std::span<const std::string> specs) {
  std::vector<std::string> labels;
  for (const std::string& spec : specs) labels.push_back(label_of(spec));
  return labels;
}

Result<void> check_estimator_specs(std::span<const std::string> specs) {
  std::set<std::string> labels;
  for (const std::string& text : specs) {
    const auto spec = parse_estimator_spec(text);
    if (!spec) return tl::unexpected(spec.error());
    if (auto right = check_file_name(fmt::format("'{}': the label", text), spec->label); !right) {
      return right;
    }
    if (labels.insert(spec->label).second) continue;
    return failure(fmt::format("'{}': the label '{}' is used twice", text, spec->label));
  }
  return {};
}

std::string run_setting(std::span<const std::string> specs) {
  return "run=" + sequence_text({specs.begin(), specs.end()});
}

bool is_run_setting(std::string_view setting) { return setting.starts_with("run="); }

std::vector<std::string> joined_specs(std::span<const std::string> pieces) {
  std::vector<std::string> specs;
  bool open = false;
  for (const std::string& piece : pieces) {
    if (open) {
      specs.back() += "," + piece;
    } else {
      specs.push_back(piece);
    }
    const std::string& last = specs.back();
    open = std::count(last.begin(), last.end(), '[') > std::count(last.begin(), last.end(), ']');
  }
  const auto all = std::ranges::find(specs, kAllEstimators);
  if (all == specs.end()) return specs;
  const std::vector<std::string> systems = system_names();
  specs.insert(specs.erase(all), systems.begin(), systems.end());
  return specs;
}

}  // namespace aims
