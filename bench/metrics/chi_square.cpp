// SPDX-License-Identifier: BSD-3-Clause
#include "bench/metrics/chi_square.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <cassert>

namespace aims {

double chi_square_probability(double value, double dof) {
  assert(dof > 0.0);
  return value > 0.0 ? boost::math::cdf(boost::math::chi_squared(dof), value) : 0.0;
}

double chi_square_quantile(double probability, double dof) {
  assert(probability > 0.0 && probability < 1.0);
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

}  // namespace aims
