// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/set_description.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace aims {
namespace {

constexpr std::string_view kWithSettings = "With changed settings: ";

}  // namespace

std::string description_with_settings(const Scenario& scenario) {
  std::vector<std::string> settings = settings_of(scenario);
  if (std::ranges::any_of(settings,
                          [](const auto& each) { return each.starts_with("description="); })) {
    return scenario.description;
  }
  std::erase_if(settings, [](const auto& each) {
    return each.starts_with("estimators.") || each.starts_with("seed=");
  });
  if (settings.empty()) return scenario.description;
  std::string text = scenario.description;
  if (!text.empty()) text += text.ends_with('.') ? " " : ". ";
  return text + fmt::format("{}{}.", kWithSettings, fmt::join(settings, ", "));
}

std::string description_without_settings(const std::string& description) {
  std::string text = description.substr(0, description.rfind(kWithSettings));
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

}  // namespace aims
