// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/run/sequence_file.hpp"
#include "core/files/byte_cursor.hpp"
#include "core/measurements.hpp"
#include "sim/robot/truth.hpp"

namespace aims {

/// The parts of a sequence's file (bench/run/sequence_file.hpp) as bytes, and back. `append_*`
/// writes at the end of `out`; `take_*` reads at the cursor and is false, or nothing, where the
/// bytes end too early or mean nothing.
void append_rig(std::vector<std::byte>& out, const SensorRig& rig);
void append_text(std::vector<std::byte>& out, std::string_view text);
void append_delivery(std::vector<std::byte>& out, const Delivery& delivery);
void append_truth(std::vector<std::byte>& out, const Truth& truth);

bool take_rig(ByteCursor& cursor, SensorRig& rig);
bool take_text(ByteCursor& cursor, std::string& text);
/// `with_points`: of which scans the points are taken; it gets them without.
std::optional<Delivery> take_delivery(ByteCursor& cursor, const ScanFilter& with_points);
bool take_truth(ByteCursor& cursor, Truth& truth);

}  // namespace aims
