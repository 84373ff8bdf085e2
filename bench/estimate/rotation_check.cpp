// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/rotation_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace aims {
namespace {

constexpr double kNoise = 0.02;       ///< of LiDAR odometry over an interval [rad]
constexpr int kFewestTurns = 5;       ///< intervals
constexpr double kWrong = 0.006;      ///< residual of a mount that is wrong: 6 degrees [-]
constexpr double kBetter = 0.4;       ///< residual of a better one, of the given one's [-]
constexpr double kAlike = 1.5;        ///< between residuals of mounts that fit alike [-]
constexpr double kLeastRate = 0.01;   ///< mean of LiDAR odometry of a body that turns [rad/s]
constexpr double kOtherUnit = 15.0;   ///< scale beyond noise and vibration; 57 for degrees [-]
constexpr double kScaleError = 0.2;   ///< of a gyro that is no fault
constexpr double kCorrelated = 0.9;   ///< an axis of another scale
constexpr double kUpright = 0.5;      ///< least part of gravity along z of the LiDAR
constexpr double kRightAngles = 0.7;  ///< turns beyond are those of mounts by right angles [rad]
constexpr double kLeastTurn = 0.1;    ///< of a mount that is off [rad]
constexpr double kLeastDegrees = 40.0, kMostDegrees = 80.0;  ///< scale of a gyro in deg/s: 57
constexpr double kOneAxis = 0.02;  ///< squared rotation about others, of the whole

struct Hypothesis {
  std::string cause;
  Eigen::Matrix3d R;  ///< from LiDAR axes to those of the gyro: a rotation if it is a mount
  bool is_mount = true;
};

double residual_of(std::span<const RotationPair> pairs, const Eigen::Matrix3d& R) {
  double sum = 0.0;
  for (const RotationPair& each : pairs) {
    sum += (each.imu - R * each.lidar).squaredNorm() /
           (each.imu.squaredNorm() + each.lidar.squaredNorm() + kNoise * kNoise);
  }
  return pairs.empty() ? 0.0 : sum / static_cast<double>(pairs.size());
}

/// The 48 matrices that permute axes and change signs.
std::vector<Eigen::Matrix3d> axis_changes() {
  std::vector<Eigen::Matrix3d> changes;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
      for (int row = 0; row < 3; ++row) {
        P(row, order[static_cast<std::size_t>(row)]) = (signs >> row & 1) != 0 ? -1.0 : 1.0;
      }
      changes.push_back(P);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return changes;
}

std::string turn_text(const char* what, const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  const Eigen::Vector3d axis =
      turn.axis().unaryExpr([](double each) { return std::abs(each) < 0.02 ? 0.0 : each; });
  return fmt::format("{} by {:.0f} degrees about [{:.2g}, {:.2g}, {:.2g}]", what,
                     turn.angle() * 180.0 / std::numbers::pi, axis.x(), axis.y(), axis.z());
}

std::string wrong_sign(int axis) {
  return fmt::format("{} of the gyro has the wrong sign", "xyz"[axis]);
}

std::string cause_of(const Eigen::Matrix3d& P) {
  if (P.determinant() > 0.0) {
    const bool about_z = P.diagonal() == Eigen::Vector3d(-1.0, -1.0, 1.0);
    return turn_text("the IMU is turned", P) +
           (about_z ? ", or z of the clouds is mirrored, which no mount corrects" : "");
  }
  if (P.isDiagonal()) {
    std::vector<std::string> signs;
    for (int axis = 0; axis < 3; ++axis) {
      if (P(axis, axis) < 0.0) signs.push_back(wrong_sign(axis));
    }
    return fmt::format("{}", fmt::join(signs, ", "));
  }
  return "an axis of the gyro has the wrong sign, or two are swapped: no mount corrects that, "
         "the driver must";
}

/// Whether an IMU of that mount stands as gravity says.
bool is_upright(const Eigen::Matrix3d& R, const Eigen::Vector3d& up) {
  return up.isZero() || (R.transpose() * up.normalized()).z() > kUpright;
}

/// The mount, off by some degrees, that fits best; the given one about axes without turns.
std::optional<Hypothesis> small_turn(std::span<const RotationPair> pairs,
                                     const Eigen::Matrix3d& given) {
  constexpr double kKeep = 0.002;  // weight of the given mount, of the rotations
  Eigen::Matrix3d B = Eigen::Matrix3d::Zero();
  for (const RotationPair& each : pairs) B += each.imu * (given * each.lidar).transpose();
  B += kKeep * B.norm() * Eigen::Matrix3d::Identity();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(B, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  const Eigen::Matrix3d turn =
      svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
  const double angle = Eigen::AngleAxisd(turn).angle();
  if (angle < kLeastTurn || angle > kRightAngles) return std::nullopt;
  return Hypothesis{turn_text("the mount is off", turn), turn * given};
}

std::array<AxisCheck, 3> check_axes(std::span<const RotationPair> pairs, const Eigen::Matrix3d& R) {
  std::array<AxisCheck, 3> axes;
  for (int axis = 0; axis < 3; ++axis) {
    AxisCheck& check = axes[static_cast<std::size_t>(axis)];
    double both = 0.0, lidar = 0.0, gyro = 0.0;
    for (const RotationPair& each : pairs) {
      const double turned = R.row(axis).dot(each.lidar);
      if (std::abs(turned) > kLeastRotation) ++check.intervals;
      both += turned * each.imu[axis];
      lidar += turned * turned;
      gyro += each.imu[axis] * each.imu[axis];
    }
    if (lidar > 0.0) check.scale = both / lidar;
    if (lidar > 0.0 && gyro > 0.0) check.correlation = both / std::sqrt(lidar * gyro);
  }
  return axes;
}

/// A gyro whose axes have the scales and signs that they are seen with.
std::optional<Hypothesis> scaled_axes(const std::array<AxisCheck, 3>& axes,
                                      const Eigen::Matrix3d& given) {
  constexpr double kNothing = 0.05;  // scale
  Eigen::Vector3d scales = Eigen::Vector3d::Ones();
  std::vector<std::string> causes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisCheck& check = axes[axis];
    const char name = "xyz"[axis];
    const bool nothing = std::abs(check.scale) < kNothing;
    if (!check.observable() || (!nothing && std::abs(check.correlation) < kCorrelated)) continue;
    scales[static_cast<int>(axis)] = check.scale;
    const double size = std::abs(check.scale);
    if (size > kLeastDegrees && size < kMostDegrees) {
      causes.push_back(fmt::format("{} of the gyro is in deg/s (recording.gyro_unit=deg/s)", name));
    } else if (nothing) {
      causes.push_back(fmt::format("{} of the gyro measures nothing", name));
    } else if (std::abs(check.scale + 1.0) < kScaleError) {
      causes.push_back(wrong_sign(static_cast<int>(axis)));
    } else if (std::abs(check.scale - 1.0) > kScaleError) {
      causes.push_back(
          fmt::format("{} of the gyro measures {:.2f} times the rotation of LiDAR "
                      "odometry",
                      name, check.scale));
    }
  }
  if (causes.empty()) return std::nullopt;
  return Hypothesis{fmt::format("{}", fmt::join(causes, ", ")), scales.asDiagonal() * given, false};
}

/// Whether the axis alone contradicts, whatever noise there is about the others.
bool is_clearly_scaled(const AxisCheck& check) {
  constexpr double kCertain = 0.95, kLarge = 0.3;
  return check.observable() && std::abs(check.correlation) > kCertain &&
         std::abs(check.scale - 1.0) > kLarge;
}

/// The likelier first: inverted, upside down, turned, off by some degrees, axes of another sign or
/// scale, mirrored clouds; then what gravity contradicts.
std::vector<Hypothesis> hypotheses(std::span<const RotationPair> pairs,
                                   const std::array<AxisCheck, 3>& axes,
                                   const Eigen::Matrix3d& given, const Eigen::Vector3d& up) {
  std::vector<Hypothesis> all = {{"the extrinsic is inverted", given.transpose()}};
  std::vector<Eigen::Matrix3d> changes = axis_changes();
  std::ranges::stable_partition(changes, [](const auto& P) { return P.isDiagonal(); });
  for (const Eigen::Matrix3d& P : changes) {
    if (P.determinant() > 0.0 && !P.isIdentity()) all.push_back({cause_of(P), P * given});
  }
  if (auto turned = small_turn(pairs, given)) all.push_back(*std::move(turned));
  if (auto scaled = scaled_axes(axes, given)) all.push_back(*std::move(scaled));
  for (const Eigen::Matrix3d& P : changes) {
    if (P.determinant() < 0.0) all.push_back({cause_of(P), P * given, false});
  }
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::Matrix3d turn = -Eigen::Matrix3d::Identity();  // rotations are mirrored the other way
    turn(axis, axis) = 1.0;
    all.push_back({fmt::format("{} of the clouds is mirrored, or the IMU is turned by 180 degrees "
                               "about {}, which gravity contradicts: the driver must correct that",
                               "xy"[axis], "xy"[axis]),
                   given * turn, false});
  }
  std::ranges::stable_partition(
      all, [&up](const Hypothesis& each) { return !each.is_mount || is_upright(each.R, up); });
  return all;
}

