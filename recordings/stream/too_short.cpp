// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/stream/too_short.hpp"

#include <fmt/format.h>

namespace aims {

std::optional<std::string> too_short_text(std::optional<std::uint64_t> scans, double seconds) {
  constexpr std::uint64_t kFewestScans = 10;
  constexpr double kShortest = 2.0;  // in which a robot stands before it walks [s]
  if (seconds >= kShortest && scans.value_or(kFewestScans) >= kFewestScans) return std::nullopt;
  const std::string found =
      scans ? fmt::format("{} scan{} over {:.1f} s", *scans, *scans == 1 ? "" : "s", seconds)
            : fmt::format("{:.1f} s", seconds);
  return fmt::format("too short: {}; expected {:g} s or more{}: too little to judge an estimate by",
                     found, kShortest, scans ? fmt::format(" with {} scans", kFewestScans) : "");
}

}  // namespace aims
