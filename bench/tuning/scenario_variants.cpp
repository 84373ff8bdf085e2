// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/scenario_variants.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "bench/tuning/range_key.hpp"

namespace aims {

ScenarioVariants::ScenarioVariants(std::shared_ptr<const Scenario> base,
                                   std::span<const ParameterRange> ranges)
    : base_(std::move(base)), ranges_(ranges) {
  Scenario copy = *base_;
  const Fields fields = fields_of(copy);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (ranges[i].of_estimator) continue;
    const std::string full = full_key(ranges[i]);
    const Parameter* parameter = fields.find(full);
    if (parameter == nullptr) continue;  // `check_ranges` has refused it
    varied_.push_back({i, full, parameter->text(), parameter->kind == ParameterKind::kInteger});
  }
}

Result<ScenarioVariant> ScenarioVariants::at(std::span<const double> point) {
  if (varied_.empty()) return untouched();
  std::vector<std::string> values;
  for (const Varied& each : varied_) {
    const double value = point[each.index];
    values.push_back(fmt::format("{}", each.whole ? std::round(value) : value));
  }
  if (const auto known = made_.find(values); known != made_.end()) return known->second;
  auto variant = make(values);
  if (variant) made_.emplace(std::move(values), *variant);
  return variant;
}

Result<ScenarioVariant> ScenarioVariants::make(const std::vector<std::string>& values) const {
  auto scenario = std::make_shared<Scenario>(*base_);
  const Fields fields = fields_of(*scenario);
  ScenarioVariant variant;
  for (std::size_t i = 0; i < varied_.size(); ++i) {
    const Varied& each = varied_[i];
    if (auto done = assign(fields, each.full, values[i]); !done) {
      return tl::unexpected(done.error());
    }
    std::erase_if(scenario->draw, [&](const Draw& draw) { return draw.key == each.full; });
    variant.settings.push_back({ranges_[each.index].key, values[i], each.default_value});
    if (!each.full.starts_with("scoring.")) variant.sequence += values[i] + "\n";
  }
  variant.scenario = std::move(scenario);
  return variant;
}

}  // namespace aims
