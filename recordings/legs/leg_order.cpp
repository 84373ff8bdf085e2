// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/legs/leg_order.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "recordings/legs/contact_detector.hpp"
#include "recordings/legs/leg_evidence.hpp"

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
constexpr double kSameAgreement = 1.5;    ///< ratio of mean squares that does not decide
constexpr double kAgreementFloor = 1e-4;  ///< mean square that does not decide [m^2/s^2]

Result<JointKinds> kinds_of(const JointVector& mean) {
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
  JointKinds kinds{};
  constexpr std::array<std::size_t, 3> kRank = {1, 2, 0};  // of abduction, hip, knee
  for (std::size_t kind = 0; kind < 3; ++kind) {
    std::copy_n(by_angle.begin() + static_cast<std::ptrdiff_t>(4 * kRank[kind]), 4,
                kinds[kind].begin());
    std::ranges::sort(kinds[kind]);
  }
  return kinds;
}

/// The slots of joints that are known: slot and leg are the same.
JointKinds kinds_of(const JointOrder& order) {
  JointKinds kinds{};
  for (std::size_t i = 0; i < order.size(); ++i) kinds[i % 3][i / 3] = order[i];
  return kinds;
}

JointOrder order_of(const JointKinds& kinds, const Legs& leg_of_slot) {
  JointOrder order{};
  for (std::size_t slot = 0; slot < kinds[0].size(); ++slot) {
    for (std::size_t kind = 0; kind < 3; ++kind) {
      order[3 * static_cast<std::size_t>(leg_of_slot[slot]) + kind] = kinds[kind][slot];
    }
  }
  return order;
}

std::string names_of(const Legs& legs) {
  std::vector<std::string_view> names;
  for (const int leg : legs) names.push_back(kLegNames[static_cast<std::size_t>(leg)]);
  return fmt::format("{}", fmt::join(names, " "));
}

/// The order of the legs in the joints and in the feet, of those that were decided.
std::string text_of(const LegCandidate& candidate, bool joints, bool feet) {
  std::vector<std::string> parts;
  if (joints) parts.push_back("legs in the order " + names_of(candidate.leg_of_slot));
  if (feet) parts.push_back("feet in the order " + names_of(candidate.leg_of_entry));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// The first of those that the data do not tell apart, and their number.
Result<std::pair<LegCandidate, std::size_t>> chosen(const std::vector<LegEvidence>& rows,
                                                    const std::vector<LegCandidate>& candidates) {
  const double best = std::ranges::min(candidates, {}, &LegCandidate::disagreement).disagreement;
  const double limit = kSameAgreement * best + kAgreementFloor;
  const LegCandidate* first = nullptr;
  std::size_t same = 0;
  std::vector<Eigen::Vector3d> velocity;
  std::vector<std::string> others;
  for (const LegCandidate& each : candidates) {
    if (each.disagreement > limit) continue;
    ++same;
    if (first == nullptr) {
      first = &each;
      velocity = velocities(rows, each);
    } else if (!same_velocity(velocity, velocities(rows, each))) {
      const std::string name = names_of(each.leg_of_slot);
      if (std::ranges::find(others, name) == others.end()) others.push_back(name);
    }
  }
  if (others.empty()) return std::pair(*first, same);
  const std::size_t listed = std::min<std::size_t>(others.size(), 3);
  return failure(fmt::format(
      "the legs may be {} or {}{}: the motion does not tell them apart",
      names_of(first->leg_of_slot), fmt::join(std::span(others).first(listed), ", "),
      others.size() > listed ? fmt::format(" or {} more", others.size() - listed) : ""));
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

/// What each of at most `kComparedRows` rows says in which the contacts are as before and after.
std::vector<LegEvidence> LegOrderFinder::evidence(const JointKinds& kinds,
                                                  const LegGeometry& geometry,
                                                  const Eigen::Quaterniond& R_body_base) const {
  std::vector<FootLoads> loads;
  for (const Row& row : rows_) loads.push_back(row.loads);
  std::array<ContactThreshold, kLegCount> thresholds;
  thresholds.fill({0.5, 0.5});
  if (const auto learned = learn_contact_thresholds(loads)) thresholds = *learned;
  const std::vector<Row> moving = with_rates();
  const std::size_t stride = std::max<std::size_t>(1, moving.size() / kComparedRows);
  std::vector<LegEvidence> found;
  std::array<bool, kLegCount> before{};
  ContactDetector detector(thresholds);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const auto contact = detector.detect(moving[i].loads);
    const bool steady = std::exchange(before, contact) == contact &&
                        (i + 1 == moving.size() ||
                         ContactDetector(detector).detect(moving[i + 1].loads) == contact);
    if (!steady || i % stride != 0) continue;
    found.push_back(evidence_of(moving[i], kinds, geometry, R_body_base));
    found.back().contact = contact;
  }
  if (found.size() < kMinRows) found.clear();
  return found;
}

/// Without contacts.
LegEvidence LegOrderFinder::evidence_of(const Row& row, const JointKinds& kinds,
                                        const LegGeometry& geometry,
                                        const Eigen::Quaterniond& R_body_base) {
  LegEvidence evidence;
  const Eigen::Vector3d turning = R_body_base.conjugate() * row.turning;
  for (std::size_t slot = 0; slot < kLegCount; ++slot) {
    const auto at = [&](const JointVector& v) {
      return Eigen::Vector3d(v[static_cast<Eigen::Index>(kinds[0][slot])],
                             v[static_cast<Eigen::Index>(kinds[1][slot])],
                             v[static_cast<Eigen::Index>(kinds[2][slot])]);
    };
    for (int leg = 0; leg < kLegCount; ++leg) {
      const auto column = static_cast<std::size_t>(leg);
      evidence.velocity[slot][column] =
          velocity_from_foot(leg, {at(row.angles), at(row.rates), turning}, geometry);
      evidence.height[slot][column] = foot_in_base(leg, at(row.angles), geometry).z();
    }
  }
  return evidence;
}

Result<LegOrder> LegOrderFinder::find(const LegGeometry& geometry,
                                      const Eigen::Quaterniond& R_body_base,
                                      const std::optional<JointOrder>& joints,
                                      bool feet_named) const {
  if (rows_.empty()) return failure("no joints with contacts");
  JointVector mean = JointVector::Zero();
  for (const Row& row : rows_) mean += row.angles / static_cast<double>(rows_.size());
  const auto kinds = joints ? Result<JointKinds>(kinds_of(*joints)) : kinds_of(mean);
  if (!kinds) return tl::unexpected(kinds.error());
  const bool pairs_first = (*kinds)[0][0] == 8 && (*kinds)[2][0] - (*kinds)[1][0] == 1;
  const std::vector<LegEvidence> rows = evidence(*kinds, geometry, R_body_base);
  const auto found =
      chosen(rows, leg_candidates(rows, joints.has_value(), feet_named, pairs_first));
  if (!found) return tl::unexpected(found.error());
  const auto& [candidate, same] = *found;
  LegOrder order;
  order.joints = order_of(*kinds, candidate.leg_of_slot);
  order.feet = candidate.leg_of_entry;
  order.text = text_of(candidate, !joints, !feet_named);
  if (rows.empty()) {
    order.text += " (assumed: the robot does not walk)";
  } else if (same > 1) {
    order.text += fmt::format(" ({} other orders give the same velocity)", same - 1);
  }
  return order;
}

}  // namespace aims
