// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// Longest scan that is accepted.
inline constexpr Duration kLongestScan = kSecond;

/// Differences of neighbouring stamps after sorting, without those that are zero.
std::vector<Duration> spacings(std::vector<Time> stamps);

/// Nominal period of the scans that start at `stamps`, some of which may be missing: the most
/// frequent spacing, else the nearest integer rate. `span`: time from first to last firing, if
/// known; `seen`: the part of a turn that it covers at least, where the LiDAR is blind behind.
/// Nothing without two different stamps or a span.
std::optional<Duration> scan_period(std::vector<Time> stamps, std::optional<Duration> span,
                                    double seen = 1.0);

/// The spacing that most scans of that period have: a multiple where some are left out on purpose.
Duration usual_spacing(std::vector<Time> stamps, Duration period);

/// Nanoseconds per unit (s, ms, us or ns) in which `span` is nearest to a scan of `about`, or
/// nothing when none is close.
std::optional<double> time_unit(double span, Duration about);

/// Sample rate [Hz]: from the most frequent spacing, if it covers a third of all, so that losses
/// have no effect; else from the median, if half are close to it; else from the mean.
std::optional<double> sample_rate(std::vector<Time> stamps);

/// Sample rate [Hz] of samples that arrive in batches, with pauses in between that take most of the
/// time; nothing of others.
std::optional<double> batched_rate(std::vector<Time> times);

}  // namespace aims
