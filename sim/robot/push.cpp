// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/push.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace aims {

void describe(Fields& f, PushConfig& c) {
  f.integer(
      "count", c.count,
      {.unit = "-",
       .range = in_range(0, 1000),
       .meaning = "Number of horizontal pushes on the trunk, in random directions; 0 for none."});
  f.number("force", c.force,
           {.unit = "N",
            .range = in_range(0.0, 500.0),
            .meaning = "Force of a push, constant while it lasts."});
  f.number("duration", c.duration,
           {.unit = "s", .range = in_range(0.01, 10.0), .meaning = "Duration of a push."});
  f.number("start", c.start,
           {.unit = "s",
            .range = up_to(1e6),
            .meaning = "Start of the interval that is divided equally among the pushes."});
  f.number("end", c.end,
           {.unit = "s",
            .range = up_to(1e6),
            .meaning = "End of the interval that is divided equally among the pushes."});
}

Result<void> validate(const PushConfig& config) {
  const double min_end = config.start + config.count * config.duration;
  if (config.count == 0 || config.end >= min_end) return {};
  return failure(
      fmt::format("push.end: expected at least {} s (push.start and {} pushes of {} s), "
                  "got {}",
                  min_end, config.count, config.duration, config.end));
}

Pushes::Pushes(const PushConfig& config, std::uint64_t run_seed) {
  RandomStream random(run_seed, "push");
  const double part = (config.end - config.start) / std::max(config.count, 1);
  for (int i = 0; i < config.count; ++i) {
    const double begin = config.start + i * part + random.uniform(0.0, part - config.duration);
    const double heading = random.uniform(-std::numbers::pi, std::numbers::pi);
    pushes_.push_back({from_seconds(begin), from_seconds(begin + config.duration),
                       config.force * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0)});
  }
}

Eigen::Vector3d Pushes::force_at(Time now) const {
  const auto push =
      std::find_if(pushes_.begin(), pushes_.end(), [now](const Push& p) { return now < p.end; });
  const bool active = push != pushes_.end() && push->start <= now;
  return active ? push->force : Eigen::Vector3d::Zero();
}

}  // namespace aims
