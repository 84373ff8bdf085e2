// SPDX-License-Identifier: BSD-3-Clause
#include "render/scene/robot_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "core/lie.hpp"
#include "render/plots/canvas.hpp"
#include "sim/environment/scene_mjcf.hpp"

namespace aims {
namespace {

Eigen::Vector3d position_of(const std::vector<double>& qpos) {
  return qpos.size() < 3 ? Eigen::Vector3d(0.0, 0.0, 0.0)
                         : Eigen::Vector3d(qpos[0], qpos[1], qpos[2]);
}

double heading_of(const std::vector<double>& qpos) {
  if (qpos.size() < 7) return 0.0;
  return yaw_of(Eigen::Quaterniond(qpos[3], qpos[4], qpos[5], qpos[6]));
}

/// True when the straight line from the eye to the robot is free of solids.
bool sees(const Scene& scene, const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  constexpr int kSteps = 40;
  constexpr double kClearance = 0.12;  // the near plane must not cut into a wall
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector3d point = eye + (target - eye) * (static_cast<double>(i) / kSteps);
    if (is_inside_solid(scene, point, kClearance)) return false;
  }
  return true;
}

std::string caption(std::string_view scenario, std::string_view where, const RobotSnapshot& shot) {
  // Rounded first, and zero added, so that no "-0.00" appears.
  const Eigen::Vector3d at = ((100.0 * position_of(shot.qpos)).array().round() / 100.0) + 0.0;
  return fmt::format("{}  ·  {}  ·  t = {:.1f} s  ·  x = {:.2f} m, y = {:.2f} m", scenario, where,
                     to_seconds(shot.stamp), at.x(), at.y());
}

Result<void> write_with_caption(const std::filesystem::path& path, const Image& picture,
                                const std::string& text) {
  auto canvas = Canvas::create(path, picture.width, picture.height);
  if (!canvas) return tl::unexpected(canvas.error());
  const Rect full{0.0, 0.0, static_cast<double>(picture.width),
                  static_cast<double>(picture.height)};
  canvas->image(picture, full);
  const double bar = 38.0;
  canvas->fill(Rect{0.0, full.height - bar, full.width, bar}, {0.05, 0.06, 0.08, 0.72});
  canvas->text({18.0, full.height - bar / 2.0}, text, {.size = 17.0, .color = {0.97, 0.97, 0.97}});
  return canvas->finish();
}

/// Headings [rad] of the three views: near the start from the front, in the middle from behind, at
/// the turn towards the start.
std::array<double, 3> view_headings(const std::vector<RobotSnapshot>& snapshots,
                                    const std::vector<std::size_t>& notable) {
  const auto& first = snapshots[notable.front()].qpos;
  const auto& middle = snapshots[notable[notable.size() / 2]].qpos;
  const auto& last = snapshots[notable.back()].qpos;
  const Eigen::Vector3d back = position_of(snapshots.front().qpos) - position_of(last);
  return {heading_of(first) + std::numbers::pi, heading_of(middle), std::atan2(back.y(), back.x())};
}

}  // namespace

Camera robot_camera(const Scene& scene, const std::vector<double>& qpos, double heading) {
  constexpr double kElevation = -14.0;
  constexpr double kUsualHeight = 0.35;  ///< of a trunk over the floor; a higher one needs room [m]
  const double heading_deg = heading * 180.0 / std::numbers::pi;
  const Eigen::Vector3d target = position_of(qpos) + Eigen::Vector3d(0.0, 0.0, 0.03);
  const double over_floor = target.z() - floor_height(scene.floor, target.x(), target.y());
  const double size = std::max(1.0, over_floor / kUsualHeight);
  for (const double distance : {1.4 * size, 1.1 * size, 0.8 * size}) {
    for (const double turn : {0.0, 180.0}) {
      for (const double aside : {25.0, -25.0, 15.0, -15.0, 0.0}) {
        const Camera camera{target, distance, heading_deg + turn + aside, kElevation};
        if (sees(scene, camera.position(), target)) return camera;
      }
    }
  }
  return {target, 0.8 * size, heading_deg, kElevation};
}

std::vector<std::size_t> notable_snapshots(const std::vector<RobotSnapshot>& snapshots) {
  if (snapshots.empty()) return {};
  const Eigen::Vector3d start = position_of(snapshots.front().qpos);
  const auto away = [&](std::size_t i) {
    return (position_of(snapshots[i].qpos) - start).head<2>().norm();
  };
  std::size_t farthest = 0;
  for (std::size_t i = 1; i < snapshots.size(); ++i) {
    if (away(i) > away(farthest)) farthest = i;
  }
  const auto first_beyond = [&](double distance) {
    std::size_t i = 0;
    while (i < farthest && away(i) < distance) ++i;
    return i;
  };
  std::size_t turning = farthest;
  const double heading = heading_of(snapshots[first_beyond(0.5 * away(farthest))].qpos);
  for (std::size_t i = farthest; i < snapshots.size() && away(farthest) - away(i) < 1.5; ++i) {
    turning = i;
    if (std::abs(wrap_angle(heading_of(snapshots[i].qpos) - heading)) > 1.9) break;
  }
  std::vector<std::size_t> notable;
  for (const std::size_t i : {first_beyond(std::min(1.5, 0.2 * away(farthest))),
                              first_beyond(0.5 * away(farthest)), turning}) {
    if (notable.empty() || i > notable.back()) notable.push_back(i);
  }
  return notable;
}

Result<std::vector<std::filesystem::path>> write_robot_pictures(
    const std::filesystem::path& folder, std::string_view scenario, const Scene& scene,
    std::string_view robot_mjcf, const std::vector<RobotSnapshot>& snapshots,
    const ViewConfig& config) {
  struct Shot {
    const char* file;
    const char* where;
  };
  constexpr std::array<Shot, 3> kShots = {{{"robot_start.png", "near the start"},
                                           {"robot_middle.png", "half-way to the farthest point"},
                                           {"robot_turn.png", "at the farthest point"}}};
  const std::vector<std::size_t> notable = notable_snapshots(snapshots);
  if (notable.empty()) return failure("no snapshot of the robot to draw");
  const MjcfOptions options{.image_width = config.width, .image_height = config.height};
  std::optional<SceneView> view;
  const auto show = [&](Time stamp) -> Result<void> {
    view.reset();  // before the next one makes its own context the current one
    const auto mjcf = scene_mjcf(scene_at(scene, stamp), robot_mjcf, MjcfPurpose::kRender, options);
    if (!mjcf) return tl::unexpected(mjcf.error());
    auto made = SceneView::create(*mjcf, height_field_data(scene.floor), config);
    if (!made) return tl::unexpected(made.error());
    view.emplace(std::move(*made));
    return {};
  };
  const std::array<double, 3> headings = view_headings(snapshots, notable);
  std::vector<std::filesystem::path> files;
  for (std::size_t i = 0; i < notable.size(); ++i) {
    const RobotSnapshot& snapshot = snapshots[notable[i]];
    if (!view || !scene.people.empty()) {  // people have moved
      if (auto ok = show(snapshot.stamp); !ok) return tl::unexpected(ok.error());
    }
    const Camera camera = robot_camera(scene, snapshot.qpos, headings[i]);
    const auto picture = view->draw(snapshot.qpos, camera);
    if (!picture) return tl::unexpected(picture.error());
    files.push_back(folder / kShots[i].file);
    const auto written =
        write_with_caption(files.back(), *picture, caption(scenario, kShots[i].where, snapshot));
    if (!written) return tl::unexpected(written.error());
  }
  return files;
}

}  // namespace aims
