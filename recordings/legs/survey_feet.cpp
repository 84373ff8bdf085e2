// SPDX-License-Identifier: BSD-3-Clause
// Of the survey of the legs: feet without joints.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "recordings/legs/leg_survey.hpp"

namespace aims {

void LegSurvey::add_feet(const MessageView& message, const StateLayout& state) {
  feet_state_ = &state;
  ++foot_messages_;
  const auto feet = feet_at(message, 0, state);
  if (!feet) return;
  has_feet_ = true;
  for (std::size_t leg = 0; leg < feet->position.size(); ++leg) {
    const Eigen::Vector3d& foot = feet->position[leg];
    if (!foot.allFinite()) continue;
    farthest_foot_ = std::max(farthest_foot_, foot.norm());
    sum_of_feet_[leg] += foot;
  }
}

/// Why the feet without joints do not serve; empty: they do.
std::string LegSurvey::lack_of_feet(const std::string& frame) const {
  const std::string_view field =
      feet_state_->feet.empty() ? feet_state_->angles : feet_state_->feet;
  if (!has_feet_) return fmt::format("'{}' does not hold all feet", field);
  if (!(farthest_foot_ > 0.0)) return fmt::format("{} is zero", field);
  if (is_world_frame(frame)) {
    return fmt::format(
        "the feet are in the frame '{}', which does not move with the robot: expected those in the "
        "base",
        frame);
  }
  if (contact_messages_ > 0) return {};
  if (topics_.contacts.empty()) return "no contacts of the feet";
  return fmt::format("{} holds no contacts of four feet: expected a number for each foot",
                     topics_.contacts);
}

/// Warns of feet that do not lie where the legs are, and of contacts whose feet are not named.
void LegSurvey::warn_of_feet(ReadingNotes& notes) const {
  std::vector<std::string> places;
  bool apart = false;
  for (std::size_t leg = 0; leg < sum_of_feet_.size(); ++leg) {
    const Eigen::Vector3d mean = sum_of_feet_[leg] / std::max(1, foot_messages_);
    places.push_back(
        fmt::format("{} ({:.2f}, {:.2f}, {:.2f})", kLegNames[leg], mean.x(), mean.y(), mean.z()));
    apart = apart || (leg < 2) != (mean.x() > 0.0) || (leg % 2 == 0) != (mean.y() > 0.0);
  }
  if (apart && feet_state_->biped == nullptr) {
    notes.warn("feet lie where no leg is",
               fmt::format("{}: the feet are in the mean at {} m: expected FL, FR, RL, RR around "
                           "the base, in its axes, x forward, y left",
                           topics_.leg_odometry, fmt::join(places, ", ")));
  }
  if (feet_unnamed_ && contact_state_ == nullptr && config_.foot_names.empty()) {
    notes.warn("order of the feet assumed",
               fmt::format("{}: no names tell the feet: FL, FR, RL, RR is assumed (foot_names)",
                           topics_.contacts));
  }
}

LegSource LegSurvey::decide_feet(const std::string& frame, ReadingNotes& notes) {
  const std::string lack = lack_of_feet(frame);
  if (lack.empty()) {
    notes.push_back(feet_state_->biped == nullptr
                        ? "leg odometry: from feet, contacts and gyro"
                        : fmt::format("leg odometry: from the joints of {}, the torques of its "
                                      "knees and the gyro",
                                      feet_state_->robot));
    warn_of_feet(notes);
    return LegSource::kFeet;
  }
  notes.push_back(fmt::format("{}: {}: estimators run without legs", topics_.leg_odometry, lack));
  if (lack_.empty()) lack_ = lack;
  return LegSource::kNone;
}

}  // namespace aims
