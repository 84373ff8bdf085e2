// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/frame_stamps.hpp"

#include <fmt/format.h>

#include "bench/scoring/score_hints.hpp"

namespace aims {

Result<void> stamp_frames(const StampList& times, const std::string& name, Trajectory& poses,
                          std::vector<std::string>& notes) {
  if (!is_frame_index(poses)) return {};
  const auto number_of = [](const StampedPose& pose) {
    return static_cast<std::size_t>(pose.stamp / kSecond);
  };
  const std::size_t last = number_of(poses.back());
  const std::size_t first = number_of(poses.front()) == 1 && last == times.stamps.size() ? 1 : 0;
  if (last - first >= times.stamps.size()) {
    return failure(fmt::format("{}: has a pose of frame {}, but {} has {} stamps", name, last,
                               times.name, times.stamps.size()));
  }
  for (StampedPose& each : poses) each.stamp = times.stamps[number_of(each) - first];
  notes.push_back(fmt::format("{}: its stamps are numbers of frames: those of {} take their place",
                              name, times.name));
  return {};
}

}  // namespace aims
