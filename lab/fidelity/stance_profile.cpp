// SPDX-License-Identifier: BSD-3-Clause
#include "lab/fidelity/stance_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kStep = 1.0 / kStanceProfileRate;  ///< [s]
constexpr double kEdgeSpeed = 0.5;                  ///< of the slip at touchdown and lift-off [m/s]
constexpr double kSwingSpeed = 1.0;     ///< of the slip that a swinging foot exceeds [m/s]
constexpr double kTolerance = 0.25;     ///< of the real figure
constexpr double kSlipFloor = 0.1;      ///< smallest tolerance [m/s]
constexpr double kHeightFloor = 0.002;  ///< smallest tolerance [m]
constexpr double kLoadFloor = 0.1;      ///< smallest tolerance, of mid-stance

struct RealBin {
  StanceEvent event;
  double time;  ///< since the event [s]
  FootReading reading;
};

/// Of the Go1, whose slip is without the rolling of a foot of 22 mm.
constexpr RealBin kReal[] = {
    {StanceEvent::kTouchdown, -0.030, {2.31, 0.0354, 0.01}},
    {StanceEvent::kTouchdown, -0.020, {1.82, 0.0295, 0.02}},
    {StanceEvent::kTouchdown, -0.010, {1.12, 0.0226, 0.06}},
    {StanceEvent::kTouchdown, 0.000, {0.48, 0.0161, 0.14}},
    {StanceEvent::kTouchdown, 0.010, {-0.19, 0.0089, 0.26}},
    {StanceEvent::kTouchdown, 0.020, {-0.39, 0.0018, 0.54}},
    {StanceEvent::kTouchdown, 0.030, {-0.20, -0.0015, 0.88}},
    {StanceEvent::kTouchdown, 0.040, {-0.15, -0.0033, 1.16}},
    {StanceEvent::kTouchdown, 0.050, {-0.08, -0.0044, 1.39}},
    {StanceEvent::kTouchdown, 0.060, {0.05, -0.0044, 1.55}},
    {StanceEvent::kTouchdown, 0.070, {0.09, -0.0039, 1.61}},
    {StanceEvent::kTouchdown, 0.080, {0.07, -0.0034, 1.63}},
    {StanceEvent::kTouchdown, 0.090, {0.06, -0.0026, 1.57}},
    {StanceEvent::kTouchdown, 0.100, {0.06, -0.0017, 1.40}},
    {StanceEvent::kTouchdown, 0.110, {0.04, -0.0009, 1.23}},
    {StanceEvent::kTouchdown, 0.120, {0.01, -0.0004, 1.11}},
    {StanceEvent::kLiftOff, -0.120, {-0.03, 0.0008, 0.80}},
    {StanceEvent::kLiftOff, -0.110, {0.01, 0.0008, 0.81}},
    {StanceEvent::kLiftOff, -0.100, {0.06, 0.0007, 0.83}},
    {StanceEvent::kLiftOff, -0.090, {0.14, 0.0005, 0.86}},
    {StanceEvent::kLiftOff, -0.080, {0.25, -0.0000, 0.91}},
    {StanceEvent::kLiftOff, -0.070, {0.33, -0.0009, 0.99}},
    {StanceEvent::kLiftOff, -0.060, {0.30, -0.0020, 1.12}},
    {StanceEvent::kLiftOff, -0.050, {0.18, -0.0030, 1.25}},
    {StanceEvent::kLiftOff, -0.040, {0.10, -0.0031, 1.27}},
    {StanceEvent::kLiftOff, -0.030, {0.05, -0.0028, 1.10}},
    {StanceEvent::kLiftOff, -0.020, {-0.08, -0.0025, 0.98}},
    {StanceEvent::kLiftOff, -0.010, {0.02, -0.0021, 0.85}},
    {StanceEvent::kLiftOff, 0.000, {0.52, -0.0011, 0.68}},
    {StanceEvent::kLiftOff, 0.010, {1.07, 0.0013, 0.50}},
    {StanceEvent::kLiftOff, 0.020, {1.53, 0.0063, 0.27}},
    {StanceEvent::kLiftOff, 0.030, {2.11, 0.0128, 0.14}},
    {StanceEvent::kLiftOff, 0.040, {2.50, 0.0209, 0.09}},
    {StanceEvent::kLiftOff, 0.050, {2.62, 0.0309, 0.03}},
    {StanceEvent::kLiftOff, 0.060, {2.64, 0.0424, 0.01}},
};

JointVector angles_of(const LegOdometrySample& sample) {
  return Eigen::Map<const JointVector>(sample.joint_position.data());
}

