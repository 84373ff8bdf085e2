// SPDX-License-Identifier: BSD-3-Clause
#include "sim/robot/walk_outcome.hpp"

namespace aims {

std::string_view name_of(WalkEnd end) {
  switch (end) {
    case WalkEnd::kRunning:
      return "running";
    case WalkEnd::kRouteDone:
      return "route_done";
    case WalkEnd::kFell:
      return "fell";
    case WalkEnd::kLeftScene:
      return "left_scene";
    case WalkEnd::kNoProgress:
      return "no_progress";
    case WalkEnd::kTimeLimit:
      return "time_limit";
    case WalkEnd::kUnstablePhysics:
      return "unstable_physics";
  }
  return "running";
}

}  // namespace aims
