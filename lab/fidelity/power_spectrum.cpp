// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/power_spectrum.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "bench/metrics/statistics.hpp"

namespace aims {
namespace {

constexpr std::size_t kFewestSamples = 8;

std::vector<double> hann_window(std::size_t size) {
  std::vector<double> window(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double phase = 2.0 * std::numbers::pi * static_cast<double>(i) / double(size);
    window[i] = 0.5 - 0.5 * std::cos(phase);
  }
  return window;
}

/// Adds the mean square at each frequency k / (size * step) of one windowed segment.
void add_power(std::span<const double> segment, double mean, const std::vector<double>& window,
               std::vector<double>& power) {
  const std::size_t size = segment.size();
  std::vector<double> windowed(size);
  for (std::size_t i = 0; i < size; ++i) windowed[i] = window[i] * (segment[i] - mean);
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, windowed);
  const double square =
      std::inner_product(window.begin(), window.end(), window.begin(), 0.0) * double(size);
  for (std::size_t k = 0; k < power.size(); ++k) {
    // Zero and half the sampling rate occur once, all others at +k and -k.
    const double times = k == 0 || 2 * k == size ? 1.0 : 2.0;
    power[k] += times * std::norm(spectrum[k]) / square;
  }
}

}  // namespace

std::optional<std::vector<double>> band_rms(std::span<const double> series, double rate,
                                            std::span<const FrequencyBand> bands, double segment) {
  if (series.size() < kFewestSamples || !(rate > 0.0)) return std::nullopt;
  if (!std::all_of(series.begin(), series.end(), [](double x) { return std::isfinite(x); })) {
    return std::nullopt;
  }
  const auto wanted = static_cast<std::size_t>(std::max(1.0, segment * rate));
  const std::size_t size = std::clamp(wanted, kFewestSamples, series.size());
  const std::vector<double> window = hann_window(size);
  const double average = *mean(series);
  std::vector<double> power(size / 2 + 1, 0.0);
  double segments = 0.0;
  for (std::size_t first = 0; first + size <= series.size(); first += (size + 1) / 2) {
    add_power(series.subspan(first, size), average, window, power);
    segments += 1.0;
  }
  std::vector<double> rms;
  for (const FrequencyBand& band : bands) {
    double sum = 0.0;
    for (std::size_t k = 0; k < power.size(); ++k) {
      const double frequency = static_cast<double>(k) * rate / static_cast<double>(size);
      const bool last = 2 * k == size && band.to >= 0.5 * rate;
      if (frequency >= band.from && (frequency < band.to || last)) sum += power[k];
    }
    rms.push_back(std::sqrt(sum / segments));
  }
  return rms;
}

std::optional<double> sample_minus_mean_rms(std::span<const double> series, int count) {
  if (count < 1) return std::nullopt;
  const auto size = static_cast<std::size_t>(count);
  double sum = 0.0;
  double intervals = 0.0;
  for (std::size_t first = 0; first + size <= series.size(); first += size) {
    const std::span<const double> interval = series.subspan(first, size);
    const double difference = interval.back() - *mean(interval);
    sum += difference * difference;
    intervals += 1.0;
  }
  if (intervals == 0.0) return std::nullopt;
  return std::sqrt(sum / intervals);
}

}  // namespace aims