FootReading reading_of(int leg, const LegMotion& motion, const TruthSample& truth,
                       const Pose& T_body_base, const LegGeometry& geometry) {
  const Pose T_world_base = truth.T_world_body * T_body_base;
  const Eigen::Vector3d rate_in_world = truth.T_world_body.rotation * truth.angular_velocity;
  const Eigen::Vector3d lever = T_world_base.translation - truth.T_world_body.translation;
  const Eigen::Vector3d velocity = truth.velocity + rate_in_world.cross(lever);
  const Eigen::Quaterniond R_base_world = T_world_base.rotation.conjugate();
  const Eigen::Vector3d up = R_base_world * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d slip_in_base =
      R_base_world * velocity - velocity_from_rolling_foot(leg, motion, up, geometry);
  const Eigen::Vector3d slip =
      yaw_rotation(-yaw_of(T_world_base.rotation)) * (T_world_base.rotation * slip_in_base);
  return {slip.x(), (T_world_base * foot_in_base(leg, motion.q, geometry)).z(), 0.0};
}

/// Indices of the readings about one stance of a foot.
struct Stance {
  std::size_t touchdown = 0;  ///< the first slower than `kEdgeSpeed`
  std::size_t lift_off = 0;   ///< the first faster than that again
};

using Series = std::vector<FootReading>;

/// Stances between two swings.
std::vector<Stance> stances_of(const Series& foot) {
  std::vector<Stance> stances;
  bool swings = false;
  std::optional<std::size_t> touchdown;
  std::size_t slow = 0;  // the last reading that was slower than the edge
  for (std::size_t i = 0; i < foot.size(); ++i) {
    if (foot[i].slip < kEdgeSpeed) {
      if (swings) touchdown = i;
      swings = false;
      slow = i;
    } else if (foot[i].slip > kSwingSpeed && !swings) {
      swings = true;
      if (touchdown) stances.push_back({*touchdown, slow + 1});
    }
  }
  return stances;
}

/// Mean of the readings in the middle third of a span.
FootReading middle_of(const Series& foot, std::size_t begin, std::size_t end) {
  const std::size_t third = (end - begin) / 3;
  FootReading sum;
  for (std::size_t i = begin + third; i < end - third; ++i) {
    sum.height += foot[i].height;
    sum.load += foot[i].load;
  }
  const auto count = static_cast<double>(end - begin - 2 * third);
  return {0.0, sum.height / count, sum.load / count};
}

/// Time by which the slip passes the edge before that reading, in readings.
double passed_before(const Series& foot, std::size_t index) {
  const double now = foot[index].slip - kEdgeSpeed;
  const double before = foot[index - 1].slip - kEdgeSpeed;
  return now / (now - before);
}

FootReading between(const Series& foot, double at) {
  const auto index = static_cast<std::size_t>(at);
  const double part = at - static_cast<double>(index);
  const FootReading& from = foot[index];
  const FootReading& to = foot[index + 1];
  return {from.slip + part * (to.slip - from.slip), from.height + part * (to.height - from.height),
          from.load + part * (to.load - from.load)};
}

/// Adds one stance to the sums of the profile; false when the readings do not reach around it.
bool add_stance(const Series& foot, const Stance& stance, std::size_t next_touchdown,
                std::vector<StanceBin>& profile) {
  const FootReading stand = middle_of(foot, stance.touchdown, stance.lift_off);
  const double zero = middle_of(foot, stance.lift_off, next_touchdown).load;
  std::vector<FootReading> values;
  for (const StanceBin& bin : profile) {
    const std::size_t index =
        bin.event == StanceEvent::kTouchdown ? stance.touchdown : stance.lift_off;
    const double at = static_cast<double>(index) - passed_before(foot, index) + bin.time / kStep;
    if (at < 0.0 || at + 1.0 >= static_cast<double>(foot.size())) return false;
    values.push_back(between(foot, at));
  }
  for (std::size_t i = 0; i < profile.size(); ++i) {
    FootReading& sum = profile[i].simulated;
    sum.slip += values[i].slip;
    sum.height += values[i].height - stand.height;
    sum.load += (values[i].load - zero) / (stand.load - zero);
  }
  return true;
}

double over_tolerance(double simulated, double real, double floor) {
  return std::abs(simulated - real) / std::max(floor, kTolerance * std::abs(real));
}

}  // namespace

