// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/scan_diagnostics.hpp"

#include <array>

namespace aims {
namespace {

using Scan = ScanDiagnostics;
using Series = ReportedSeries<Scan>;

constexpr std::array kSeries = {
    Series{"points_in", "-", "finite points in range",
           [](const Scan& s) { return static_cast<double>(s.points_in); }},
    Series{"points_used", "-", "points with an accepted plane in the final update",
           [](const Scan& s) { return static_cast<double>(s.points_used); }},
    Series{"iterations", "-", "iterations of the trial update; 0: no update",
           [](const Scan& s) { return static_cast<double>(s.iterations); }},
    Series{"converged", "-", "1: the last iteration made a small step",
           [](const Scan& s) { return s.converged ? 1.0 : 0.0; }},
    Series{"residual_mean", "m", "mean residual after the trial update, eq. (3)",
           [](const Scan& s) { return s.residual_mean; }},
    Series{"residual_sigma", "m", "deviation of the residuals after the trial update, eq. (3)",
           [](const Scan& s) { return s.residual_sigma; }},
    Series{"residual_sigma_prior", "m", "deviation of the residuals before the trial update",
           [](const Scan& s) { return s.residual_sigma_prior; }},
    Series{"O_lidar", "-", "effective observability, eq. (4)",
           [](const Scan& s) { return s.O_lidar; }},
    Series{"O_lidar_prior", "-", "eq. (4) of the residuals before the trial update",
           [](const Scan& s) { return s.O_lidar_prior; }},
    Series{"C_IL", "-", "consistency of LiDAR and prediction, eq. (6), pose block, as D_k uses it",
           [](const Scan& s) { return s.C_IL; }},
    Series{"C_IL_imu", "-", "eq. (6) against the prediction of the IMU alone since the last scan",
           [](const Scan& s) { return s.C_IL_imu; }},
    Series{"C_IL_imu_legs", "-", "eq. (6) against the prediction of IMU and legs",
           [](const Scan& s) { return s.C_IL_imu_legs; }},
    Series{"C_IL_full", "-", "eq. (6) over the full error state",
           [](const Scan& s) { return s.C_IL_full; }},
    Series{"D", "-", "degeneracy severity D_k, eq. (7)", [](const Scan& s) { return s.D; }},
    Series{"D_smoothed", "-", "smoothed severity, eq. (12)",
           [](const Scan& s) { return s.D_smoothed; }},
    Series{"gamma_lidar", "-", "reliability of the LiDAR, eq. (8)",
           [](const Scan& s) { return s.gamma_lidar; }},
    Series{"gamma_leg", "-", "reliability of the legs, eq. (10)",
           [](const Scan& s) { return s.gamma_leg; }},
    Series{"innovation_rotation_x", "rad", "y_k, eq. (5), rotation",
           [](const Scan& s) { return s.innovation_rotation.x(); }},
    Series{"innovation_rotation_y", "rad", "y_k, eq. (5), rotation",
           [](const Scan& s) { return s.innovation_rotation.y(); }},
    Series{"innovation_rotation_z", "rad", "y_k, eq. (5), rotation",
           [](const Scan& s) { return s.innovation_rotation.z(); }},
    Series{"innovation_position_x", "m", "y_k, eq. (5), position",
           [](const Scan& s) { return s.innovation_position.x(); }},
    Series{"innovation_position_y", "m", "y_k, eq. (5), position",
           [](const Scan& s) { return s.innovation_position.y(); }},
    Series{"innovation_position_z", "m", "y_k, eq. (5), position",
           [](const Scan& s) { return s.innovation_position.z(); }},
    Series{"smallest_eigenvalue", "1/m^2", "smallest eigenvalue of the translation information",
           [](const Scan& s) { return s.smallest_eigenvalue; }},
    Series{"condition_number", "-", "condition number of the translation information",
           [](const Scan& s) { return s.condition_number; }},
    Series{"weak_weight", "-", "real fraction of the information, weakest axis",
           [](const Scan& s) { return s.weak_weight; }},
    Series{"weak_tilt", "rad", "tilt of the planes towards the weakest axis, both halves agreeing",
           [](const Scan& s) { return s.weak_tilt; }},
    Series{"weak_information", "1/m^2",
           "smallest eigenvalue of the information about the position that counts as real",
           [](const Scan& s) { return s.weak_information; }},
    Series{"leg_innovation", "m/s", "norm of the last leg innovation",
           [](const Scan& s) { return s.leg_innovation; }},
    Series{"leg_updates", "-", "leg updates since the last scan",
           [](const Scan& s) { return static_cast<double>(s.leg_updates); }},
    Series{"gyro_noise", "rad/s/sqrt(Hz)", "estimated white noise of the gyro",
           [](const Scan& s) { return s.imu_noise.gyro; }},
    Series{"accelerometer_noise", "m/s^2/sqrt(Hz)", "estimated white noise of the accelerometer",
           [](const Scan& s) { return s.imu_noise.accelerometer; }},
    Series{"delay", "s", "estimated delay of the IMU's stamps",
           [](const Scan& s) { return s.delay; }},
    Series{"mount_x", "rad", "estimated correction of the mount's rotation",
           [](const Scan& s) { return s.mount.x(); }},
    Series{"mount_y", "rad", "estimated correction of the mount's rotation",
           [](const Scan& s) { return s.mount.y(); }},
    Series{"mount_z", "rad", "estimated correction of the mount's rotation",
           [](const Scan& s) { return s.mount.z(); }},
};

}  // namespace

std::vector<SeriesInfo> scan_series() { return series_of(kSeries); }

ScanRow row_of(const ScanDiagnostics& scan) {
  return {scan.stamp, scan.covariance, values_of(kSeries, scan)};
}

}  // namespace aims
