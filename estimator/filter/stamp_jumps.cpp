// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/filter/stamp_jumps.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

/// Stamp minus arrival [s]. In floating point: the difference of any two stamps is representable.
double advance_of(const Delivery& delivery) {
  return 1e-9 * (static_cast<double>(stamp_of(delivery.measurement)) -
                 static_cast<double>(delivery.arrival));
}

}  // namespace

bool StampJumps::jumps(const Delivery& delivery) const {
  if (!largest_advance_) return hold_first_;
  return advance_of(delivery) > *largest_advance_ + kMaxAdvance;
}

bool StampJumps::continues_held(const Delivery& delivery) const {
  return std::abs(advance_of(delivery) - advance_of(*held_)) <= kMaxAdvance;
}

void StampJumps::accept(const Delivery& delivery, std::vector<Delivery>& good) {
  const double advance = advance_of(delivery);
  largest_advance_ = largest_advance_ ? std::max(*largest_advance_, advance) : advance;
  good.push_back(delivery);
}

void StampJumps::take(const Delivery& delivery, std::vector<Delivery>& good) {
  if (held_) {
    const Delivery held = *held_;
    held_.reset();
    if (continues_held(delivery)) {
      if (largest_advance_) ++clock_jumps_;
      accept(held, good);
    } else {
      ++dropped_;
    }
  }
  if (jumps(delivery)) {
    held_ = delivery;
  } else {
    accept(delivery, good);
  }
}

}  // namespace aims
