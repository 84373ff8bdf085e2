// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/imu_statistics.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>

#include "lab/fidelity/power_spectrum.hpp"
#include "bench/metrics/statistics.hpp"

namespace aims {
namespace {

constexpr std::size_t kShortestTrot = 8 * 400;   ///< [samples]
constexpr std::size_t kShortestStand = 2 * 400;  ///< [samples]
constexpr int kSlowInterval = 8;                 ///< 20 ms, the interval of 50 Hz [samples]
constexpr std::size_t kAxisCount = 3;

enum class Sensor { kAccelerometer, kGyro };

/// A quantity of the real robot: NaN where it was not published.
struct Reference {
  const char* quantity;
  Sensor sensor;
  FrequencyBand band;  ///< of a band's rms; else 0
  Eigen::Vector3d real;
};

const double kNone = std::nan("");

const std::vector<Reference>& band_references() {
  static const std::vector<Reference> references = {
      {"gyro rms 12.5-25 Hz", Sensor::kGyro, {12.5, 25.0}, {0.16, 0.13, 0.036}},
      {"gyro rms 25-50 Hz", Sensor::kGyro, {25.0, 50.0}, {0.076, 0.085, 0.043}},
      {"gyro rms 50-100 Hz", Sensor::kGyro, {50.0, 100.0}, {0.082, 0.050, 0.037}},
      {"gyro rms 100-200 Hz", Sensor::kGyro, {100.0, 200.0}, {0.084, 0.038, 0.041}},
      {"acc. rms 0.5-5 Hz", Sensor::kAccelerometer, {0.5, 5.0}, {kNone, kNone, 2.0}},
      {"acc. rms 5-12.5 Hz", Sensor::kAccelerometer, {5.0, 12.5}, {kNone, kNone, 1.5}},
      {"acc. rms 12.5-25 Hz", Sensor::kAccelerometer, {12.5, 25.0}, {kNone, kNone, 1.8}},
      {"acc. rms 25-50 Hz", Sensor::kAccelerometer, {25.0, 50.0}, {kNone, kNone, 1.5}},
      {"acc. rms 50-100 Hz", Sensor::kAccelerometer, {50.0, 100.0}, {kNone, kNone, 2.2}},
      {"acc. rms 100-200 Hz", Sensor::kAccelerometer, {100.0, 200.0}, {kNone, kNone, 1.6}}};
  return references;
}

const char* unit_of(Sensor sensor) { return sensor == Sensor::kGyro ? "rad/s" : "m/s^2"; }

std::vector<double> series_of(std::span<const ImuSample> samples, Sensor sensor, int axis) {
  std::vector<double> series;
  series.reserve(samples.size());
  for (const ImuSample& each : samples) {
    series.push_back(sensor == Sensor::kGyro ? each.angular_velocity[axis]
                                             : each.specific_force[axis]);
  }
  return series;
}

double spread(const std::vector<double>& series) {
  const double middle = *mean(series);
  double sum = 0.0;
  for (const double each : series) sum += (each - middle) * (each - middle);
  return std::sqrt(sum / static_cast<double>(series.size()));
}

double largest_deviation(const std::vector<double>& series) {
  const double middle = *mean(series);
  double largest = 0.0;
  for (const double each : series) largest = std::max(largest, std::abs(each - middle));
  return largest;
}

double point_sampling(const std::vector<double>& series) {
  return sample_minus_mean_rms(series, kSlowInterval).value_or(0.0);
}

using Measure = std::function<double(const std::vector<double>&)>;

/// Appends the measure of each axis that the real robot has a figure for.
void append(std::span<const ImuSample> samples, const Reference& reference, const Measure& measure,
            std::vector<ImuStatistic>& rows) {
  for (int axis = 0; axis < 3; ++axis) {
    const double real = reference.real[axis];
    if (std::isnan(real)) continue;
    const double value = measure(series_of(samples, reference.sensor, axis));
    rows.push_back({reference.quantity, unit_of(reference.sensor), "xyz"[axis], value, real, real});
  }
}

}  // namespace

double ImuStatistic::factor() const {
  if (simulated <= 0.0) return HUGE_VAL;
  if (simulated < real_low) return real_low / simulated;
  return simulated > real_high ? simulated / real_high : 1.0;
}

std::optional<std::vector<ImuStatistic>> trot_statistics(std::span<const ImuSample> samples) {
  if (samples.size() < kShortestTrot) return std::nullopt;
  std::vector<ImuStatistic> rows;
  append(samples, {"acc. std", Sensor::kAccelerometer, {}, {2.9, 2.3, 4.4}}, spread, rows);
  append(samples, {"acc. largest deviation", Sensor::kAccelerometer, {}, {19.0, 14.0, 23.0}},
         largest_deviation, rows);
  append(samples, {"gyro std", Sensor::kGyro, {}, {0.41, 0.57, 0.50}}, spread, rows);
  rows.back().comparable = false;
  for (const Reference& reference : band_references()) {
    append(
        samples, reference,
        [&](const std::vector<double>& series) {
          const auto rms = band_rms(series, kImuStatisticsRate, {&reference.band, 1});
          return rms ? rms->front() : 0.0;
        },
        rows);
  }
  append(samples, {"acc. 50 Hz sample - mean", Sensor::kAccelerometer, {}, {2.7, 2.1, 3.4}},
         point_sampling, rows);
  append(samples, {"gyro 50 Hz sample - mean", Sensor::kGyro, {}, {0.24, 0.23, 0.09}},
         point_sampling, rows);
  return rows;
}

std::optional<std::vector<ImuStatistic>> standing_statistics(std::span<const ImuSample> samples) {
  if (samples.size() < kShortestStand) return std::nullopt;
  std::vector<ImuStatistic> rows;
  for (int axis = 0; axis < 3; ++axis) {
    rows.push_back({"acc. std", "m/s^2", "xyz"[axis],
                    spread(series_of(samples, Sensor::kAccelerometer, axis)), 0.08, 0.17});
  }
  for (int axis = 0; axis < 3; ++axis) {
    rows.push_back({"gyro std", "rad/s", "xyz"[axis],
                    spread(series_of(samples, Sensor::kGyro, axis)), 0.010, 0.042});
  }
  return rows;
}

TextTable imu_statistics_table(const std::vector<ImuStatistic>& statistics) {
  TextTable table;
  table.header = {"quantity", "unit", "x", "y", "z", "real x", "real y", "real z", "factor"};
  for (std::size_t i = 0; i < statistics.size();) {
    const std::string& quantity = statistics[i].quantity;
    std::vector<std::string> row = {quantity, statistics[i].unit, "", "", "", "", "", "", ""};
    double factor = 1.0;
    for (; i < statistics.size() && statistics[i].quantity == quantity; ++i) {
      const ImuStatistic& each = statistics[i];
      const std::size_t axis = static_cast<std::size_t>(each.axis - 'x');
      row[2 + axis] = fmt::format("{:.2g}", each.simulated);
      row[2 + kAxisCount + axis] = each.real_low == each.real_high
                                       ? fmt::format("{:g}", each.real_low)
                                       : fmt::format("{:g}-{:g}", each.real_low, each.real_high);
      if (each.comparable) factor = std::max(factor, each.factor());
    }
    row.back() = fmt::format("{:.2f}", factor);
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace aims
