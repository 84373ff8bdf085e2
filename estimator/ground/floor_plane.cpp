// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/floor_plane.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace aims {
namespace {

/// Height of the bins in which the floor is looked for [m].
constexpr double kBin = 0.06;
/// Share of the fullest bin that makes a lower one the floor [-].
constexpr double kLower = 0.5;
/// Bands about the plane before the last: a trunk that is not parallel to the floor tilts it.
constexpr std::array<double, 2> kWideBands{0.20, 0.10};
/// Share of the free points below the body that lie on the floor; else it is one of several [-].
constexpr double kLeastShare = 0.7;
/// The floor's parts: four sectors, each near and far.
constexpr int kParts = 8;
/// Fewer points tell nothing of a part.
constexpr std::size_t kFewestOfPart = 12;
/// Points this far from the plane may still be floor that bends away from it [m].
constexpr double kBendReach = 0.12;

/// The plane z = a + b x + c y, and what its points say of it.
struct HeightFit {
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the coefficients, of unit sigma
  int points = 0;
  double square_sum = 0.0;  ///< of what is left [m^2]

  double over(const Eigen::Vector3d& p) const {
    return p.z() - coefficients(0) - coefficients(1) * p.x() - coefficients(2) * p.y();
  }
};

/// Upper ends of the columns over a square grid: what stands on the floor tells walls, furniture
/// and legs from it.
class Columns {
 public:
  Columns(std::span<const Eigen::Vector3f> points, const FloorConfig& config)
      : radius_(config.radius),
        cells_(static_cast<int>(std::ceil(2.0 * config.radius / kCell))),
        tops_(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_), -kHigh) {
    for (const Eigen::Vector3f& point : points) {
      const double z = point.z();
      if (!(point.head<2>().norm() < radius_) || !(z < kHigh)) continue;
      double& top = tops_[at(point.cast<double>())];
      top = std::max(top, z);
    }
  }

  /// Whether nothing stands at the point, which is one of those given at construction.
  bool is_free(const Eigen::Vector3d& p) const { return tops_[at(p)] - p.z() < kStanding; }

 private:
  static constexpr double kCell = 0.25;      ///< [m]
  static constexpr double kHigh = 0.8;       ///< ceilings are above it [m]
  static constexpr double kStanding = 0.12;  ///< what is higher stands on the floor [m]

  std::size_t at(const Eigen::Vector3d& p) const {
    const auto cell = [this](double x) {
      return std::clamp(static_cast<int>((x + radius_) / kCell), 0, cells_ - 1);
    };
    return static_cast<std::size_t>(cell(p.x()) * cells_ + cell(p.y()));
  }

  double radius_;
  int cells_;
  std::vector<double> tops_;  ///< [m]
};

/// Points that can be floor: near enough, below the body, and with nothing on them.
std::vector<Eigen::Vector3d> below(std::span<const Eigen::Vector3f> points,
                                   const FloorConfig& config) {
  const Columns columns(points, config);
  std::vector<Eigen::Vector3d> kept;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p = point.cast<double>();
    const double away = p.head<2>().norm();
    const double tilted = config.max_slope * away;
    if (!(away < config.radius) || p.z() > tilted - config.min_height ||
        p.z() < -tilted - config.max_height) {
      continue;
    }
    if (columns.is_free(p)) kept.push_back(p);
  }
  return kept;
}

/// The lowest well-filled height [m] of the points within half the radius.
std::optional<double> lowest_mode(const std::vector<Eigen::Vector3d>& points,
                                  const FloorConfig& config) {
  const auto bins = static_cast<std::size_t>((config.max_height - config.min_height) / kBin) + 1;
  std::vector<int> counts(bins, 0);
  for (const Eigen::Vector3d& p : points) {
    const double down = -p.z() - config.min_height;
    if (down < 0.0 || p.head<2>().norm() > 0.5 * config.radius) continue;
    ++counts[std::min(bins - 1, static_cast<std::size_t>(down / kBin))];
  }
  const int most = *std::max_element(counts.begin(), counts.end());
  if (most == 0) return std::nullopt;
  std::size_t at = bins - 1;
  while (counts[at] < kLower * most) --at;
  return -(config.min_height + (static_cast<double>(at) + 0.5) * kBin);
}

