// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace aims {
namespace {

constexpr double kMaxDifference = 1.0;  ///< of two feet that counts, at most [m/s]
constexpr double kLeastLift = -0.004;   ///< of a foot that steps [m]
constexpr double kSameVelocity = 0.05;  ///< relative difference of velocities

/// The orders in use come first.
std::vector<Legs> all_orders(bool pairs_first) {
  std::vector<Legs> orders = {{0, 1, 2, 3}, {1, 0, 3, 2}, {0, 2, 1, 3}, {1, 3, 0, 2},
                              {2, 3, 0, 1}, {3, 2, 1, 0}, {2, 0, 3, 1}, {3, 1, 2, 0}};
  // Joints as pairs of hip and knee before the abductions: left legs first, then right ones.
  if (pairs_first) std::swap(orders[0], orders[2]);
  Legs each = {0, 1, 2, 3};
  do {
    if (std::ranges::find(orders, each) == orders.end()) orders.push_back(each);
  } while (std::ranges::next_permutation(each).found);
  return orders;
}

/// Whether the slot stands in that row.
bool stands(const LegEvidence& row, const LegCandidate& candidate, std::size_t slot) {
  const auto entry = std::ranges::find(candidate.leg_of_entry, candidate.leg_of_slot[slot]);
  return row.contact[static_cast<std::size_t>(entry - candidate.leg_of_entry.begin())];
}

/// How much higher the feet are in contact than without [m]: negative where contacts and legs
/// match.
double lift_of(const std::vector<LegEvidence>& rows, const LegCandidate& candidate) {
  double lift = 0.0;
  for (std::size_t slot = 0; slot < 4; ++slot) {
    std::array<double, 2> sum{}, count{};
    for (const LegEvidence& row : rows) {
      const std::size_t state = stands(row, candidate, slot) ? 1 : 0;
      sum[state] += row.height[slot][static_cast<std::size_t>(candidate.leg_of_slot[slot])];
      ++count[state];
    }
    if (count[0] > 0.0 && count[1] > 0.0) lift += 0.25 * (sum[1] / count[1] - sum[0] / count[0]);
  }
  return lift;
}

double disagreement_of(const std::vector<LegEvidence>& rows, const LegCandidate& candidate) {
  double sum = 0.0;
  std::size_t pairs = 0;
  for (const LegEvidence& row : rows) {
    for (std::size_t a = 0; a < 4; ++a) {
      if (!stands(row, candidate, a)) continue;
      const auto leg_a = static_cast<std::size_t>(candidate.leg_of_slot[a]);
      for (std::size_t b = 0; b < a; ++b) {
        if (!stands(row, candidate, b)) continue;
        const auto leg_b = static_cast<std::size_t>(candidate.leg_of_slot[b]);
        const double apart = (row.velocity[a][leg_a] - row.velocity[b][leg_b]).norm();
        sum += std::pow(std::min(apart, kMaxDifference), 2);
        ++pairs;
      }
    }
  }
  return pairs > 0 ? sum / static_cast<double>(pairs) : 0.0;
}

}  // namespace

std::vector<LegCandidate> leg_candidates(const std::vector<LegEvidence>& rows, bool joints_known,
                                         bool feet_known, bool pairs_first) {
  const std::vector<Legs> orders = all_orders(pairs_first);
  const std::vector<Legs> feet = all_orders(false);
  std::vector<LegCandidate> candidates;
  std::vector<double> lifts;
  for (const Legs& slots : joints_known ? std::vector<Legs>{{0, 1, 2, 3}} : orders) {
    for (const Legs& entries : feet_known ? std::vector<Legs>{{0, 1, 2, 3}} : feet) {
      candidates.push_back({slots, entries, 0.0});
      candidates.back().disagreement = disagreement_of(rows, candidates.back());
      lifts.push_back(lift_of(rows, candidates.back()));
    }
  }
  // Feet of a trot that swing together agree as well as those that stand, but they are higher.
  const double lowest = std::ranges::min(lifts);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (lowest < kLeastLift && lifts[i] > 0.5 * lowest) {
      candidates[i].disagreement += kMaxDifference * kMaxDifference;
    }
  }
  return candidates;
}

std::vector<Eigen::Vector3d> velocities(const std::vector<LegEvidence>& rows,
                                        const LegCandidate& candidate) {
  std::vector<Eigen::Vector3d> result;
  for (const LegEvidence& row : rows) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int feet = 0;
    for (std::size_t slot = 0; slot < 4; ++slot) {
      if (!stands(row, candidate, slot)) continue;
      sum += row.velocity[slot][static_cast<std::size_t>(candidate.leg_of_slot[slot])];
      ++feet;
    }
    result.push_back(feet > 0 ? Eigen::Vector3d(sum / feet) : Eigen::Vector3d::Zero());
  }
  return result;
}

bool same_velocity(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double apart = 0.0, speed = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    apart += (a[i] - b[i]).squaredNorm();
    speed += a[i].squaredNorm();
  }
  return apart <= std::pow(kSameVelocity, 2) * speed;
}

}  // namespace aims
