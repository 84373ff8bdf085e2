// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/ground/ground_plane.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace aims {
namespace {

/// Height of the body above the ground [m] and slope of the ground in body axes [-], of any legged
/// robot that stands upright.
constexpr double kMinHeight = 0.15;
constexpr double kMaxHeight = 1.2;
constexpr double kMaxSlope = 0.15;
/// Inliers of the plane are this close to it: twice the range noise of a spinning LiDAR [m].
constexpr double kBand = 0.04;
/// Smallest number, smallest deviation over all directions [m] and largest root mean square
/// distance [m] of the inliers of a plane.
constexpr int kMinPoints = 60;
constexpr double kMinSpread = 0.25;
constexpr double kMaxResidual = 0.015;
/// Height of the histogram bins [m].
constexpr double kBin = 0.06;
/// A lower bin with this fraction of the fullest one is taken as the ground [-].
constexpr double kLowerBinFraction = 0.5;
/// Bands about the plane before the last: wide, since the body may be tilted against the ground.
constexpr std::array<double, 2> kWideBands{0.20, 0.10};
/// Fraction of the candidate points that must be inliers; otherwise there are several planes [-].
constexpr double kMinInlierFraction = 0.7;
/// Parts of the ground: four sectors, each near and far.
constexpr int kParts = 8;
/// Parts with fewer points are not checked for a bend.
constexpr std::size_t kMinPointsOfPart = 12;
/// Points this far from the plane can belong to ground that bends away from it [m].
constexpr double kBendReach = 0.12;

/// Least-squares plane z = a + b x + c y.
struct HeightFit {
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the coefficients, of unit sigma
  int points = 0;
  double square_sum = 0.0;  ///< of the inlier residuals [m^2]

  double height_over(const Eigen::Vector3d& p) const {
    return p.z() - coefficients(0) - coefficients(1) * p.x() - coefficients(2) * p.y();
  }
};

/// Highest point per column of a square grid: columns with something on the ground hold walls,
/// furniture and legs.
class Columns {
 public:
  Columns(std::span<const Eigen::Vector3f> points, std::vector<double>& tops)
      : cells_(static_cast<int>(std::ceil(2.0 * kGroundRadius / kCell))), tops_(tops) {
    tops_.assign(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_), -kHigh);
    for (const Eigen::Vector3f& point : points) {
      const double z = point.z();
      if (!(z < kHigh) || !(point.head<2>().norm() < kGroundRadius)) continue;
      double& top = tops_[at(point.cast<double>())];
      top = std::max(top, z);
    }
  }

  /// Whether nothing stands above the point, which is one of those given at construction.
  bool is_free(const Eigen::Vector3d& p) const { return tops_[at(p)] - p.z() < kStanding; }

 private:
  static constexpr double kCell = 0.25;      ///< [m]
  static constexpr double kHigh = 0.8;       ///< ceilings are above it [m]
  static constexpr double kStanding = 0.12;  ///< more than this above a point stands on it [m]

  std::size_t at(const Eigen::Vector3d& p) const {
    const auto cell = [this](double x) {
      return std::clamp(static_cast<int>((x + kGroundRadius) / kCell), 0, cells_ - 1);
    };
    return static_cast<std::size_t>(cell(p.x()) * cells_ + cell(p.y()));
  }

  int cells_;
  std::vector<double>& tops_;  ///< [m]
};

/// Candidate ground points: near enough, below the body, and with nothing on them.
void list_candidates(std::span<const Eigen::Vector3f> points, GroundLists& lists) {
  constexpr double kHighest = kMaxSlope * kGroundRadius - kMinHeight;
  const Columns columns(points, lists.tops);
  lists.candidates.clear();
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p = point.cast<double>();
    if (p.z() > kHighest) continue;
    const double away = p.head<2>().norm();
    const double tilted = kMaxSlope * away;
    if (!(away < kGroundRadius) || p.z() > tilted - kMinHeight || p.z() < -tilted - kMaxHeight) {
      continue;
    }
    if (columns.is_free(p)) lists.candidates.push_back(p);
  }
}

/// The lowest well-filled height [m] of the points within half the radius.
std::optional<double> lowest_mode(const std::vector<Eigen::Vector3d>& points) {
  constexpr auto bins = static_cast<std::size_t>((kMaxHeight - kMinHeight) / kBin) + 1;
  std::array<int, bins> counts{};
  for (const Eigen::Vector3d& p : points) {
    const double down = -p.z() - kMinHeight;
    if (down < 0.0 || p.head<2>().norm() > 0.5 * kGroundRadius) continue;
    ++counts[std::min(bins - 1, static_cast<std::size_t>(down / kBin))];
  }
  const int most = *std::max_element(counts.begin(), counts.end());
  if (most == 0) return std::nullopt;
  std::size_t at = bins - 1;
  while (counts[at] < kLowerBinFraction * most) --at;
  return -(kMinHeight + (static_cast<double>(at) + 0.5) * kBin);
}

