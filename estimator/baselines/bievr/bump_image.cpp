// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/bievr/bump_image.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace aims::bievr {
namespace {

constexpr std::int64_t kMinPoints = 4;  ///< of a plane
constexpr int kMinPixels = 5;           ///< of a voxel that counts as informative
constexpr double kMaxWeight = 0.5;      ///< of a point, against near ones

/// Weights of smoothing by distance in columns plus rows: a Gaussian of deviation 0.8 pixels.
const std::array<float, 3> kSmoothing = {1.0F, std::exp(-0.78125F), std::exp(-1.5625F)};

float weight_of(const MapPoint& point, const MapConfig& config) {
  return config.weighted ? static_cast<float>(std::min(kMaxWeight, 1.0 / point.range)) : 1.0F;
}

Eigen::Vector3d normal_of(const BumpVoxel& voxel) {
  const Eigen::Vector3d mean = voxel.centroid();
  const Eigen::Matrix3d covariance =
      voxel.outer_sum / static_cast<double>(voxel.count) - mean * mean.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
}

}  // namespace

BumpImage::BumpImage(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal,
                     const Eigen::Vector3d& corner, const MapConfig& config)
    : pixel_(config.pixel) {
  const Eigen::Vector3d x = normal.unitOrthogonal();
  R_.row(0) = x;
  R_.row(1) = normal.cross(x);
  R_.row(2) = normal;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Eigen::Vector2d low(kFar, kFar);
  Eigen::Vector2d high = -low;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d offset(i % 2, i / 2 % 2, i / 4);
    const Eigen::Vector2d at = (R_ * (corner + config.voxel * offset - p_world)).head<2>();
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  t_ = -R_ * p_world - Eigen::Vector3d(low.x(), low.y(), 0.0);
  columns_ = static_cast<int>(std::ceil((high.x() - low.x()) / pixel_)) + 1;
  rows_ = static_cast<int>(std::ceil((high.y() - low.y()) / pixel_)) + 1;
  const auto size = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  heights_.assign(size, 0.0F);
  smoothed_.assign(size, 0.0F);
  weights_.assign(size, 0.0F);
}

bool BumpImage::inside(int column, int row) const {
  return column >= 0 && row >= 0 && column < columns_ && row < rows_;
}

std::size_t BumpImage::index(int column, int row) const {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(column);
}

Eigen::Vector3d BumpImage::in_world(int column, int row) const {
  const Eigen::Vector3d p_image(column * pixel_, row * pixel_, heights_[index(column, row)]);
  return R_.transpose() * (p_image - t_);
}

void BumpImage::add(const Eigen::Vector3d& p_world, float weight) {
  const Eigen::Vector3d at = in_image(p_world);
  const auto column = static_cast<int>(std::round(at.x() / pixel_));
  const auto row = static_cast<int>(std::round(at.y() / pixel_));
  if (!inside(column, row)) return;  // by rounding, at the edge of the voxel
  const std::size_t i = index(column, row);
  weights_[i] += weight;
  heights_[i] += weight / weights_[i] * (static_cast<float>(at.z()) - heights_[i]);
}

void BumpImage::project(const BumpImage& other) {
  for (int row = 0; row < other.rows_; ++row) {
    for (int column = 0; column < other.columns_; ++column) {
      const float weight = other.weights_[other.index(column, row)];
      if (weight == 0.0F) continue;
      const Eigen::Vector3d at = in_image(other.in_world(column, row));
      const auto x = static_cast<int>(std::round(at.x() / pixel_));
      const auto y = static_cast<int>(std::round(at.y() / pixel_));
      if (!inside(x, y)) continue;
      heights_[index(x, y)] = static_cast<float>(at.z());
      weights_[index(x, y)] = weight;
    }
  }
}

float BumpImage::smoothed_at(int column, int row) const {
  float sum = 0.0F;
  float weights = 0.0F;
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, rows_ - 1); ++y) {
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, columns_ - 1); ++x) {
      if (weights_[index(x, y)] == 0.0F) continue;
      const float weight =
          kSmoothing[static_cast<std::size_t>(std::abs(x - column) + std::abs(y - row))];
      sum += weight * heights_[index(x, y)];
      weights += weight;
    }
  }
  return sum / weights;
}

void BumpImage::smooth(bool enabled) {
  if (!enabled) {
    smoothed_ = heights_;
    return;
  }
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const std::size_t i = index(column, row);
      if (weights_[i] > 0.0F) smoothed_[i] = smoothed_at(column, row);
    }
  }
}

/// Between the pixel in a column and a row and the next ones, at `fraction` of the way to them.
std::optional<double> BumpImage::between(int column, int row,
                                         const Eigen::Vector2d& fraction) const {
  double sum = 0.0;
  double weights = 0.0;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 2; ++x) {
      const std::size_t i = index(column + x, row + y);
      if (weights_[i] == 0.0F) continue;
      const double weight = (x == 0 ? 1.0 - fraction.x() : fraction.x()) *
                            (y == 0 ? 1.0 - fraction.y() : fraction.y());
      sum += weight * smoothed_[i];
      weights += weight;
    }
  }
  return weights > 0.0 ? std::optional(sum / weights) : std::nullopt;
}

std::optional<double> BumpImage::height(const Eigen::Vector2d& at) const {
  const Eigen::Vector2d place = at / pixel_;
  const Eigen::Vector2d first = place.array().floor();
  const auto column = static_cast<int>(first.x());
  const auto row = static_cast<int>(first.y());
  if (!inside(column, row) || !inside(column + 1, row + 1)) return std::nullopt;
  return between(column, row, place - first);
}

std::optional<Height> BumpImage::sample(const Eigen::Vector2d& at) const {
  const auto value = height(at);
  if (!value) return std::nullopt;
  Height result{*value};
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = pixel_ * Eigen::Vector2d::Unit(axis);
    const auto ahead = height(at + step);
    const auto behind = height(at - step);
    if (ahead && behind) result.slope(axis) = (*ahead - *behind) / (2.0 * pixel_);
  }
  return result;
}

double BumpImage::relief() const {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    if (weights_[i] == 0.0F) continue;
    sum += std::abs(smoothed_[i]);
    ++count;
  }
  return count < kMinPixels ? 0.0 : sum / count;
}

void BumpImage::append_points(std::vector<Eigen::Vector3f>& points) const {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      if (weights_[index(column, row)] == 0.0F) continue;
      points.push_back(in_world(column, row).cast<float>());
    }
  }
}

void BumpVoxel::add(std::span<const MapPoint> points, const Eigen::Vector3d& corner,
                    const MapConfig& config) {
  for (const MapPoint& point : points) {
    sum += point.p_world;
    outer_sum += point.p_world * point.p_world.transpose();
    ++count;
  }
  if (count < kMinPoints) {
    pending.insert(pending.end(), points.begin(), points.end());
    return;
  }
  const Eigen::Vector3d normal = normal_of(*this);
  const double cosine = std::cos(config.normal_tolerance * std::numbers::pi / 180.0);
  if (!observed || std::abs(image.R_image_world().row(2).dot(normal)) < cosine) {
    BumpImage next(centroid(), normal, corner, config);
    next.project(image);
    image = std::move(next);
    observed = true;
  }
  for (const MapPoint& point : points) image.add(point.p_world, weight_of(point, config));
  for (const MapPoint& point : pending) image.add(point.p_world, weight_of(point, config));
  pending = {};
  image.smooth(config.smooth);
  relief = image.relief();
}

}  // namespace aims::bievr
