// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/count_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "recordings/stream/too_short.hpp"

namespace aims {
namespace {

int count_of(const EstimateResult& result, const char* what) {
  const auto found = result.counts.find(what);
  return found == result.counts.end() ? 0 : found->second;
}

/// Adds warnings of one sensor, each by its reason and text.
auto warner(EstimateResult& result, WarnedSensor sensor) {
  return [&result, sensor](std::string reason, std::string text) {
    result.setup.warnings.push_back({std::move(reason), std::move(text), sensor});
  };
}

/// Warns of what the counts of the whole recording say of the IMU.
void warn_of_imu(EstimateResult& result) {
  constexpr double kFew = 0.05;  // of the samples
  const double samples = result.recorded_s * result.setup.imu_rate_hz.value_or(0.0);
  const int repeated = count_of(result, "imu_stamp_not_increasing");
  if (repeated <= kFew * samples) return;
  result.setup.warnings.push_back(
      {"stamps of the IMU repeat or go backwards",
       fmt::format("{} IMU samples have stamps that are not after the one before: they are "
                   "dropped, and the others may be rounded",
                   repeated)});
}

/// Warns of IMU samples without numbers or stamps.
void warn_of_unusable(EstimateResult& result) {
  constexpr double kFew = 0.02;  // of the samples
  const double samples = result.recorded_s * result.setup.imu_rate_hz.value_or(0.0);
  if (const int bad = count_of(result, "imu_not_finite"); bad > kFew * samples) {
    result.setup.warnings.push_back(
        {"IMU samples are not finite",
         fmt::format("{} of {:.0f} IMU samples are not finite (NaN): estimators leave them out",
                     bad, samples)});
  }
  if (const int unset = count_of(result, "stamp_not_set"); unset > kFew * samples) {
    result.setup.warnings.push_back(
        {"messages without a stamp",
         fmt::format("{} messages have the stamp 0, before the sensor's clock was set: they are "
                     "left out",
                     unset)});
  }
}

constexpr double kDisagree = 0.2;  ///< of the samples of the legs

/// Likewise of the legs' odometry and joints.
void warn_of_legs(EstimateResult& result) {
  constexpr int kFewSeconds = 3;  // of a twist that may be a slip
  const double samples = result.recorded_s * result.setup.leg_rate_hz.value_or(0.0);
  const std::string& topic = result.setup.topics.leg_odometry;
  const auto warn = warner(result, WarnedSensor::kLegs);
  if (const int filled = count_of(result, "legs_twist_by_pose_differences"); filled > 0) {
    warn("twist of the leg odometry is zero",
         fmt::format("{}: the twist is zero in {} messages whose pose moves: differences of the "
                     "poses serve",
                     topic, filled));
  }
  if (const int filled = count_of(result, "legs_pose_by_twist"); filled > 0) {
    warn("pose of the leg odometry does not move",
         fmt::format("{}: the pose is the same in {} messages whose twist moves: the twist is "
                     "integrated",
                     topic, filled));
  }
  if (const int empty = count_of(result, "joint_rates_empty"); empty > kDisagree * samples) {
    warn("rates of the joints are empty",
         fmt::format("{}: the rates of the joints are zero or not finite in {} messages though the "
                     "angles change: differences of the angles serve",
                     result.setup.topics.joint_states, empty));
  }
  if (const int again = count_of(result, "joints_stamp_repeated"); again > kDisagree * samples) {
    warn("stamps of the joints repeat",
         fmt::format("{} messages of the joints have the stamp of the one before: they are left "
                     "out, and the others may be rounded",
                     again));
  }
  if (const int axes = count_of(result, "legs_twist_in_odometry_axes_seconds");
      axes > kFewSeconds) {
    warn("twist of the leg odometry in the axes of its world",
         fmt::format("{}: the twist is in the axes of the odometry's frame for {} s, expected "
                     "those of the base: use joints and contacts (topics.leg_odometry: none) or "
                     "correct the driver",
                     topic, axes));
  }
}

/// Likewise of the feet.
void warn_of_feet(EstimateResult& result) {
  constexpr double kMost = 0.5;       // of the samples; a trot has none without contact
  constexpr double kFewOther = 0.05;  // likewise
  const double samples = result.recorded_s * result.setup.leg_rate_hz.value_or(0.0);
  const auto warn = warner(result, WarnedSensor::kLegs);
  if (const int air = count_of(result, "legs_in_the_air"); air > 0) {
    warn("no foot in contact",
         fmt::format("no foot is in contact for more than half a second, {:.1f} s in all: there is "
                     "no leg odometry there (a robot that is carried, or feet whose load is lost)",
                     air / std::max(1.0, result.setup.leg_rate_hz.value_or(0.0))));
  }
  if (const int bad = count_of(result, "joints_not_finite"); bad > kFewOther * samples) {
    warn("joints without an angle",
         fmt::format(
             "{}: in {} of {:.0f} messages an angle is no number (NaN), or no message of its "
             "leg comes: the foot of that leg does not count",
             result.setup.topics.joint_states, bad, samples));
  }
  if (const int bad = count_of(result, "foot_loads_not_finite"); bad > kFewOther * samples) {
    warn("feet without a load",
         fmt::format("{}: in {} of {:.0f} messages the load of a foot is no number (NaN), or no "
                     "message of its leg comes: that foot is taken as lifted",
                     result.setup.topics.contacts, bad, samples));
  }
  if (const int none = count_of(result, "legs_no_contact"); none > kMost * samples && none > 0) {
    warn("feet hardly ever in contact",
         fmt::format("no foot is in contact in {} of {:.0f} samples of the legs: the last velocity "
                     "serves there (contact_threshold, contact_detection)",
                     none, samples));
  }
  if (const int other = count_of(result, "foot_loads_of_other_sign"); other > kFewOther * samples) {
    warn("loads of the feet change their sign",
         fmt::format("{}: in {} messages a foot has a load of the opposite sign, as large as in "
                     "contact: taken as no contact; a sensor with an offset?",
                     result.setup.topics.contacts, other));
  }
  const bool named = std::ranges::any_of(result.setup.warnings, [](const ReadingWarning& each) {
    return each.kind == WarningKind::kFeetAgainstGyro || each.kind == WarningKind::kJointRates;
  });
  if (const int apart = count_of(result, "feet_in_contact_disagree");
      !named && apart > kDisagree * samples) {
    warn("feet in contact disagree",
         fmt::format("the feet in contact state different velocities in {} of {:.0f} samples: is "
                     "the order of the joints and of the feet right (joint_names, foot_names), "
                     "and the threshold of contact, and are the contacts not late?",
                     apart, samples));
  }
}

/// Warns of scans most of whose returns an estimator leaves out by their ranges.
void warn_of_ranges(EstimateResult& result) {
  constexpr double kMany = 0.5;  // of the scans
  for (const EstimatorOutcome& each : result.estimators) {
    const auto share_of = [&](const char* what) {
      const auto found = each.result.counts.find(what);
      const int count = found == each.result.counts.end() ? 0 : found->second;
      return count / std::max(1.0, static_cast<double>(each.totals.scans));
    };
    const auto warn = [&](double share, std::string_view where, std::string_view cause) {
      if (share <= kMany) return;
      result.setup.warnings.push_back(
          {"most returns are out of range",
           fmt::format("{}: in {:.0f} % of the scans more than half of the returns are {} and left "
                       "out: {}",
                       each.name, 1e2 * share, where, cause),
           WarnedSensor::kLidar});
    };
    warn(share_of("lidar.mostly_too_far"), "farther than lidar.max_range",
         "points in cm or mm (recording.point_unit), or lidar.max_range is too small");
    warn(share_of("lidar.mostly_too_near"), "nearer than lidar.min_range",
         "points in another unit than metres, a LiDAR that sees the robot itself, or "
         "lidar.min_range is too large");
  }
}

/// Notes poses that an estimator returned and that are none.
void note_poses(EstimateResult& result) {
  for (const EstimatorOutcome& each : result.estimators) {
    const std::size_t invalid = each.result.invalid_poses.size();
    if (invalid == 0) continue;
    // A note: warnings stand in the health of every estimator.
    result.setup.notes.push_back(
        fmt::format("{}: {} of {} poses are not finite or not rigid: they are left out, and the "
                    "estimate is no success",
                    each.name, invalid, invalid + each.totals.poses));
  }
}

/// Likewise of the clouds.
void warn_of_clouds(EstimateResult& result) {
  constexpr double kFew = 0.05, kMany = 0.2;  // of the clouds
  const auto warn = warner(result, WarnedSensor::kLidar);
  if (const int untimed = count_of(result, "cloud_mostly_untimed");
      untimed > kFew * result.clouds) {
    warn("most points of some clouds left out by their times",
         fmt::format("{} of {} clouds have most points at times that are more than a second from "
                     "the scan: they are left out (point_time_unit)",
                     untimed, result.clouds));
  }
  if (const int same = count_of(result, "cloud_without_times"); same > kFew * result.clouds) {
    warn("clouds without point times",
         fmt::format("{} of {} clouds have the same time for all points: they are taken as "
                     "measured at one instant",
                     same, result.clouds));
  }
  if (const int empty = count_of(result, "cloud_empty"); empty > kMany * result.clouds) {
    warn("clouds without points",
         fmt::format("{} of {} clouds have no usable point", empty, result.clouds));
  }
}

/// Whether a topic had several publishers, whose messages lie beside each other.
bool is_doubled(const EstimateResult& result) {
  const auto& warnings = result.setup.warnings;
  return std::ranges::find(warnings, WarningKind::kDoubledTopic, &ReadingWarning::kind) !=
         warnings.end();
}

/// Warns of the recorder's clock.
void warn_of_record_times(EstimateResult& result) {
  if (const int early = count_of(result, "recorded_before_their_stamp"); early > 0) {
    result.setup.warnings.push_back(
        {"recorder's clock was set back or not set",
         fmt::format(
             "{} messages are recorded before their stamp: the recorder's clock was set back "
             "or not set yet; they arrive at their stamp and the usual delay",
             early)});
  }
  if (const int late = count_of(result, "recorded_long_after_their_stamp"); late > 0) {
    result.setup.warnings.push_back(
        {"record times leap",
         fmt::format(
             "{} messages are recorded more than 5 s after their stamp and the usual delay: "
             "the recorder's clock was set forward, or their times are wrong; they arrive "
             "at their stamp and the usual delay",
             late)});
  }
  if (const int late = count_of(result, "read_late_by_the_recorder"); late > 0) {
    result.setup.notes.push_back(fmt::format(
        "{} messages are recorded more than 5 s after their stamp and the usual delay, later ones "
        "less: the recorder was stopped or too slow; they arrive at their stamp and that delay",
        late));
  }
}

/// Warns of the recorder.
void warn_of_recorder(EstimateResult& result) {
  if (!is_doubled(result)) warn_of_record_times(result);
  if (result.summary.lost_bytes > 0) {
    result.setup.warnings.push_back(
        {"parts of the recording are lost",
         fmt::format("{} of {} bytes are in or behind damaged parts of the file: the messages in "
                     "them are lost",
                     result.summary.lost_bytes, result.summary.file_size)});
  }
}

}  // namespace

void warn_of_counts(EstimateResult& result) {
  warn_of_recorder(result);
  warn_of_imu(result);
  warn_of_unusable(result);
  warn_of_legs(result);
  warn_of_feet(result);
  warn_of_clouds(result);
  warn_of_ranges(result);
  note_poses(result);
}

std::string warn_of_length(EstimateResult& result) {
  const std::string& lidar = result.setup.topics.lidar;
  const bool has_lidar = !lidar.empty() && lidar != "none";
  const auto text = too_short_text(
      has_lidar ? std::optional(static_cast<std::uint64_t>(result.clouds)) : std::nullopt,
      result.recorded_s);
  if (!text) return {};
  result.setup.warnings.insert(result.setup.warnings.begin(), {"too short", *text});
  return *text;
}

}  // namespace aims
