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

/// Smallest of 1, 2, 5 times a power of ten that is at least 0.8 of `rough`: a tick or two more
/// beat a step that is twice as wide.
double nice_step(double rough) {
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= 0.8 * rough) return factor * decade;
  }
  return 10.0 * decade;
}

int decimals_of(double step) {
  return std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
}

}  // namespace

std::vector<Tick> linear_ticks(double min, double max, int most) {
  const double span = max - min;
  if (!std::isfinite(span) || span <= 0.0 || span < 1e-12 * std::max(std::abs(min), std::abs(max)))
    return {};
  const double step = nice_step(span / std::max(1, most));
  const double slack = 1e-9 * span;
  std::vector<Tick> ticks;
  for (double i = std::ceil((min - slack) / step); i * step <= max + slack; i += 1.0) {
    ticks.push_back({i * step, label_of(i * step, decimals_of(step))});
  }
  return ticks;
}

std::vector<Tick> logarithmic_ticks(double min, double max, int most) {
  if (!(min > 0.0) || !std::isfinite(max) || max <= min) return {};
  const int first = static_cast<int>(std::floor(std::log10(min) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(max) - 1e-9));
  const auto collect = [&](std::initializer_list<double> factors, int stride) {
    std::vector<Tick> ticks;
    for (int decade = first; decade <= last; decade += stride) {
      for (const double factor : factors) {
        const double value = factor * std::pow(10.0, decade);
        if (value < min * (1.0 - 1e-9) || value > max * (1.0 + 1e-9)) continue;
        ticks.push_back({value, power_label(factor, decade)});
      }
    }
    return ticks;
  };
  std::vector<Tick> ticks;
  for (const auto factors : {std::initializer_list<double>{1.0, 2.0, 5.0}, {1.0, 3.0}, {1.0}}) {
    ticks = collect(factors, 1);
    if (ticks.size() <= static_cast<std::size_t>(most) + 1) break;
  }
  if (ticks.size() > static_cast<std::size_t>(most) + 1) {
    ticks = collect({1.0}, (last - first + most - 1) / most);
  }
  return ticks.size() > 1 ? ticks : linear_ticks(min, max, std::max(most, 4));
}

}  // namespace aims
