// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "core/time.hpp"
#include "recordings/reading_notes.hpp"
#include "recordings/stream/missing_messages.hpp"
#include "recordings/stream/stamp_leaps.hpp"
#include "recordings/topics/recording_channels.hpp"

namespace aims {

/// The messages of a sensor that are missing, where they are so many that an estimate suffers.
std::optional<double> many_missing(Role role, const MissingMessages& messages);

ReadingWarning warning_of_missing(Role role, const std::string& topic, double missing,
                                  const MissingMessages& messages);

/// Of a sensor whose messages begin so long after those of the first one (`late`), or end so long
/// before those of the last one.
ReadingWarning warning_of_absence(Role role, const std::string& topic, bool late, Duration absence);

/// `doubled`: "/imu/data has 2 publishers".
ReadingWarning warning_of_publishers(const std::string& doubled);

/// `leap`: of the stamps of the IMU.
ReadingWarning warning_of_imu_leap(const std::string& imu, const std::string& lidar, Duration leap);

/// `growth`: of the latency of one topic against that of the other [s/s].
ReadingWarning warning_of_rates(const std::string& topic, const std::string& other, double growth);

/// `rate`: at which record times run faster than the stamps.
ReadingWarning warning_of_record_rate(double rate);

/// `start`: record time of the first message.
ReadingWarning warning_of_leaps(Role role, const std::string& topic, const StampLeaps& leaps,
                                Time start);

}  // namespace aims
