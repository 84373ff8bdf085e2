// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include "estimator/python/python_class.hpp"

namespace aims {
namespace {

constexpr std::string_view kCallTimeoutKey = "call_timeout";

/// "module" and "Class" of "python:module.Class".
std::pair<std::string, std::string> parts_of(std::string_view name) {
  const std::string_view path = name.substr(kPythonPrefix.size());
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return {std::string(path), ""};
  return {std::string(path.substr(0, dot)), std::string(path.substr(dot + 1))};
}

/// While a whole number has no value.
constexpr int kNoInteger = std::numeric_limits<int>::min();

/// The parameter of a value.
void describe_value(Fields& fields, std::string_view key, PythonValue& value, Spec spec) {
  if (auto* text = std::get_if<std::string>(&value)) fields.text(key, *text, std::move(spec));
  if (auto* flag = std::get_if<bool>(&value)) fields.flag(key, *flag, std::move(spec));
  if (auto* integer = std::get_if<int>(&value)) fields.integer(key, *integer, std::move(spec));
  if (auto* number = std::get_if<double>(&value)) fields.number(key, *number, std::move(spec));
}

/// Whether the value is one.
bool is_given(const PythonValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return !text->empty();
  if (const auto* number = std::get_if<double>(&value)) return !std::isnan(*number);
  return value != PythonValue(kNoInteger);
}

/// The value that worker.py describes by type and text. Error for a text that is none of that type.
Result<PythonValue> value_of(const std::string& type, const std::string& text, bool is_given) {
  PythonValue value;
  if (type == "float") value = std::nan("");
  if (type == "int") value = kNoInteger;
  if (type == "bool") value = false;
  if (!is_given) return value;
  Fields fields;
  describe_value(fields, "value", value, {});
  if (auto done = assign(fields, "value", text); !done) return tl::unexpected(done.error());
  return value;
}

/// The keyword that a message describes next.
Result<PythonSetting> setting_in(MessageCursor& cursor) {
  PythonSetting setting;
  setting.key = cursor.take_text();
  const std::string type = cursor.take_text();
  const std::string text = cursor.take_text();
  const bool has_default = cursor.take_text() == "1";
  auto value = value_of(type, text, has_default);
  if (!value) return failure(fmt::format("{}: {}", setting.key, value.error().message));
  setting.value = std::move(*value);
  if (has_default) setting.standard = setting.value;
  return setting;
}

}  // namespace

bool is_operational(std::string_view key) {
  return key == kCallTimeoutKey || key == kPythonCodeHash;
}

Result<std::vector<std::byte>> import_class(PythonProcess& process, std::string_view name,
                                            double limit_s) {
  if (auto started = process.start(); !started) return tl::unexpected(started.error());
  const auto [module, kind] = parts_of(name);
  PipeMessage hello;
  for (const std::string& text : {std::to_string(kPythonProtocol), module, kind}) {
    hello.add_text(text);
  }
  return process.ask(PythonRequest::kHello, hello.bytes(), limit_s);
}

std::string python_text(const PythonValue& value) {
  return std::visit([](const auto& each) { return fmt::format("{}", each); }, value);
}

Result<void> check_python_name(std::string_view name) {
  const auto [module, kind] = parts_of(name);
  const auto is_word = [](std::string_view text, std::string_view also) {
    return !text.empty() && std::ranges::all_of(text, [&](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || also.find(c) != also.npos;
    });
  };
  if (is_word(module, "_.") && is_word(kind, "_")) return {};
  return failure(
      fmt::format("'{}': expected python:module.Class, e.g. python:my_package.Mine", name));
}

Result<PythonConfig> PythonConfig::load(std::string_view name, double limit_s) {
  if (auto right = check_python_name(name); !right) return tl::unexpected(right.error());
  PythonProcess process;
  const auto described = import_class(process, name, limit_s);
  if (!described) return failure(fmt::format("{}: {}", name, described.error().message));
  MessageCursor cursor(*described);
  PythonConfig config;
  config.name_ = name;
  config.found_hash_ = config.code_hash_ = cursor.take_text();
  const std::string methods = cursor.take_text();
  for (std::size_t begin = 0; begin <= methods.size();) {
    const std::size_t end = std::min(methods.find(',', begin), methods.size());
    config.methods_.push_back(methods.substr(begin, end - begin));
    begin = end + 1;
  }
  while (!cursor.at_end()) {
    auto setting = setting_in(cursor);
    if (!setting) return failure(fmt::format("{}: {}", name, setting.error().message));
    config.settings_.push_back(std::move(*setting));
  }
  if (cursor.is_short()) return failure(fmt::format("{}: answered with too few bytes", name));
  for (const PythonSetting& each : config.settings_) {
    if (!is_operational(each.key)) continue;
    return failure(
        fmt::format("{}: the keyword '{}' of the constructor is the name of another "
                    "parameter; expected another name",
                    name, each.key));
  }
  return config;
}

void PythonConfig::describe(Fields& fields) {
  for (PythonSetting& each : settings_) {
    describe_value(fields, each.key, each.value,
                   {.unit = "-", .meaning = "keyword of the constructor of " + name_});
  }
  fields.number(kCallTimeoutKey, call_timeout_,
                {.unit = "s",
                 .range = up_to(1e6),
                 .meaning = "wall time that one call of the class is given; 0: any"});
  fields.text(kPythonCodeHash, code_hash_,
              {.unit = "-", .meaning = "hash of the files that the class is made of"});
}

std::unique_ptr<EstimatorConfig> PythonConfig::clone() const {
  return std::make_unique<PythonConfig>(*this);
}

bool PythonConfig::has(std::string_view method) const {
  return std::ranges::find(methods_, method) != methods_.end();
}

Result<void> PythonConfig::check() const {
  for (const PythonSetting& each : settings_) {
    if (each.standard || is_given(each.value)) continue;
    return failure(
        fmt::format("{}: {}: expected a value, as the constructor has no default; give "
                    "+{}=VALUE",
                    name_, each.key, each.key));
  }
  if (code_hash_ == found_hash_) return {};
  return failure(fmt::format("{}: code_hash: expected {}, as set; the files have {}", name_,
                             code_hash_, found_hash_));
}

}  // namespace aims
