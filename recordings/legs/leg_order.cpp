// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_order.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "recordings/legs/contact_detector.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxRows = 60'000;
constexpr std::size_t kComparedRows = 1500;
constexpr std::size_t kMinRows = 20;
constexpr std::size_t kMaxUnchanged = 200;  ///< rows of a robot at rest
constexpr double kMovingRate = 0.05;        ///< [rad/s]
constexpr Duration kMaxStep = kSecond / 5;  ///< between rows that are differenced
constexpr double kLeastKnee = 0.4;          ///< bend of a knee, at least [rad]
constexpr double kKindGap = 0.1;          ///< between the mean angles of two kinds, at least [rad]
constexpr double kMaxDifference = 1.0;    ///< of two feet that counts, at most [m/s]
constexpr double kSameAgreement = 1.5;    ///< ratio of mean squares that does not decide
constexpr double kAgreementFloor = 1e-4;  ///< mean square that does not decide [m^2/s^2]
constexpr double kLeastLift = -0.004;     ///< of a foot that steps [m]
constexpr double kSameVelocity = 0.05;    ///< relative difference of velocities

/// Legs by slot, or by entry of the contacts.
using Legs = std::array<int, kLegCount>;

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

/// Indices of the abductions, hips and knees, each in the order of the array.
using Kinds = std::array<std::array<std::size_t, kLegCount>, 3>;

Result<Kinds> kinds_of(const JointVector& mean) {
  std::array<std::size_t, kJointCount> by_angle{};
  std::iota(by_angle.begin(), by_angle.end(), 0);
  const auto angle = [&mean](std::size_t i) { return mean[static_cast<Eigen::Index>(i)]; };
  std::ranges::sort(by_angle, {}, angle);
  const bool apart = angle(by_angle[3]) < -kLeastKnee &&
                     angle(by_angle[4]) - angle(by_angle[3]) > kKindGap &&
                     angle(by_angle[8]) - angle(by_angle[7]) > kKindGap;
  if (!apart) {
    std::vector<std::string> angles;
    for (const double each : mean) angles.push_back(fmt::format("{:.2f}", each));
    return failure(
        fmt::format("their mean angles [{}] rad are not those of four bent knees (negative), four "
                    "abductions (near 0) and four hips (positive)",
                    fmt::join(angles, ", ")));
  }
  Kinds kinds{};
  constexpr std::array<std::size_t, 3> kRank = {1, 2, 0};  // of abduction, hip, knee
  for (std::size_t kind = 0; kind < 3; ++kind) {
    std::copy_n(by_angle.begin() + static_cast<std::ptrdiff_t>(4 * kRank[kind]), 4,
                kinds[kind].begin());
    std::ranges::sort(kinds[kind]);
  }
  return kinds;
}

/// The slots of joints that are known: slot and leg are the same.
Kinds kinds_of(const JointOrder& order) {
  Kinds kinds{};
  for (std::size_t i = 0; i < order.size(); ++i) kinds[i % 3][i / 3] = order[i];
  return kinds;
}

JointOrder order_of(const Kinds& kinds, const Legs& leg_of_slot) {
  JointOrder order{};
  for (std::size_t slot = 0; slot < kinds[0].size(); ++slot) {
    for (std::size_t kind = 0; kind < 3; ++kind) {
      order[3 * static_cast<std::size_t>(leg_of_slot[slot]) + kind] = kinds[kind][slot];
    }
  }
  return order;
}

/// What one row says: velocity of the base by each slot taken as each leg, and contacts by entry.
struct Evidence {
  std::array<std::array<Eigen::Vector3d, kLegCount>, kLegCount> velocity;  ///< by slot, by leg
  std::array<std::array<double, kLegCount>, kLegCount> height;  ///< of the foot in the base [m]
  std::array<bool, kLegCount> contact{};
};

/// One assignment, with the mean square difference of feet in contact.
struct Candidate {
  Legs leg_of_slot{};
  Legs leg_of_entry{};
  double disagreement = 0.0;
};

/// Whether slot `s` stands in that row.
bool stands(const Evidence& row, const Candidate& candidate, std::size_t slot) {
  const auto entry = std::ranges::find(candidate.leg_of_entry, candidate.leg_of_slot[slot]);
  return row.contact[static_cast<std::size_t>(entry - candidate.leg_of_entry.begin())];
}

