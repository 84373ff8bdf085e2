// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/stream_warnings.hpp"

#include <fmt/format.h>

#include <cmath>

namespace aims {
namespace {

/// Fractions of messages whose loss spoils no estimate; drivers of legs often lose some.
constexpr double kFewMissing = 0.02, kFewLegsMissing = 0.1;
constexpr int kFewGaps = 5;  ///< that are pauses of a sensor

}  // namespace

std::optional<double> many_missing(Role role, const MissingMessages& messages, int left_out) {
  const auto missing = static_cast<double>(messages.count() - left_out);
  const double all = missing + static_cast<double>(messages.received());
  const double few = role == Role::kLegs ? kFewLegsMissing : kFewMissing;
  if (missing <= few * all || messages.gaps() < kFewGaps) return std::nullopt;
  return missing;
}

ReadingWarning warning_of_missing(Role role, const std::string& topic, double missing,
                                  const MissingMessages& messages) {
  const double all = missing + static_cast<double>(messages.received());
  const WarnedSensor sensor = role == Role::kLidar  ? WarnedSensor::kLidar
                              : role == Role::kLegs ? WarnedSensor::kLegs
                                                    : WarnedSensor::kAny;
  return {fmt::format("messages of the {} are missing", name_of(role)),
          fmt::format("{}: {:.0f} of {:.0f} messages are missing, by the gaps in their stamps "
                      "({:.1f} %): the network, the recorder or the driver lost them",
                      topic, missing, all, 1e2 * missing / all),
          sensor};
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
