// SPDX-License-Identifier: BSD-3-Clause
#include "eval/chi_square.hpp"

#include <cassert>
#include <cmath>

namespace aims {
namespace {

constexpr int kMostTerms = 10000;
constexpr double kPrecision = 1e-14;

/// Regularised lower incomplete gamma function P(a, x) by its power series; converges well for
/// x < a + 1 (Abramowitz and Stegun, 6.5.29).
double lower_gamma_by_series(double a, double x) {
  double term = 1.0 / a;
  double sum = term;
  for (int n = 1; n < kMostTerms && term > kPrecision * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// 1 - P(a, x) by its continued fraction, evaluated by Lentz's method; converges well for
/// x > a + 1 (Abramowitz and Stegun, 6.5.31).
double upper_gamma_by_fraction(double a, double x) {
  constexpr double kTiny = 1e-300;
  double b = x + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double fraction = d;
  for (int n = 1; n < kMostTerms; ++n) {
    const double numerator = -n * (n - a);
    b += 2.0;
    d = numerator * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    d = 1.0 / d;
    c = b + numerator / c;
    if (std::abs(c) < kTiny) c = kTiny;
    fraction *= c * d;
    if (std::abs(c * d - 1.0) < kPrecision) break;
  }
  return fraction * std::exp(a * std::log(x) - x - std::lgamma(a));
}

}  // namespace

double chi_square_probability(double value, double dof) {
  assert(dof > 0.0);
  if (!(value > 0.0)) return 0.0;
  const double a = 0.5 * dof;
  const double x = 0.5 * value;
  return x < a + 1.0 ? lower_gamma_by_series(a, x) : 1.0 - upper_gamma_by_fraction(a, x);
}

double chi_square_quantile(double probability, double dof) {
  assert(probability > 0.0 && probability < 1.0);
  double low = 0.0;
  double high = dof + 1.0;
  while (chi_square_probability(high, dof) < probability) high *= 2.0;
  for (int i = 0; i < 200 && high - low > 1e-10 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (chi_square_probability(middle, dof) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace aims
