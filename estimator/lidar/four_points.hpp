// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <vector>

#include "estimator/lidar/float4.hpp"

namespace aims {

/// Four points side by side [m].
struct FourPoints {
  Float4 x{};
  Float4 y{};
  Float4 z{};

  /// Four times a point whose coordinates all are `value`.
  static FourPoints all(float value) {
    return {Float4{} + value, Float4{} + value, Float4{} + value};
  }

  Eigen::Vector3f point(std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(std::size_t lane, const Eigen::Vector3f& point) {
    x[lane] = point.x();
    y[lane] = point.y();
    z[lane] = point.z();
  }

  FourPoints minus(const Eigen::Vector3f& t) const { return {x - t.x(), y - t.y(), z - t.z()}; }
  Float4 squared_norms() const { return x * x + y * y + z * z; }
  /// To `query` [m^2].
  Float4 squared_distances(const Eigen::Vector3f& query) const {
    return minus(query).squared_norms();
  }
  /// R p + t of each.
  FourPoints transformed(const Eigen::Matrix3f& R, const Eigen::Vector3f& t) const {
    return {R(0, 0) * x + R(0, 1) * y + R(0, 2) * z + t.x(),
            R(1, 0) * x + R(1, 1) * y + R(1, 2) * z + t.y(),
            R(2, 0) * x + R(2, 1) * y + R(2, 2) * z + t.z()};
  }
};

/// A list of points, coordinate by coordinate, read in blocks of four. The lanes of the last block
/// without a point are NaN, with which no comparison holds.
class PointBlocks {
 public:
  std::size_t size() const { return size_; }
  std::size_t block_count() const { return (size_ + 3) / 4; }

  void clear() { size_ = 0; }

  void push_back(const Eigen::Vector3f& point) {
    if (size_ % 4 == 0) add_block();
    set(size_++, point);
  }

  void set(std::size_t i, const Eigen::Vector3f& point) {
    x_[i] = point.x();
    y_[i] = point.y();
    z_[i] = point.z();
  }

  Eigen::Vector3f point(std::size_t i) const { return {x_[i], y_[i], z_[i]}; }

  FourPoints block(std::size_t i) const {
    return {load4(&x_[4 * i]), load4(&y_[4 * i]), load4(&z_[4 * i])};
  }

  /// Moves all points by -t.
  void subtract(const Eigen::Vector3f& t) {
    for (std::size_t i = 0; i < block_count(); ++i) set_block(i, block(i).minus(t));
  }

 private:
  void add_block() {
    if (x_.size() == size_) {
      for (std::vector<float>* each : {&x_, &y_, &z_}) each->resize(2 * size_ + 4);
    }
    set_block(size_ / 4, FourPoints::all(std::numeric_limits<float>::quiet_NaN()));
  }
  void set_block(std::size_t i, const FourPoints& points) {
    store4(points.x, &x_[4 * i]);
    store4(points.y, &y_[4 * i]);
    store4(points.z, &z_[4 * i]);
  }

  std::vector<float> x_;  ///< with room for more than size()
  std::vector<float> y_;
  std::vector<float> z_;
  std::size_t size_ = 0;
};

}  // namespace aims
