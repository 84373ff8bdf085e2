// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace aims {

/// Four numbers that one instruction takes side by side.
using Float4 = float __attribute__((vector_size(16)));
/// Four integers; as the result of a comparison -1 where it holds and 0 elsewhere.
using Int4 = std::int32_t __attribute__((vector_size(16)));

/// The smaller of each two, `b` where one is NaN; GCC makes four instructions of the comparison.
inline Float4 smaller(Float4 a, Float4 b) {
#ifdef __SSE2__
  return _mm_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}

/// The larger of each two, `b` where one is NaN.
inline Float4 larger(Float4 a, Float4 b) {
#ifdef __SSE2__
  return _mm_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}

/// Square roots.
inline Float4 square_root(Float4 a) {
#ifdef __SSE2__
  return _mm_sqrt_ps(a);
#else
  return Float4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
#endif
}

/// Magnitudes.
inline Float4 magnitude(Float4 a) { return larger(a, -a); }

/// Bit i: whether the comparison with the result `mask` holds in lane i.
inline unsigned lanes_of(Int4 mask) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(reinterpret_cast<__m128i>(mask))));
#else
  return static_cast<unsigned>(-(mask[0] | 2 * mask[1] | 4 * mask[2] | 8 * mask[3])) & 15U;
#endif
}

/// The integers towards zero.
inline Int4 truncated(Float4 a) { return __builtin_convertvector(a, Int4); }
inline Float4 to_float(Int4 a) { return __builtin_convertvector(a, Float4); }

/// The largest integers not above, which must fit.
inline Int4 floored(Float4 a) {
  const Int4 towards_zero = truncated(a);
  return towards_zero + (a < to_float(towards_zero));  // true is -1
}

/// The four numbers from `at` on.
inline Float4 load4(const float* at) {
  Float4 four;
  std::memcpy(&four, at, sizeof(four));
  return four;
}
inline Int4 load4(const std::int32_t* at) {
  Int4 four;
  std::memcpy(&four, at, sizeof(four));
  return four;
}

/// Stores them from `at` on.
inline void store4(Float4 four, float* at) { std::memcpy(at, &four, sizeof(four)); }
inline void store4(Int4 four, std::int32_t* at) { std::memcpy(at, &four, sizeof(four)); }

}  // namespace aims