/// Least squares over the points within `band` of `from`.
HeightFit refit(const std::vector<Eigen::Vector3d>& points, const HeightFit& from, double band) {
  HeightFit fit;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(from.height_over(p)) > band) continue;
    const Eigen::Vector3d row(1.0, p.x(), p.y());
    fit.information += row * row.transpose();
    sum += row * p.z();
    ++fit.points;
  }
  const Eigen::Matrix3d regular = fit.information + 1e-9 * Eigen::Matrix3d::Identity();
  fit.coefficients = regular.ldlt().solve(sum);
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(from.height_over(p)) <= band)
      fit.square_sum += fit.height_over(p) * fit.height_over(p);
  }
  return fit;
}

/// Smallest deviation [m] of the inliers over all horizontal directions.
double spread(const HeightFit& fit) {
  const double n = fit.points;
  const Eigen::Vector2d mean = fit.information.block<2, 1>(1, 0) / n;
  const Eigen::Matrix2d scatter = fit.information.block<2, 2>(1, 1) / n - mean * mean.transpose();
  const double half_trace = 0.5 * scatter.trace();
  const double root = std::sqrt(std::max(half_trace * half_trace - scatter.determinant(), 0.0));
  return std::sqrt(std::max(half_trace - root, 0.0));
}

/// The part of the ground to which a point belongs.
int part_of(const Eigen::Vector3d& p, double radius) {
  const bool along = std::abs(p.x()) > std::abs(p.y());
  const bool positive = along ? p.x() > 0.0 : p.y() > 0.0;
  const bool far = p.head<2>().norm() > 0.5 * radius;
  return 4 * static_cast<int>(far) + 2 * static_cast<int>(along) + static_cast<int>(positive);
}

/// Largest median height of a part over the plane [m].
double bend_of(GroundLists& lists, const HeightFit& fit, double radius) {
  double largest = 0.0;
  std::vector<double>& heights = lists.heights;
  for (int part = 0; part < kParts; ++part) {
    heights.clear();
    for (const Eigen::Vector3d& p : lists.candidates) {
      const double height = fit.height_over(p);
      if (std::abs(height) <= kBendReach && part_of(p, radius) == part) heights.push_back(height);
    }
    if (heights.size() < kMinPointsOfPart) continue;
    const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
    std::nth_element(heights.begin(), middle, heights.end());
    largest = std::max(largest, std::abs(*middle));
  }
  return largest;
}

GroundPlane plane_of(const HeightFit& fit) {
  GroundPlane plane;
  const Eigen::Vector3d up(-fit.coefficients(1), -fit.coefficients(2), 1.0);
  const double scale = 1.0 / up.norm();
  plane.normal = scale * up;
  plane.height = -scale * fit.coefficients(0);
  plane.points = fit.points;
  plane.residual = std::sqrt(fit.square_sum / fit.points);
  const Eigen::Matrix3d covariance = plane.residual * plane.residual * fit.information.inverse();
  plane.height_variance = covariance(0, 0);
  // To first order in the slopes of a plane that is about level.
  const Eigen::Matrix3d across =
      Eigen::Matrix3d::Identity() - plane.normal * plane.normal.transpose();
  plane.normal_covariance.topLeftCorner<2, 2>() = covariance.bottomRightCorner<2, 2>();
  plane.normal_covariance = across * plane.normal_covariance * across;
  return plane;
}

}  // namespace

void describe(Fields& f, GroundConstraintConfig& c) {
  f.flag("enabled", c.enabled, {"", any(), "constrain height and tilt by level ground"});
  f.number("sigma_height", c.sigma_height,
           {"m", positive_up_to(1e4), "unevenness of level ground",
            "DIN 18202: 15 mm over 15 m, as three sigma"});
  f.number("sigma_slope", c.sigma_slope,
           {"rad", positive_up_to(10.0), "slope of ramps, 1 sigma",
            "accessible ramps: 8 %, as two sigma"});
}

std::optional<GroundPlane> fit_ground(std::span<const Eigen::Vector3f> points, GroundLists& lists) {
  list_candidates(points, lists);
  const std::vector<Eigen::Vector3d>& candidates = lists.candidates;
  if (candidates.size() < static_cast<std::size_t>(kMinPoints)) return std::nullopt;
  const std::optional<double> mode = lowest_mode(candidates);
  if (!mode) return std::nullopt;
  HeightFit fit;
  fit.coefficients(0) = *mode;
  for (const double band : kWideBands) fit = refit(candidates, fit, band);
  // The last band is applied twice, so that the plane fits its own inliers.
  for (int i = 0; i < 2; ++i) fit = refit(candidates, fit, kBand);
  if (fit.points < kMinPoints || spread(fit) < kMinSpread) return std::nullopt;
  if (fit.points < kMinInlierFraction * static_cast<double>(candidates.size())) return std::nullopt;
  GroundPlane plane = plane_of(fit);
  if (!plane.normal.allFinite() || !(plane.residual <= kMaxResidual)) return std::nullopt;
  if (plane.height < kMinHeight || plane.height > kMaxHeight) return std::nullopt;
  plane.bend = bend_of(lists, fit, kGroundRadius);
  return plane;
}

}  // namespace aims
