// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "recordings/bag/message_source.hpp"

namespace aims {

/// What to add to the record times of each file of one recording. Zero but for files of other
/// topics whose recorder had another clock: by their stamps they begin and end together, by their
/// record times they do not. Reads the first messages of each; rewinds.
std::vector<Duration> recorder_clock_shifts(
    const std::vector<std::unique_ptr<MessageSource>>& files);

}  // namespace aims