std::vector<FeetReadings> foot_readings(const Truth& truth, std::span<const LegOdometrySample> legs,
                                        const LegGeometry& geometry) {
  const Pose T_body_base = truth.mounts.T_base_body.inverse();
  std::vector<FeetReadings> readings;
  auto motion = truth.samples.begin();
  for (std::size_t i = 1; i + 1 < legs.size(); ++i) {
    while (motion != truth.samples.end() && motion->stamp < legs[i].stamp) ++motion;
    if (motion == truth.samples.end()) break;
    const double span = to_seconds(legs[i + 1].stamp - legs[i - 1].stamp);
    const JointVector rate = (angles_of(legs[i + 1]) - angles_of(legs[i - 1])) / span;
    const Eigen::Vector3d turning = truth.mounts.T_base_body.rotation * motion->angular_velocity;
    FeetReadings feet;
    for (int leg = 0; leg < kLegCount; ++leg) {
      const LegMotion of_leg{joints_of(angles_of(legs[i]), leg), joints_of(rate, leg), turning};
      feet[leg] = reading_of(leg, of_leg, *motion, T_body_base, geometry);
      if (legs[i].contact_force) feet[leg].load = (*legs[i].contact_force)[leg];
    }
    readings.push_back(feet);
  }
  return readings;
}

std::optional<std::vector<StanceBin>> stance_profile(std::span<const FeetReadings> readings) {
  std::vector<StanceBin> profile;
  for (const RealBin& real : kReal) profile.push_back({real.event, real.time, {}, real.reading});
  double count = 0.0;
  for (int leg = 0; leg < kLegCount; ++leg) {
    Series foot;
    for (const FeetReadings& each : readings) foot.push_back(each[leg]);
    const std::vector<Stance> stances = stances_of(foot);
    for (std::size_t i = 0; i + 1 < stances.size(); ++i) {
      if (add_stance(foot, stances[i], stances[i + 1].touchdown, profile)) count += 1.0;
    }
  }
  if (count == 0.0) return std::nullopt;
  for (StanceBin& bin : profile) {
    bin.simulated.slip /= count;
    bin.simulated.height /= count;
    bin.simulated.load /= count;
  }
  return profile;
}

std::array<double, 3> stance_deviation(const StanceBin& bin) {
  return {over_tolerance(bin.simulated.slip, bin.real.slip, kSlipFloor),
          over_tolerance(bin.simulated.height, bin.real.height, kHeightFloor),
          over_tolerance(bin.simulated.load, bin.real.load, kLoadFloor)};
}

std::vector<StanceAgreement> stance_agreement(const std::vector<StanceBin>& profile) {
  std::vector<StanceAgreement> agreement = {{"slip speed"}, {"height"}, {"load"}};
  for (const StanceBin& bin : profile) {
    const std::array<double, 3> deviation = stance_deviation(bin);
    for (std::size_t i = 0; i < deviation.size(); ++i) {
      ++agreement[i].bins;
      if (deviation[i] <= 1.0) ++agreement[i].within;
      agreement[i].worst = std::max(agreement[i].worst, deviation[i]);
    }
  }
  return agreement;
}

TextTable stance_profile_table(const std::vector<StanceBin>& profile) {
  TextTable table;
  table.header = {"since", "ms",   "slip [m/s]", "real",   "height [mm]",
                  "real",  "load", "real",       "outside"};
  for (const StanceBin& bin : profile) {
    const std::array<double, 3> deviation = stance_deviation(bin);
    std::string outside;
    const char* names[] = {"slip ", "height ", "load "};
    for (std::size_t i = 0; i < deviation.size(); ++i) {
      if (deviation[i] > 1.0) outside += names[i];
    }
    table.rows.push_back(
        {bin.event == StanceEvent::kTouchdown ? "touchdown" : "lift-off",
         fmt::format("{:.0f}", 1e3 * bin.time), fmt::format("{:.2f}", bin.simulated.slip),
         fmt::format("{:.2f}", bin.real.slip), fmt::format("{:.1f}", 1e3 * bin.simulated.height),
         fmt::format("{:.1f}", 1e3 * bin.real.height), fmt::format("{:.2f}", bin.simulated.load),
         fmt::format("{:.2f}", bin.real.load), outside});
  }
  return table;
}

TextTable stance_agreement_table(const std::vector<StanceAgreement>& agreement) {
  TextTable table;
  table.header = {"quantity", "bins within", "largest difference over tolerance"};
  for (const StanceAgreement& each : agreement) {
    table.rows.push_back({each.quantity, fmt::format("{} of {}", each.within, each.bins),
                          fmt::format("{:.1f}", each.worst)});
  }
  return table;
}

}  // namespace aims
