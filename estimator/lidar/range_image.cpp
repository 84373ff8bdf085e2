// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/range_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/lidar/float4.hpp"

namespace aims {
namespace {

constexpr float kEmpty = std::numeric_limits<float>::infinity();

/// Of 3 x 3 pixels, at least this many must have returns. Fewer do where the field of view ends:
/// returns of the outermost ring leave it when the robot pitches, and the ring beside it hits the
/// floor farther away.
constexpr int kMinFilled = 7;

/// The azimuth of (x, y) in turns, from 0 at -x, to 0.25 deg: an eighth of a turn is a parabola.
float azimuth_in_turns(float x, float y) {
  const float a = std::abs(x);
  const float b = std::abs(y);
  const float ratio = std::min(a, b) / std::max({a, b, std::numeric_limits<float>::min()});
  const float eighth = ratio * (0.125F + 0.0435F * (1.0F - ratio));
  const float quarter = b > a ? 0.25F - eighth : eighth;
  const float half = x < 0.0F ? quarter : 0.5F - quarter;
  return y < 0.0F ? half : 1.0F - half;
}

}  // namespace

RangeImage::RangeImage() : ranges_(kPixels, kEmpty), around_(kPixels, 0.0F), index_(kPixels) {}

std::size_t RangeImage::pixel_of(const Eigen::Vector3f& point, float range) {
  const float height = 0.5F * (1.0F + point.z() / range);
  const float turns = azimuth_in_turns(point.x(), point.y());
  const int column = std::clamp(static_cast<int>(kColumns * turns), 0, kColumns - 1);
  const int row = std::clamp(static_cast<int>(height * kRows), 0, kRows - 1);
  return static_cast<std::size_t>((row + 1) * kStride + column + 1);
}

void RangeImage::fill(std::span<const Eigen::Vector3f> points) {
  std::fill(ranges_.begin(), ranges_.end(), kEmpty);
  nearest_.clear();
  for (const Eigen::Vector3f& point : points) {
    const float range = point.norm();
    if (!(range > 0.0F)) continue;
    const std::size_t pixel = pixel_of(point, range);
    if (!(range < ranges_[pixel])) continue;
    if (ranges_[pixel] == kEmpty) {
      index_[pixel] = static_cast<std::uint16_t>(nearest_.size());
      nearest_.emplace_back();
    }
    ranges_[pixel] = range;
    nearest_[index_[pixel]] = point;
  }
  wrap_around();
  find_around();
}

/// Copies the first and last columns beyond each other.
void RangeImage::wrap_around() {
  for (std::size_t begin = 0; begin < kPixels; begin += kStride) {
    ranges_[begin] = ranges_[begin + kColumns];
    ranges_[begin + kColumns + 1] = ranges_[begin + 1];
  }
}

/// Four pixels of a row at a time.
void RangeImage::find_around() {
  static_assert(kColumns % 4 == 0);
  for (std::size_t row = 1; row <= kRows; ++row) {
    for (std::size_t column = 1; column <= kColumns; column += 4) {
      const float* const pixels = ranges_.data() + row * kStride + column;
      Float4 nearest = Float4{} + kEmpty;
      Int4 filled{};
      for (const float* middle : {pixels - kStride, pixels, pixels + kStride}) {
        for (const float* at : {middle - 1, middle, middle + 1}) {
          const Float4 ranges = load4(at);
          nearest = smaller(nearest, ranges);
          filled -= ranges < kEmpty;  // true is -1
        }
      }
      store4(filled >= kMinFilled ? nearest : Float4{}, &around_[row * kStride + column]);
    }
  }
}

bool RangeImage::passed(const Eigen::Vector3f& point, float margin) const {
  const float range = point.norm();
  return range > 0.0F && around_[pixel_of(point, range)] > range + margin;
}

bool RangeImage::confirms(const Eigen::Vector3f& point, float tolerance) const {
  const float range = point.norm();
  if (!(range > 0.0F)) return false;
  const std::size_t pixel = pixel_of(point, range);
  for (std::size_t begin = pixel - kStride - 1; begin <= pixel + kStride - 1; begin += kStride) {
    for (std::size_t i = begin; i < begin + 3; ++i) {
      if (std::abs(ranges_[i] - range) < tolerance) return true;
    }
  }
  return false;
}

}  // namespace aims
