// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "core/config.hpp"
#include "estimator/filter/error_state.hpp"

namespace aims {

/// Removal of the information that the noise of the map adds to a scan.
struct CrossValidationConfig {
  bool enabled = false;
  /// For `aims calibrate`: the estimate takes nothing from scans along the way, as in a place
  /// without features, while the second belief takes all of it. The difference is what the legs
  /// err.
  bool measure_legs = false;
};

void describe(Fields& fields, CrossValidationConfig& config);

/// Information of a scan matched with both halves of the map, whose points share no return. With
/// the Jacobians j_a, j_b and residuals r_a, r_b of a point's plane in each half, summed over the
/// points and in units of the noise:
struct HalvesInformation {
  Matrix6 within = Matrix6::Zero();         ///< (j_a j_a^T + j_b j_b^T) / 2
  Matrix6 across = Matrix6::Zero();         ///< (j_a j_b^T + j_b j_a^T) / 2
  Vector6 within_vector = Vector6::Zero();  ///< (j_a r_a + j_b r_b) / 2
  Vector6 across_vector = Vector6::Zero();  ///< (j_a r_b + j_b r_a) / 2
};

/// Matrix and vector about the pose: A = H^T R^-1 H, b = H^T R^-1 r.
struct PoseInformation {
  Matrix6 matrix = Matrix6::Zero();
  Vector6 vector = Vector6::Zero();
  /// What it states, where `matrix` is for the gain alone; none: `matrix`.
  std::optional<Matrix6> stated = std::nullopt;
};

/// A direction is constrained if the planes face it by more than this angle (root mean square over
/// all returns) [rad]. Errors that both halves share reach that much at worst: both are mapped from
/// the same poses, and planes at an edge tilt with the rings. Where the scans agree with each other
/// a smaller angle is enough: plain walls have 0 +- 2 mrad over 3 m, walls with a relief of 1.5 mm
/// 4.6 mrad, recesses of 5 cm every 8 m 16 mrad (docs/estimators.md).
inline constexpr double kFreeTilt = 0.006;

/// The information of scans without the part that comes from the noise of the plane normals
/// (docs/estimators.md). The noise d of a normal adds E[d d^T] to j_a j_a^T but nothing to
/// j_a j_b^T, since the halves have independent noise; so `across` is on average the real part X
/// of the information W = `within`, whatever the noise, and x = X^-1 `across_vector` the estimate
/// with instrumental variables, free of the bias towards no motion. The noise covariance of the
/// vector is C = (W + X) / 2 at most; x then states A = X C^-1 X about the position.
///
/// X and A come from averages, the vector from the scan. Where a scan holds more real information
/// than the average, for example when an end wall comes into range, its vector is scaled down to
/// the slope A: with a larger slope the iterated update would step beyond its goal, by more each
/// time.
///
/// Sampling noise of X makes A positive where X is zero, so X and W are averaged along the route (a
/// standing robot sees the same noise in every scan). Both are information about the position with
/// the rotation unknown (Schur complement): in a curved corridor the unconstrained direction is an
/// arc, and information given the rotation would pull the robot off it.
///
/// Whether X along the weakest axis is zero is a test: it counts as far as it exceeds the error of
/// its average, which the scatter of the scans shows, or `kFreeTilt` if that is less.
///
/// Tilts below `kFreeTilt` that pass the test are those of uneven walls. Their slopes change within
/// decimetres, less than the vector of one scan over X scatters, so the estimate would leave the
/// range in which they pull it back. The gain counts such scans whole: W and `within_vector` ask
/// for X / W of the displacement, a tenth, and many of them find the place (docs/estimators.md).
class CrossValidatedInformation {
 public:
  /// Adds a scan at `position` [m]; scans of a robot that stands count once. `shared_tilt`: that
  /// both halves of its map have in common and that does not scatter [rad]; none: it is tested.
  void add(const HalvesInformation& scan, const Eigen::Vector3d& position,
           std::optional<double> shared_tilt = std::nullopt);

  /// A of the position with the rotation unknown and the vector that belongs to it; the rotation
  /// with the position given is taken as real. Where only uneven walls hold it, all of the scan,
  /// with A as what it states.
  PoseInformation applied_to(const HalvesInformation& scan) const;

  /// Projection of the position onto the directions that scans do not leave free.
  const Eigen::Matrix3d& constrained() const { return constrained_; }

  /// Whether scans leave a direction of the position free.
  bool leaves_direction_free() const { return weakest_ <= 0.0; }

  /// Whether they leave none free, but one is held only by planes that face it by less than
  /// `kFreeTilt`.
  bool held_by_uneven_walls() const { return uneven_walls_ && !leaves_direction_free(); }

 private:
  double tilt_of_noise(double square, double gain);
  void limit_averages(const Eigen::Matrix3d& of_scan);
  void update_fraction(double free_tilt);

  std::optional<Eigen::Vector3d> last_position_;
  double distance_ = 0.0;  ///< moved since the first scan [m]
  double weight_ = 0.0;   ///< of all scans since the first in the averages, 1 after a long distance
  double weakest_ = 0.0;  ///< smallest entry of the diagonal below
  bool uneven_walls_ = false;
  Eigen::Vector3d weakest_axis_ = Eigen::Vector3d::UnitX();
  /// Of the square of the tilt towards the weakest axis, over scans.
  struct {
    double mean = 0.0;      ///< [rad^2]
    double variance = 0.0;  ///< [rad^4]
  } squared_tilt_;
  double sum_of_weights_ = 0.0;  ///< of the returns, average [1/m^2]
  Eigen::Matrix3d constrained_ = Eigen::Matrix3d::Zero();
  /// V and W V, with V^T W V = I and V^T X V diagonal.
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d dual_axes_ = Eigen::Matrix3d::Zero();
  Eigen::Array3d real_ = Eigen::Array3d::Zero();       ///< X over W on these axes
  Eigen::Array3d root_ = Eigen::Array3d::Zero();       ///< of A over W
  Eigen::Array3d step_gain_ = Eigen::Array3d::Zero();  ///< A over the slope X of the vector
  Eigen::Matrix3d within_ = Eigen::Matrix3d::Zero();   ///< of the position, odometry axes
  Eigen::Matrix3d across_ = Eigen::Matrix3d::Zero();
};

/// Smallest eigenvalue ratio of `across` to `within` over the axes of the position, the rotation
/// unknown: the real fraction of the information along the weakest axis, 1 without noise and about
/// 0 where all of it is noise.
double weakest_real_fraction(const HalvesInformation& scan);

/// Root mean square tilt of the planes towards the weakest axis of the position, the rotation
/// unknown, as far as both halves agree [rad]; negative when the halves contradict each other.
double weakest_real_tilt(const HalvesInformation& scan);

}  // namespace aims
