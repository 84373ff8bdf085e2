// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace aims {

/// Frequencies from `from` to below `to` [Hz]; one that reaches half the sampling rate includes it.
struct FrequencyBand {
  double from = 0.0;
  double to = 0.0;
};

/// Root mean square of the part of a series that lies in each band, by Welch's method: segments of
/// `segment` [s] that overlap by half, Hann window, one-sided spectrum over the window's mean
/// square. The series is sampled uniformly at `rate` [Hz]; its mean is removed first. A line within
/// 2 / segment of an edge falls on both sides of it, farther ones by less than 3 % of their rms. A
/// series shorter than a segment is one segment. None with fewer than 8 samples, or with a value
/// that is not finite.
std::optional<std::vector<double>> band_rms(std::span<const double> series, double rate,
                                            std::span<const FrequencyBand> bands,
                                            double segment = 4.0);

/// Root mean square of the last of each `count` consecutive samples minus their mean: what sampling
/// at an instant adds to the average over the same interval. None without a whole interval.
std::optional<double> sample_minus_mean_rms(std::span<const double> series, int count);

}  // namespace aims