/// Least squares over the points within `band` of `from`.
HeightFit refit(const std::vector<Eigen::Vector3d>& points, const HeightFit& from, double band) {
  HeightFit fit;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(from.over(p)) > band) continue;
    const Eigen::Vector3d row(1.0, p.x(), p.y());
    fit.information += row * row.transpose();
    sum += row * p.z();
    ++fit.points;
  }
  const Eigen::Matrix3d regular = fit.information + 1e-9 * Eigen::Matrix3d::Identity();
  fit.coefficients = regular.ldlt().solve(sum);
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(from.over(p)) <= band) fit.square_sum += fit.over(p) * fit.over(p);
  }
  return fit;
}

/// Least deviation [m] of the fitted points along any horizontal direction.
double spread(const HeightFit& fit) {
  const double n = fit.points;
  const Eigen::Vector2d mean = fit.information.block<2, 1>(1, 0) / n;
  const Eigen::Matrix2d scatter = fit.information.block<2, 2>(1, 1) / n - mean * mean.transpose();
  const double half_trace = 0.5 * scatter.trace();
  const double root = std::sqrt(std::max(half_trace * half_trace - scatter.determinant(), 0.0));
  return std::sqrt(std::max(half_trace - root, 0.0));
}

/// Largest of the medians of the parts' heights over the plane [m].
double bend_of(const std::vector<Eigen::Vector3d>& points, const HeightFit& fit, double radius) {
  std::array<std::vector<double>, kParts> parts;
  for (const Eigen::Vector3d& p : points) {
    const double over = fit.over(p);
    if (std::abs(over) > kBendReach) continue;
    const bool along = std::abs(p.x()) > std::abs(p.y());
    const bool positive = along ? p.x() > 0.0 : p.y() > 0.0;
    const bool far = p.head<2>().norm() > 0.5 * radius;
    const int part =
        4 * static_cast<int>(far) + 2 * static_cast<int>(along) + static_cast<int>(positive);
    parts[static_cast<std::size_t>(part)].push_back(over);
  }
  double largest = 0.0;
  for (std::vector<double>& part : parts) {
    if (part.size() < kFewestOfPart) continue;
    const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    std::nth_element(part.begin(), middle, part.end());
    largest = std::max(largest, std::abs(*middle));
  }
  return largest;
}

FloorPlane plane_of(const HeightFit& fit) {
  FloorPlane plane;
  const Eigen::Vector3d up(-fit.coefficients(1), -fit.coefficients(2), 1.0);
  const double scale = 1.0 / up.norm();
  plane.normal = scale * up;
  plane.height = -scale * fit.coefficients(0);
  plane.points = fit.points;
  plane.residual = std::sqrt(fit.square_sum / fit.points);
  const Eigen::Matrix3d covariance = plane.residual * plane.residual * fit.information.inverse();
  // To first order in the slopes of a plane that is about level.
  const Eigen::Matrix3d across =
      Eigen::Matrix3d::Identity() - plane.normal * plane.normal.transpose();
  plane.normal_covariance.topLeftCorner<2, 2>() = covariance.bottomRightCorner<2, 2>();
  plane.normal_covariance = across * plane.normal_covariance * across;
  return plane;
}

}  // namespace

std::optional<FloorPlane> fit_floor(std::span<const Eigen::Vector3f> points,
                                    const FloorConfig& config) {
  const std::vector<Eigen::Vector3d> candidates = below(points, config);
  if (candidates.size() < static_cast<std::size_t>(config.min_points)) return std::nullopt;
  const std::optional<double> mode = lowest_mode(candidates, config);
  if (!mode) return std::nullopt;
  HeightFit fit;
  fit.coefficients(0) = *mode;
  for (const double band : kWideBands) fit = refit(candidates, fit, band);
  // The last band is applied twice, so that the plane and its points agree.
  for (int i = 0; i < 2; ++i) fit = refit(candidates, fit, config.band);
  if (fit.points < config.min_points || spread(fit) < config.min_spread) return std::nullopt;
  if (fit.points < kLeastShare * static_cast<double>(candidates.size())) return std::nullopt;
  FloorPlane plane = plane_of(fit);
  if (!plane.normal.allFinite() || !(plane.residual <= config.max_residual)) return std::nullopt;
  if (plane.height < config.min_height || plane.height > config.max_height) return std::nullopt;
  plane.bend = bend_of(candidates, fit, config.radius);
  return plane;
}

}  // namespace aims
