// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/robot_geometry.hpp"

#include <cmath>

#include "core/random.hpp"

namespace aims {

LegGeometries built_legs(const LegGeometry& drawn, const BuildErrors& errors,
                         std::uint64_t run_seed) {
  RandomStream random(run_seed, "leg.lengths");
  const double sigma = errors.link_length * std::sqrt(0.5);
  const double thigh = sigma * random.normal();
  const double calf = sigma * random.normal();
  LegGeometries legs = {drawn, drawn, drawn, drawn};
  for (LegGeometry& leg : legs) {
    leg.thigh *= 1.0 + thigh + sigma * random.normal();
    leg.calf *= 1.0 + calf + sigma * random.normal();
    leg.foot_radius += errors.foot_radius;
  }
  return legs;
}

}  // namespace aims
