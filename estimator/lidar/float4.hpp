// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace aims {

/// Four numbers that one instruction takes side by side.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

/// The smaller of each two; GCC makes four instructions of the comparison.
inline Float4 smaller(Float4 a, Float4 b) {
#ifdef __SSE__
  return _mm_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}

/// The larger of each two.
inline Float4 larger(Float4 a, Float4 b) {
#ifdef __SSE__
  return _mm_max_ps(a, b);
#else
  return a < b ? b : a;
#endif
}

/// The four numbers from `at` on.
inline Float4 load4(const float* at) {
  Float4 four;
  std::memcpy(&four, at, sizeof(four));
  return four;
}

/// Stores them from `at` on.
inline void store4(Float4 four, float* at) { std::memcpy(at, &four, sizeof(four)); }

}  // namespace aims
