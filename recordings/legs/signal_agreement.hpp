// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace aims {

/// How two signals that should be the same agree.
class SignalAgreement {
 public:
  void add(double first, double second) {
    if (!std::isfinite(first) || !std::isfinite(second)) return;
    ++count_;
    first_squared_ += first * first;
    second_squared_ += second * second;
    product_ += first * second;
  }

  int count() const { return count_; }

  /// About zero.
  double correlation() const {
    const double both = first_squared_ * second_squared_;
    return both > 0.0 ? product_ / std::sqrt(both) : 0.0;
  }

  /// Of the first to the second, by least squares.
  double scale() const { return second_squared_ > 0.0 ? product_ / second_squared_ : 0.0; }

 private:
  int count_ = 0;
  double first_squared_ = 0.0, second_squared_ = 0.0, product_ = 0.0;
};

}  // namespace aims