/// Whether all rotations are about one axis.
bool is_one_axis(std::span<const RotationPair> pairs) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const RotationPair& each : pairs) sum += each.lidar * each.lidar.transpose();
  const Eigen::Vector3d parts = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvalues();
  return parts[1] < kOneAxis * parts[2];
}

}  // namespace

bool AxisCheck::observable() const { return intervals >= kFewestTurns; }

bool MountCheck::checked() const { return intervals >= kFewestTurns; }

bool RateCheck::is_wrong_unit() const {
  return scale > kOtherUnit || (scale > 0.0 && scale < 1.0 / kOtherUnit);
}

RateCheck check_rates(const std::vector<TurnRate>& lidar, const std::vector<TurnRate>& gyro) {
  const auto mean = [](const std::vector<TurnRate>& rates) {
    double sum = 0.0;
    for (const TurnRate& each : rates) sum += each.rate;
    return rates.empty() ? 0.0 : sum / static_cast<double>(rates.size());
  };
  RateCheck check;
  const double turned = mean(lidar);
  check.scale = turned > kLeastRate ? mean(gyro) / turned : 0.0;
  check.clock = clock_offset(lidar, gyro);
  return check;
}

MountCheck check_mount(std::span<const RotationPair> pairs, const Eigen::Quaterniond& R_imu_lidar,
                       const Eigen::Vector3d& up) {
  const Eigen::Matrix3d given = R_imu_lidar.toRotationMatrix();
  MountCheck check;
  check.intervals = static_cast<int>(pairs.size());
  check.axes = check_axes(pairs, given);
  check.one_axis = is_one_axis(pairs);
  check.R_imu_lidar = R_imu_lidar;
  check.given_residual = check.best_residual = residual_of(pairs, given);
  if (!check.checked()) return check;
  const auto all = hypotheses(pairs, check.axes, given, up);
  std::vector<double> residuals;
  for (const Hypothesis& each : all) residuals.push_back(residual_of(pairs, each.R));
  const double least = std::max(*std::ranges::min_element(residuals), kWrong * kBetter);
  const auto first =
      std::ranges::find_if(residuals, [least](double each) { return each <= kAlike * least; });
  const Hypothesis& best = all[static_cast<std::size_t>(first - residuals.begin())];
  check.best_residual = *first;
  check.contradicts =
      check.given_residual > kWrong && check.best_residual <= kBetter * check.given_residual;
  if (check.contradicts) {
    check.cause = best.cause;
    check.correctable = best.is_mount;
  } else if (std::ranges::any_of(check.axes, is_clearly_scaled)) {
    check.contradicts = true;
    check.cause = scaled_axes(check.axes, given)->cause;
  }
  if (check.correctable) check.R_imu_lidar = Eigen::Quaterniond(best.R).normalized();
  return check;
}

}  // namespace aims
