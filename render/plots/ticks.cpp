// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

std::string label_of(double value, int decimals) {
  const std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = digits.find_first_not_of("0.") == std::string::npos;
  return value < 0.0 && !zero ? "\u2212" + digits : digits;
}

/// Of factor times a power of ten: "0.02", or "2e−7" where zeros are many.
std::string power_label(double factor, int decade) {
  constexpr int kMostZeros = 5;
  if (std::abs(decade) <= kMostZeros) {
    return label_of(factor * std::pow(10.0, decade), std::max(0, -decade));
  }
  return fmt::format("{:g}e{}{}", factor, decade < 0 ? "\u2212" : "", std::abs(decade));
}

/// Smallest of 1, 2, 5 times a power of ten that is at least `rough`.
double nice_step(double rough) {
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= rough * (1.0 - 1e-9)) return factor * decade;
  }
  return 10.0 * decade;
}

int decimals_of(double step) {
  return std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
}

}  // namespace

std::vector<Tick> linear_ticks(double min, double max, int max_count) {
  const double span = max - min;
  if (!std::isfinite(span) || span <= 0.0 || span < 1e-12 * std::max(std::abs(min), std::abs(max)))
    return {};
  const double step = nice_step(span / std::max(1, max_count - 1));
  const double slack = 1e-9 * span;
  std::vector<Tick> ticks;
  for (double i = std::ceil((min - slack) / step); i * step <= max + slack; i += 1.0) {
    ticks.push_back({i * step, label_of(i * step, decimals_of(step))});
  }
  return ticks;
}

std::vector<Tick> logarithmic_ticks(double min, double max) {
  if (!(min > 0.0) || !std::isfinite(max) || max <= min) return {};
  const int first = static_cast<int>(std::floor(std::log10(min)));
  const int last = static_cast<int>(std::ceil(std::log10(max)));
  constexpr int kMostDecades = 8;
  const int step = (last - first) / kMostDecades + 1;
  const auto collect = [&](std::initializer_list<double> factors) {
    std::vector<Tick> ticks;
    for (int decade = first; decade <= last; decade += step) {
      for (const double factor : factors) {
        const double value = factor * std::pow(10.0, decade);
        if (value < min * (1.0 - 1e-9) || value > max * (1.0 + 1e-9)) continue;
        ticks.push_back({value, power_label(factor, decade)});
      }
    }
    return ticks;
  };
  constexpr std::size_t kLeast = 3;
  for (const auto factors : {std::initializer_list<double>{1.0}, {1.0, 2.0, 5.0}}) {
    auto ticks = collect(factors);
    if (ticks.size() >= kLeast) return ticks;
  }
  return linear_ticks(min, max, 6);  // less than a decade: nearly even there
}

}  // namespace aims