/// How much higher the feet are in contact than without [m]: negative where contacts and legs
/// match.
double lift_of(const std::vector<Evidence>& rows, const Candidate& candidate) {
  double lift = 0.0;
  for (std::size_t slot = 0; slot < 4; ++slot) {
    std::array<double, 2> sum{}, count{};
    for (const Evidence& row : rows) {
      const std::size_t state = stands(row, candidate, slot) ? 1 : 0;
      sum[state] += row.height[slot][static_cast<std::size_t>(candidate.leg_of_slot[slot])];
      ++count[state];
    }
    if (count[0] > 0.0 && count[1] > 0.0) lift += 0.25 * (sum[1] / count[1] - sum[0] / count[0]);
  }
  return lift;
}

double disagreement_of(const std::vector<Evidence>& rows, const Candidate& candidate) {
  double sum = 0.0;
  std::size_t pairs = 0;
  for (const Evidence& row : rows) {
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

/// Mean velocity by the feet in contact, row by row.
std::vector<Eigen::Vector3d> velocities(const std::vector<Evidence>& rows,
                                        const Candidate& candidate) {
  std::vector<Eigen::Vector3d> result;
  for (const Evidence& row : rows) {
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

std::string names_of(const Legs& legs) {
  std::vector<std::string_view> names;
  for (const int leg : legs) names.push_back(kLegNames[static_cast<std::size_t>(leg)]);
  return fmt::format("{}", fmt::join(names, " "));
}

std::vector<Candidate> candidates_of(const std::vector<Evidence>& rows, bool joints_known,
                                     bool feet_known, bool pairs_first) {
  const std::vector<Legs> orders = all_orders(pairs_first);
  const std::vector<Legs> feet = all_orders(false);
  std::vector<Candidate> candidates;
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

/// The first of those that the data do not tell apart, and their number.
Result<std::pair<Candidate, std::size_t>> chosen(const std::vector<Evidence>& rows,
                                                 const std::vector<Candidate>& candidates) {
  const double best = std::ranges::min(candidates, {}, &Candidate::disagreement).disagreement;
  const double limit = kSameAgreement * best + kAgreementFloor;
  const Candidate* first = nullptr;
  std::size_t same = 0;
  std::vector<Eigen::Vector3d> velocity;
  for (const Candidate& each : candidates) {
    if (each.disagreement > limit) continue;
    ++same;
    if (first == nullptr) {
      first = &each;
      velocity = velocities(rows, each);
    } else if (!same_velocity(velocity, velocities(rows, each))) {
      return failure(fmt::format("the legs may be {} or {}: the motion does not tell them apart",
                                 names_of(first->leg_of_slot), names_of(each.leg_of_slot)));
    }
  }
  return std::pair(*first, same);
}

}  // namespace

bool LegOrderFinder::full() const { return rows_.size() >= kMaxRows; }

void LegOrderFinder::add_loads(const FootLoads& loads) {
  if (std::ranges::all_of(loads, [](double each) { return std::isfinite(each); })) loads_ = loads;
}

void LegOrderFinder::add_joints(Time stamp, const std::vector<double>& angles,
                                const std::vector<double>& rates) {
  if (!loads_ || full() || angles.size() != std::size_t{kJointCount}) return;
  Row row;
  row.stamp = stamp;
  row.angles = JointVector::Map(angles.data());
  row.rates.setZero();
  row.has_rates = rates.size() == angles.size();
  if (row.has_rates) row.rates = JointVector::Map(rates.data());
  if (!row.angles.allFinite() || !row.rates.allFinite()) return;
  row.turning = turning_;
  row.loads = *loads_;
  if (rows_.size() >= kMaxUnchanged) {
    const double step = to_seconds(stamp - rows_.back().stamp);
    const double change = (row.angles - rows_.back().angles).cwiseAbs().maxCoeff();
    if (change < kMovingRate * std::min(step, 1.0)) return;
  }
  rows_.push_back(row);
}

/// The rows with rates: as recorded, or central differences within one state of the contacts.
std::vector<LegOrderFinder::Row> LegOrderFinder::with_rates() const {
  const bool recorded = std::ranges::any_of(rows_, [](const Row& row) {
    return row.has_rates && row.rates.cwiseAbs().maxCoeff() > kMovingRate;
  });
  std::vector<Row> rows;
  for (std::size_t i = 1; i + 1 < rows_.size(); ++i) {
    Row row = rows_[i];
    const Row& before = rows_[i - 1];
    const Row& after = rows_[i + 1];
    const Duration step = after.stamp - before.stamp;
    if (!recorded) {
      if (step <= 0 || step > kMaxStep) continue;
      row.rates = (after.angles - before.angles) / to_seconds(step);
    }
    if (row.rates.cwiseAbs().maxCoeff() > kMovingRate) rows.push_back(row);
  }
  return rows;
}

Result<LegOrder> LegOrderFinder::find(const LegGeometry& geometry,
                                      const Eigen::Quaterniond& R_body_base,
                                      const std::optional<JointOrder>& joints,
                                      bool feet_named) const {
  if (rows_.empty()) return failure("no joints with contacts");
  JointVector mean = JointVector::Zero();
  std::vector<FootLoads> loads;
  for (const Row& row : rows_) {
    mean += row.angles / static_cast<double>(rows_.size());
    loads.push_back(row.loads);
  }
  const auto kinds = joints ? Result<Kinds>(kinds_of(*joints)) : kinds_of(mean);
  if (!kinds) return tl::unexpected(kinds.error());
  const bool pairs_first = (*kinds)[0][0] == 8 && (*kinds)[2][0] - (*kinds)[1][0] == 1;

  std::array<ContactThreshold, kLegCount> thresholds;
  thresholds.fill({0.5, 0.5});
  if (const auto learned = learn_contact_thresholds(loads)) thresholds = *learned;
  const std::vector<Row> moving = with_rates();
  const std::size_t stride = std::max<std::size_t>(1, moving.size() / kComparedRows);
  std::vector<Evidence> rows;
  std::array<bool, kLegCount> before{};
  ContactDetector detector(thresholds);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const Row& row = moving[i];
    Evidence evidence;
    evidence.contact = detector.detect(row.loads);
    const bool steady = std::exchange(before, evidence.contact) == evidence.contact &&
                        (i + 1 == moving.size() ||
                         ContactDetector(detector).detect(moving[i + 1].loads) == evidence.contact);
    if (!steady || i % stride != 0) continue;
    const Eigen::Vector3d turning = R_body_base.conjugate() * row.turning;
    for (std::size_t slot = 0; slot < 4; ++slot) {
      const auto at = [&](const JointVector& v) {
        return Eigen::Vector3d(v[static_cast<Eigen::Index>((*kinds)[0][slot])],
                               v[static_cast<Eigen::Index>((*kinds)[1][slot])],
                               v[static_cast<Eigen::Index>((*kinds)[2][slot])]);
      };
      for (int leg = 0; leg < kLegCount; ++leg) {
        evidence.velocity[slot][static_cast<std::size_t>(leg)] =
            velocity_from_foot(leg, {at(row.angles), at(row.rates), turning}, geometry);
        evidence.height[slot][static_cast<std::size_t>(leg)] =
            foot_in_base(leg, at(row.angles), geometry).z();
      }
    }
    rows.push_back(evidence);
  }
  if (rows.size() < kMinRows) rows.clear();

  const auto found = chosen(rows, candidates_of(rows, joints.has_value(), feet_named, pairs_first));
  if (!found) return tl::unexpected(found.error());
  const auto& [candidate, same] = *found;
  LegOrder order;
  order.joints = order_of(*kinds, candidate.leg_of_slot);
  order.feet = candidate.leg_of_entry;
  order.feet_differ = order.feet != Legs{0, 1, 2, 3};
  if (!joints) order.text = fmt::format("legs in the order {}", names_of(candidate.leg_of_slot));
  if (!feet_named) {
    order.text += fmt::format("{}feet in the order {}", order.text.empty() ? "" : ", ",
                              names_of(candidate.leg_of_entry));
  }
  if (rows.empty()) {
    order.text += " (assumed: the robot does not walk)";
  } else if (same > 1) {
    order.text += fmt::format(" ({} other orders give the same velocity)", same - 1);
  }
  return order;
}

}  // namespace aims
