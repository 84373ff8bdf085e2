// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/time.hpp"
#include "core/walk_outcome.hpp"
#include "sim/environment/scene.hpp"
#include "sim/robot/route.hpp"
#include "sim/robot/walker.hpp"

namespace aims {

/// Time [s] without progress that ends a walk: five times what the slowest honest progress takes,
/// which is half a turn in place, one metre, and coming to rest.
double patience(const RouteConfig& route);

/// Watches a walk from its start: how it ends, and how much of it is in contact with walls.
class WalkMonitor {
 public:
  /// `stride`: period of the gait [s]; `max_duration`: of the walk [s].
  WalkMonitor(const RouteConfig& route, double stride, double max_duration);

  /// Looks at the state after each physics step. The first end stays.
  void update(const Walker& walker, const Floor& floor);

  bool ended() const { return outcome_.end != WalkEnd::kRunning; }
  const WalkOutcome& outcome() const { return outcome_; }

 private:
  WalkEnd end_of(const Walker& walker, const Floor& floor);
  bool is_stuck(const Walker& walker);
  void watch_contact(const Walker& walker);

  Duration patience_;
  Duration stride_;
  Time limit_;
  Time last_ = 0;  ///< stamp of the update before
  std::size_t next_point_ = 0;
  double nearest_ = 0.0;     ///< to that point, when progress was last seen [m]
  Time progress_ = 0;        ///< when that was
  Time contact_until_ = -1;  ///< end of the stride after the last contact
  Duration under_way_ = 0;
  Duration in_contact_ = 0;
  WalkOutcome outcome_;
};

}  // namespace aims
