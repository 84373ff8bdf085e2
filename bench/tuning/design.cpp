// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/random/sobol.hpp>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/random.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::string_view kForms =
    "expected KEY=LOW:HIGH:COUNT or KEY=log(LOW,HIGH,COUNT), e.g. degeneracy.eta=0:6:13";

std::vector<std::string_view> trimmed_parts(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(trimmed(text.substr(begin, end - begin), " "));
    begin = end + 1;
  }
  return parts;
}

Result<void> check_bounds(const ParameterRange& range, std::string_view text) {
  if (!std::isfinite(range.low) || !std::isfinite(range.high)) {
    return failure(fmt::format("range '{}': expected finite bounds", text));
  }
  if (range.low > range.high) {
    return failure(fmt::format("range '{}': expected {} below {}; the bounds are reversed", text,
                               range.low, range.high));
  }
  if (range.log && range.low <= 0.0) {
    return failure(
        fmt::format("range '{}': a logarithmic range begins above 0, not at {}", text, range.low));
  }
  return {};
}

Result<void> check_count(const ParameterRange& range, std::string_view text) {
  const bool one_value = range.low == range.high;
  if (one_value && range.count != 1) {
    return failure(
        fmt::format("range '{}': empty, from {} to the same; expected two bounds, or a count of 1",
                    text, range.low));
  }
  if (!one_value && range.count == 1) {
    return failure(
        fmt::format("range '{}': 1 value has no room for two bounds; expected a count "
                    "of at least 2, or equal bounds",
                    text));
  }
  return {};
}

double rounded(double value) {
  std::array<char, 32> text{};
  const auto end = fmt::format_to_n(text.data(), text.size(), "{:.12g}", value).out;
  std::from_chars(text.data(), end, value);
  return value;
}

const Parameter* integer_parameter(const Fields& fields, const std::string& key) {
  const Parameter* parameter = fields.find(key);
  return parameter != nullptr && parameter->kind == ParameterKind::kInteger ? parameter : nullptr;
}

std::vector<std::vector<double>> grid(std::span<const ParameterRange> ranges, std::size_t size) {
  std::vector<std::vector<double>> points(size, std::vector<double>(ranges.size()));
  std::size_t repeats = size;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto count = static_cast<std::size_t>(ranges[i].count);
    repeats /= count;
    for (std::size_t k = 0; k < size; ++k) {
      const auto step = static_cast<double>(k / repeats % count);
      points[k][i] = value_at(ranges[i], count == 1 ? 0.0 : step / double(count - 1));
    }
  }
  return points;
}

/// A point per row, each coordinate in [0, 1).
using Fractions = std::vector<std::vector<double>>;

Fractions random_fractions(std::size_t points, std::size_t dimensions, RandomStream& stream) {
  Fractions result(points, std::vector<double>(dimensions));
  for (auto& point : result) {
    for (double& fraction : point) fraction = stream.uniform();
  }
  return result;
}

/// The shift is added bit by bit without carry, which keeps every stratum of the sequence filled.
Fractions sobol_fractions(std::size_t points, std::size_t dimensions, RandomStream& stream) {
  constexpr int kBits = 53;
  std::vector<std::uint64_t> shifts(dimensions);
  for (auto& shift : shifts) {
    shift = static_cast<std::uint64_t>(std::ldexp(stream.uniform(), kBits)) << (64 - kBits);
  }
  boost::random::sobol sequence(dimensions);
  Fractions result(points, std::vector<double>(dimensions));
  for (std::size_t k = 0; k < points; ++k) {
    for (std::size_t i = 0; i < dimensions; ++i) {
      const std::uint64_t unshifted = k == 0 ? 0 : sequence();  // Boost leaves the first point out
      const std::uint64_t bits = (unshifted ^ shifts[i]) >> (64 - kBits);
      result[k][i] = std::ldexp(static_cast<double>(bits), -kBits);
    }
  }
  return result;
}

Fractions latin_fractions(std::size_t points, std::size_t dimensions, RandomStream& stream) {
  Fractions result(points, std::vector<double>(dimensions));
  std::vector<std::size_t> strata(points);
  for (std::size_t i = 0; i < dimensions; ++i) {
    std::iota(strata.begin(), strata.end(), 0U);
    for (std::size_t k = points; k > 1; --k) {
      std::swap(strata[k - 1],
                strata[static_cast<std::size_t>(stream.uniform() * static_cast<double>(k))]);
    }
    for (std::size_t k = 0; k < points; ++k) {
      result[k][i] = (static_cast<double>(strata[k]) + stream.uniform()) / double(points);
    }
  }
  return result;
}

}  // namespace

