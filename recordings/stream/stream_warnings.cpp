// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/stream_warnings.hpp"

#include <fmt/format.h>

#include <cmath>

namespace aims {
namespace {

/// Fractions of messages whose loss spoils no estimate; drivers of legs often lose some.
constexpr double kFewMissing = 0.02, kFewLegsMissing = 0.1;
constexpr int kFewGaps = 5;  ///< that are pauses of a sensor

bool is_of_legs(Role role) {
  return role == Role::kLegs || role == Role::kJoints || role == Role::kContacts;
}

WarnedSensor sensor_of(Role role) {
  if (role == Role::kLidar) return WarnedSensor::kLidar;
  return is_of_legs(role) ? WarnedSensor::kLegs : WarnedSensor::kAny;
}

}  // namespace

std::optional<double> many_missing(Role role, const MissingMessages& messages) {
  const auto missing = static_cast<double>(messages.count());
  const double all = missing + static_cast<double>(messages.received());
  const double few = is_of_legs(role) ? kFewLegsMissing : kFewMissing;
  const bool pauses = messages.gaps() < kFewGaps && messages.in_long_gaps() == 0;
  if (missing <= few * all || pauses) return std::nullopt;
  return missing;
}

ReadingWarning warning_of_missing(Role role, const std::string& topic, double missing,
                                  const MissingMessages& messages) {
  const double all = missing + static_cast<double>(messages.received());
  const std::string in_long_gaps =
      messages.in_long_gaps() == 0
          ? ""
          : fmt::format(", {} of them in gaps of more than {:.0f} s, the longest of {:.1f} s",
                        messages.in_long_gaps(), to_seconds(MissingMessages::kLong),
                        to_seconds(messages.longest()));
  return {fmt::format("messages of the {} are missing", name_of(role)),
          fmt::format("{}: {:.0f} of {:.0f} messages are missing, by the gaps in their stamps "
                      "({:.1f} %){}: the network, the recorder or the driver lost them",
                      topic, missing, all, 1e2 * missing / all, in_long_gaps),
          sensor_of(role), WarningKind::kMissingMessages};
}

ReadingWarning warning_of_absence(Role role, const std::string& topic, bool late,
                                  Duration absence) {
  return {fmt::format("messages of the {} {}", name_of(role), late ? "began late" : "ended early"),
          fmt::format("{}: the {} message was recorded {:.1f} s {} of another sensor: {}", topic,
                      late ? "first" : "last", to_seconds(absence),
                      late ? "after the first one" : "before the last one",
                      late ? "was its driver started late?" : "has its driver stopped?"),
          sensor_of(role)};
}

ReadingWarning warning_of_publishers(const std::string& doubled) {
  return {doubled,
          doubled +
              ", as the live estimate says that recorded it, at least for some time (or one was "
              "killed): what both sent is mixed, and stamps and record times may go back and forth",
          WarnedSensor::kAny, WarningKind::kDoubledTopic};
}

ReadingWarning warning_of_imu_leap(const std::string& imu, const std::string& lidar,
                                   Duration leap) {
  return {
      fmt::format("stamps of {} leap", imu),
      fmt::format("{}: stamps leap by {:.3f} s, while record times and the stamps of {} do not: "
                  "what is before and behind it does not fit together",
                  imu, to_seconds(leap), lidar)};
}

ReadingWarning warning_of_rates(const std::string& topic, const std::string& other, double growth) {
  return {
      fmt::format("clocks of {} and {} run at different rates", topic, other),
      fmt::format("{}: by the record times its stamps run {:.3g} % {} than those of {}: no delay "
                  "corrects it; synchronise the clocks, or have the drivers stamp by one",
                  topic, 1e2 * std::abs(growth), growth < 0.0 ? "faster" : "slower", other),
      WarnedSensor::kAny, WarningKind::kClocks};
}

ReadingWarning warning_of_record_rate(double rate) {
  return {"record times run at another rate than the stamps",
          fmt::format("record times run {:.3g} times as fast as the stamps, which agree: was the "
                      "recording played at {:.3g} times its speed and recorded again? Arrivals are "
                      "taken at the rate of the stamps",
                      rate, 1.0 / rate)};
}

ReadingWarning warning_of_leaps(Role role, const std::string& topic, const StampLeaps& leaps,
                                Time start) {
  return {fmt::format("stamps of the {} leap", name_of(role)),
          fmt::format("{}: stamps leap by {:.3f} s after {:.1f} s, while those of the IMU do not: "
                      "in place of {} of them, record times and the usual delay serve",
                      topic, to_seconds(leaps.leap()), to_seconds(leaps.first() - start),
                      leaps.count())};
}

}  // namespace aims
