// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/range_image.hpp"

#include <algorithm>
#include <bit>
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

/// The azimuths of (x, y) in turns, from 0 at -x, to 0.25 deg: an eighth of a turn is a parabola.
Float4 azimuths_in_turns(Float4 x, Float4 y) {
  const Float4 a = magnitude(x);
  const Float4 b = magnitude(y);
  const Float4 tiny = Float4{} + std::numeric_limits<float>::min();
  const Float4 ratio = smaller(a, b) / larger(larger(a, b), tiny);
  const Float4 eighth = ratio * (0.125F + 0.0435F * (1.0F - ratio));
  const Float4 quarter = b > a ? 0.25F - eighth : eighth;
  const Float4 half = x < 0.0F ? quarter : 0.5F - quarter;
  return y < 0.0F ? half : 1.0F - half;
}

/// The integers in [0, count) towards zero; 0 for a NaN.
Float4 clamped(Float4 value, int count) {
  return smaller(larger(value, Float4{}), Float4{} + static_cast<float>(count - 1));
}

}  // namespace

RangeImage::RangeImage() : ranges_(kPixels, kEmpty), around_(kPixels, 0.0F), index_(kPixels) {}

Int4 RangeImage::pixels_of(const FourPoints& points, Float4 ranges) {
  const Float4 heights = 0.5F * (1.0F + points.z / ranges);
  const Float4 turns = azimuths_in_turns(points.x, points.y);
  const Int4 column = truncated(clamped(turns * static_cast<float>(kColumns), kColumns));
  const Int4 row = truncated(clamped(heights * static_cast<float>(kRows), kRows));
  // SSE2 has no product of integers; these floats are exact.
  return truncated(to_float(row) * static_cast<float>(kStride)) + column + (kStride + 1);
}

void RangeImage::fill(const PointBlocks& points) {
  std::fill(ranges_.begin(), ranges_.end(), kEmpty);
  for (std::size_t i = 0; i < points.block_count(); ++i) {
    const FourPoints block = points.block(i);
    const Float4 ranges = square_root(block.squared_norms());
    const Int4 pixels = pixels_of(block, ranges);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const auto pixel = static_cast<std::size_t>(pixels[lane]);
      const bool nearer = ranges[lane] > 0.0F && ranges[lane] < ranges_[pixel];
      ranges_[pixel] = nearer ? ranges[lane] : ranges_[pixel];
      index_[pixel] = nearer ? static_cast<std::int32_t>(4 * i + lane) : index_[pixel];
    }
  }
  list_nearest(points);
  wrap_around();
  find_around();
}

/// Four pixels of a row at a time, as find_around().
void RangeImage::list_nearest(const PointBlocks& points) {
  static_assert(kColumns % 4 == 0);
  nearest_.clear();
  for (std::size_t row = 1; row <= kRows; ++row) {
    for (std::size_t column = 1; column <= kColumns; column += 4) {
      const std::size_t first = row * kStride + column;
      unsigned lanes = lanes_of(load4(&ranges_[first]) < kEmpty);
      for (; lanes != 0; lanes &= lanes - 1) {
        const std::size_t pixel = first + static_cast<std::size_t>(std::countr_zero(lanes));
        nearest_.push_back(points.point(static_cast<std::size_t>(index_[pixel])));
      }
    }
  }
}

/// Copies the first and last columns beyond each other.
void RangeImage::wrap_around() {
  for (std::size_t begin = 0; begin < kPixels; begin += kStride) {
    ranges_[begin] = ranges_[begin + kColumns];
    ranges_[begin + kColumns + 1] = ranges_[begin + 1];
  }
}

void RangeImage::find_around() {
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

unsigned RangeImage::passed(const FourPoints& points, float margin) const {
  const Float4 ranges = square_root(points.squared_norms());
  const Int4 pixels = pixels_of(points, ranges);
  Float4 around;
  for (std::size_t i = 0; i < 4; ++i) around[i] = around_[static_cast<std::size_t>(pixels[i])];
  return lanes_of((ranges > 0.0F) & (around > ranges + margin));
}

bool RangeImage::confirms(const Eigen::Vector3f& point, float tolerance) const {
  const float range = point.norm();
  if (!(range > 0.0F)) return false;
  FourPoints block;
  block.set(0, point);
  const auto pixel = static_cast<std::size_t>(pixels_of(block, Float4{} + range)[0]);
  for (std::size_t begin = pixel - kStride - 1; begin <= pixel + kStride - 1; begin += kStride) {
    for (std::size_t i = begin; i < begin + 3; ++i) {
      if (std::abs(ranges_[i] - range) < tolerance) return true;
    }
  }
  return false;
}

}  // namespace aims
