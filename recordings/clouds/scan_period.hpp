// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// A longer scan is no scan.
inline constexpr Duration kLongestScan = kSecond;

/// Times between neighbouring stamps, put in order; those of equal stamps are left out.
std::vector<Duration> spacings(std::vector<Time> stamps);

/// Nominal period of the scans that start at `stamps`, some of which may be missing: the spacing
/// that most share, else the nearest whole number per second. `span`: how long points fire, if
/// known. Nothing without two different stamps or a span.
std::optional<Duration> scan_period(std::vector<Time> stamps, std::optional<Duration> span);

/// Nanoseconds per unit (s, ms, us or ns) in which `span` is nearest to a scan of `about`, or
/// nothing when none comes near.
std::optional<double> time_unit(double span, Duration about);

/// Samples per second [Hz]: by the spacing that a third share, so that losses do not count; else by
/// the median, if half are near it; else, stamps being in disorder, by the mean.
std::optional<double> sample_rate(std::vector<Time> stamps);

}  // namespace aims
