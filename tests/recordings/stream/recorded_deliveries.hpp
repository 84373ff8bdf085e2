// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/error.hpp"
#include "core/measurements.hpp"
#include "recordings/stream/recording_reader.hpp"

namespace aims::test {

/// Everything that the reader gives, in pieces of `span`.
Result<std::vector<Delivery>> read_all(RecordingReader& reader, Duration span = kSecond);

/// Fails the test at the first difference, in any bit.
void expect_same_deliveries(const std::vector<Delivery>& expected,
                            const std::vector<Delivery>& actual);
void expect_same_pose(const Pose& expected, const Pose& actual);

/// The scans among deliveries.
std::vector<LidarScanPtr> scans_of(const std::vector<Delivery>& deliveries);
std::vector<LegOdometrySample> legs_of(const std::vector<Delivery>& deliveries);
std::vector<ImuSample> imu_of(const std::vector<Delivery>& deliveries);

}  // namespace aims::test
