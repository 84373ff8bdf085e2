// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>

#include "core/leg_kinematics.hpp"
#include "core/measurements.hpp"

namespace aims::test {

inline const LegGeometry kTrotGeometry = {0.188, 0.047, 0.08, 0.213, 0.213, 0.022};

/// A robot that trots at 0.4 m/s forwards and turns at `rate`; FL and RR stand first.
struct Trot {
  double rate = 0.0;       ///< [rad/s]
  double knee_sign = 1.0;  ///< of the recorded knees
  LegGeometry geometry = kTrotGeometry;
  double height = 0.3;              ///< of the base [m]
  bool hind_knees_forward = false;  ///< as of an ANYmal

  static constexpr double kPeriod = 0.5;  ///< of a step [s]
  static constexpr double kSpeed = 0.4;   ///< [m/s]

  std::array<bool, kLegCount> contact(double time) const {
    const bool first = std::fmod(time, kPeriod) < 0.5 * kPeriod;
    return {first, !first, !first, first};
  }

  /// The foot in the base [m].
  Eigen::Vector3d foot(int leg, double time) const {
    const bool stands = contact(time)[static_cast<std::size_t>(leg)];
    const double phase = std::fmod(time, 0.5 * kPeriod) - 0.25 * kPeriod;  // of the half period
    Eigen::Vector3d foot = hip_in_base(leg, geometry);
    foot.y() += side_of(leg) * geometry.abduction;
    const Eigen::Vector3d velocity(kSpeed - rate * foot.y(), rate * foot.x(), 0.0);
    const double back = stands ? -phase : phase;
    return foot + back * velocity - Eigen::Vector3d(0.0, 0.0, stands ? height : height - 0.05);
  }

  JointVector angles(double time) const {
    JointVector q;
    for (int leg = 0; leg < kLegCount; ++leg) {
      Eigen::Vector3d place = foot(leg, time);
      const bool forward = hind_knees_forward && leg >= 2;
      if (forward) place.x() = 2.0 * hip_in_base(leg, geometry).x() - place.x();
      q.segment<3>(3 * leg) = leg_angles(leg, place, geometry);
      if (forward) q.segment<2>(3 * leg + 1) *= -1.0;
      q[3 * leg + 2] *= knee_sign;
    }
    return q;
  }

  JointVector rates(double time) const {
    constexpr double kStep = 1e-5;
    return (angles(time + kStep) - angles(time - kStep)) / (2.0 * kStep);
  }
};

}  // namespace aims::test