Result<ParameterRange> parse_range(std::string_view text) {
  const auto wrong = [&] { return failure(fmt::format("range '{}': {}", text, kForms)); };
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0) return wrong();
  ParameterRange range;
  range.key = trimmed(text.substr(0, equals), " ");
  std::string_view rest = trimmed(text.substr(equals + 1), " ");
  range.log = rest.starts_with("log(") && rest.ends_with(")");
  if (range.log) rest = rest.substr(4, rest.size() - 5);
  const auto parts = trimmed_parts(rest, range.log ? ',' : ':');
  if (range.key.empty() || parts.size() < 2 || parts.size() > 3) return wrong();
  const auto low = number_from<double>(parts[0]);
  const auto high = number_from<double>(parts[1]);
  const auto count = parts.size() == 3 ? number_from<int>(parts[2]) : std::optional<int>(0);
  if (!low || !high || !count) return wrong();
  if (parts.size() == 3 && *count < 1) {
    return failure(fmt::format("range '{}': expected at least 1 value, not {}", text, *count));
  }
  range.low = *low;
  range.high = *high;
  range.count = *count;
  if (auto good = check_bounds(range, text); !good) return tl::unexpected(good.error());
  if (auto good = check_count(range, text); !good) return tl::unexpected(good.error());
  return range;
}

std::string text_of(const ParameterRange& range) {
  const char* separator = range.log ? "," : ":";
  std::string values = fmt::format("{}{}{}", range.low, separator, range.high);
  if (range.count > 0) values += fmt::format("{}{}", separator, range.count);
  return fmt::format("{}={}", range.key, range.log ? "log(" + values + ")" : values);
}

Result<std::size_t> design_size(DesignKind kind, std::span<const ParameterRange> ranges,
                                int samples) {
  if (ranges.empty()) return failure("no range of a parameter is given; " + std::string(kForms));
  if (kind != DesignKind::kGrid && samples < 1) {
    return failure(fmt::format("samples {}: expected at least 1", samples));
  }
  std::size_t size = kind == DesignKind::kGrid ? 1 : static_cast<std::size_t>(samples);
  for (const ParameterRange& range : ranges) {
    if (kind != DesignKind::kGrid) break;
    if (range.count < 1) {
      return failure(fmt::format("range '{}': a grid needs a count", text_of(range)));
    }
    size *= static_cast<std::size_t>(range.count);
    if (size > kMostPoints) break;
  }
  if (size <= kMostPoints) return size;
  return failure(fmt::format("the design has more than {} points", kMostPoints));
}

double value_at(const ParameterRange& range, double fraction) {
  if (fraction <= 0.0) return range.low;
  if (fraction >= 1.0) return range.high;
  const double value = range.log ? range.low * std::pow(range.high / range.low, fraction)
                                 : range.low + (range.high - range.low) * fraction;
  return std::clamp(rounded(value), range.low, range.high);
}

double fraction_of(const ParameterRange& range, double value) {
  if (range.low == range.high) return 0.5;
  if (range.log) return std::log(value / range.low) / std::log(range.high / range.low);
  return (value - range.low) / (range.high - range.low);
}

std::vector<std::vector<double>> design(DesignKind kind, std::span<const ParameterRange> ranges,
                                        int samples, std::uint64_t seed) {
  const auto size = design_size(kind, ranges, samples);
  if (!size) return {};
  if (kind == DesignKind::kGrid) return grid(ranges, *size);
  RandomStream stream = rng(seed, "sweep.design");
  Fractions points = kind == DesignKind::kSobol    ? sobol_fractions(*size, ranges.size(), stream)
                     : kind == DesignKind::kRandom ? random_fractions(*size, ranges.size(), stream)
                                                   : latin_fractions(*size, ranges.size(), stream);
  for (auto& point : points) {
    for (std::size_t i = 0; i < ranges.size(); ++i) point[i] = value_at(ranges[i], point[i]);
  }
  return points;
}

EstimatorSpec spec_at(const EstimatorSpec& base, std::span<const ParameterRange> ranges,
                      std::span<const double> point, const EstimatorConfigs& configs) {
  const EstimatorConfig* known = configs.find(base.name);
  const auto config = known == nullptr ? nullptr : known->clone();
  const Fields fields = config == nullptr ? Fields() : fields_of(*config);
  EstimatorSpec spec = base;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (!ranges[i].of_estimator) continue;
    const std::string& key = ranges[i].key;
    const bool whole = integer_parameter(fields, key) != nullptr;
    std::erase_if(spec.settings, [&](const auto& setting) { return setting.first == key; });
    spec.settings.emplace_back(key, fmt::format("{}", whole ? std::round(point[i]) : point[i]));
  }
  return spec;
}

}  // namespace aims
