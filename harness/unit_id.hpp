// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "harness/scenario.hpp"

namespace aims {

/// 16 hexadecimal digits of a hash (FNV-1a, 64 bit) of the text.
std::string text_hash(std::string_view text);

/// Name of what one estimator yields on one seed of a scenario: the hash of everything that decides
/// it, and of nothing else: the effective configuration of simulation, scoring and the estimator
/// with the settings of its spec, the seed, the estimator's name, the code's version. Labels,
/// descriptions, tags and expectations do not count, nor does where a file lies.
std::string unit_id(const Scenario& scenario, std::uint64_t seed, const std::string& estimator);

}  // namespace aims
