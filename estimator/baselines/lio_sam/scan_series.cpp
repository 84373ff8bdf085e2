// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/scan_series.hpp"

#include <array>
#include <limits>

#include "estimator/baselines/features/mapping_series.hpp"

namespace aims::lio_sam {
namespace {

using Series = ReportedSeries<ScanReport>;

/// The value of a registered scan, else NaN.
template <class Value>
double of_registered(const ScanReport& scan, Value value) {
  return scan.registered ? double(value(*scan.registered))
                         : std::numeric_limits<double>::quiet_NaN();
}

constexpr std::array kOwnSeries = {
    Series{"points_in", "-", "returns in range",
           [](const ScanReport& s) { return double(s.points_in); }},
    Series{"edges", "-", "edges after averaging; NaN: scan not registered",
           [](const ScanReport& s) {
             return of_registered(s, [](const RegisteredScan& r) { return r.edges; });
           }},
    Series{"surface_points", "-", "surface points after averaging",
           [](const ScanReport& s) {
             return of_registered(s, [](const RegisteredScan& r) { return r.surface; });
           }},
    Series{"iterations", "-", "iterations; 0: scan not registered",
           [](const ScanReport& s) {
             return s.registered ? double(s.registered->solver.iterations) : 0.0;
           }},
    Series{"matches", "-", "lines and planes of the map",
           [](const ScanReport& s) {
             return of_registered(
                 s, [](const RegisteredScan& r) { return r.solver.lines + r.solver.planes; });
           }},
    Series{"smallest_eigenvalue", "-", "smallest eigenvalue of A^T A in the first iteration",
           [](const ScanReport& s) {
             return of_registered(
                 s, [](const RegisteredScan& r) { return smallest_eigenvalue(r.solver); });
           }},
    Series{"removed_directions", "-", "degenerate directions that do not move",
           [](const ScanReport& s) {
             return of_registered(
                 s, [](const RegisteredScan& r) { return r.solver.directions.removed; });
           }},
    Series{"is_degenerate", "-", "1: a direction is degenerate; its pose weighs less",
           [](const ScanReport& s) {
             return of_registered(s, [](const RegisteredScan& r) { return r.degenerate; });
           }},
    Series{"is_keyframe", "-", "1: the scan became a keyframe",
           [](const ScanReport& s) {
             return of_registered(s, [](const RegisteredScan& r) { return r.keyframe; });
           }},
    Series{"imu_guess", "-", "1: the IMU odometry gave the guess",
           [](const ScanReport& s) { return double(s.guessed); }},
    Series{"imu_resets", "-", "failures of the IMU odometry so far",
           [](const ScanReport& s) { return double(s.resets); }},
    Series{"imu_speed", "m/s", "speed at the newest key of the IMU odometry",
           [](const ScanReport& s) { return s.speed; }},
    Series{"accelerometer_bias", "m/s^2", "norm at the newest key of the IMU odometry",
           [](const ScanReport& s) { return s.accelerometer_bias; }},
    Series{"gyro_bias", "rad/s", "norm at the newest key of the IMU odometry",
           [](const ScanReport& s) { return s.gyro_bias; }},
};

constexpr std::array kSeries = joined(kOwnSeries, features::loop_series<ScanReport>());

}  // namespace

std::vector<SeriesInfo> scan_series() { return series_of(kSeries); }

ScanRow row_of(const ScanReport& scan, Time stamp) {
  return {stamp, std::nullopt, values_of(kSeries, scan)};
}

}  // namespace aims::lio_sam
