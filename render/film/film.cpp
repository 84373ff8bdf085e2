// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "render/film/film_plan.hpp"
#include "render/plots/canvas.hpp"
#include "render/plots/map_picture.hpp"
#include "render/plots/palette.hpp"
#include "render/plots/scene_plan.hpp"
#include "render/scene/scene_edges.hpp"
#include "render/scene/scene_view.hpp"
#include "sim/environment/scene_mjcf.hpp"
#include "sim/robot/robot_config.hpp"

namespace aims {
namespace {

constexpr double kSection = 1.6;  ///< height over the floor at which map and walls are cut [m]
constexpr Color kGround{0.070, 0.080, 0.105};
constexpr std::array<std::uint8_t, 4> kEdge = {150, 165, 190, 70};
constexpr std::array<std::uint8_t, 4> kTruth = {255, 255, 255, 255};
constexpr std::array<std::uint8_t, 4> kEstimate = {255, 120, 40, 255};
constexpr std::array<std::uint8_t, 4> kScan = {255, 90, 210, 255};
constexpr float kScanLift = 0.03F;  ///< of the scan towards the camera, over the map [m]
constexpr std::array kAsides = {38.0, -38.0, 12.0, -12.0};  ///< of the camera's heading [deg]
constexpr double kRobotReach = 0.3;                         ///< around its middle [m]
constexpr Duration kSmoothing = kSecond;  ///< the camera does not sway with the robot

Color color_of(const std::array<std::uint8_t, 4>& rgba) {
  return {rgba[0] / 255.0, rgba[1] / 255.0, rgba[2] / 255.0};
}

/// Floor alone, dark: walls are drawn as edges, so that the map on them is seen from both sides.
Scene bare(const Scene& scene) {
  Scene result;
  result.floor = scene.floor;
  result.floor.material.color = Eigen::Vector3f(0.105F, 0.118F, 0.145F);
  return result;
}

double heading_at(const Trajectory& truth, Time stamp) {
  const auto pose = pose_at(truth, stamp);
  return pose ? yaw_of(pose->rotation) : 0.0;
}

Eigen::Vector3d smooth_position(const Trajectory& truth, Time stamp) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (Time t = stamp - kSmoothing; t <= stamp + kSmoothing; t += 100 * kMillisecond) {
    const Time inside = std::clamp(t, truth.front().stamp, truth.back().stamp);
    sum += pose_at(truth, inside)->translation;
    ++count;
  }
  return sum / count;
}

/// The lines with what is higher over the floor than the cut brought down to it.
std::vector<ViewLine> cut_edges(const Scene& scene) {
  std::vector<ViewLine> edges;
  for (auto& edge : scene_edges(scene)) {
    for (Eigen::Vector3f& point : edge) {
      const double top = floor_height(scene.floor, point.x(), point.y()) + kSection;
      point.z() = std::min(point.z(), static_cast<float>(top));
    }
    edges.push_back({std::move(edge), kEdge});
  }
  return edges;
}

/// Heading [deg] from the start to the farthest point of the trajectory.
double outbound_deg(const Trajectory& truth) {
  const Eigen::Vector3d start = truth.front().pose.translation;
  const auto farthest =
      std::max_element(truth.begin(), truth.end(), [&](const auto& a, const auto& b) {
        return (a.pose.translation - start).squaredNorm() <
               (b.pose.translation - start).squaredNorm();
      });
  const Eigen::Vector3d out = farthest->pose.translation - start;
  return std::atan2(out.y(), out.x()) * 180.0 / std::numbers::pi;
}

std::vector<Eigen::Vector3f> line_until(const Trajectory& trajectory, Time stamp) {
  std::vector<Eigen::Vector3f> line;
  for (const StampedPose& each : trajectory) {
    if (each.stamp > stamp) break;
    line.push_back(each.pose.translation.cast<float>());
  }
  return line;
}

std::vector<GrownPoint> cut_map(const std::vector<GrownPoint>& map) {
  std::vector<Eigen::Vector3f> positions;
  for (const GrownPoint& point : map) positions.push_back(point.position);
  const std::vector<bool> under = under_roof(positions, kSection);
  std::vector<GrownPoint> result;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (under[i]) result.push_back(map[i]);
  }
  return result;
}

/// Whether a person stands between the eye and a point.
bool is_hidden(const Eigen::Vector3d& point, const Eigen::Vector3d& eye, const Scene& scene,
               Time stamp) {
  constexpr int kSteps = 40;
  for (const Person& person : scene.people) {
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Vector3d p = point + (eye - point) * i / kSteps;
      const double away = (p.head<2>() - person.position(stamp)).norm();
      if (p.z() < person.height && away < person.radius + kRobotReach) return true;
    }
  }
  return false;
}

}  // namespace

struct Film::Impl {
  const FilmedSequence& sequence;
  FilmConfig config;
  std::vector<GrownPoint> map;    ///< without what is above the cut
  std::vector<ViewPoint> points;  ///< of the same
  std::vector<ViewPoint> shown;   ///< map and scan of a picture
  std::vector<ViewLine> edges;
  std::optional<FilmPlan> plan;
  double azimuth_deg = 0.0;
  std::optional<SceneView> view;

  Impl(const FilmedSequence& filmed, const FilmConfig& how) : sequence(filmed), config(how) {}

  Result<void> show_scene(Time stamp);
  void color_points();
  Camera camera(Time stamp) const;
  Camera camera_from(double aside_deg, Time stamp) const;
  void show_points(Time stamp);
  ViewOverlay overlay(Time stamp) const;
  std::size_t count(Time stamp) const;
  void label(Canvas& canvas, Time stamp) const;
};

/// Rebuilds the model where people have moved since.
Result<void> Film::Impl::show_scene(Time stamp) {
  if (view && sequence.scene.people.empty()) return {};
  view.reset();  // before the next one makes its own context the current one
  Scene scene = bare(sequence.scene);
  scene.people = sequence.scene.people;
  const MjcfOptions options{.image_width = config.width, .image_height = config.height};
  const auto robot = robot_model(sequence.robot);
  if (!robot) return tl::unexpected(robot.error());
  const auto mjcf = scene_mjcf(scene_at(scene, stamp), robot->mjcf, MjcfPurpose::kRender, options);
  if (!mjcf) return tl::unexpected(mjcf.error());
  const ViewConfig how{.width = config.width, .height = config.height, .sky = kGround};
  auto made = SceneView::create(*mjcf, height_field_data(scene.floor), how);
  if (!made) return tl::unexpected(made.error());
  view.emplace(std::move(*made));
  return {};
}

void Film::Impl::color_points() {
  std::vector<Eigen::Vector3f> positions;
  for (const GrownPoint& point : map) positions.push_back(point.position);
  const HeightRange heights = map_heights(positions);
  const auto table = height_table();
  std::vector<RasterPoint> flat;
  for (const GrownPoint& point : map) {
    const double fraction = (point.position.z() - heights.min) / (heights.max - heights.min);
    const auto entry = static_cast<std::size_t>(255.0 * std::clamp(fraction, 0.0, 1.0));
    const auto& color = table[entry];
    points.push_back({point.position, {color[0], color[1], color[2], 255}});
    flat.push_back(
        {point.position.x(), point.position.y(), point.position.z(), static_cast<float>(fraction)});
  }
  std::vector<Eigen::Vector2d> path;
  for (const StampedPose& each : sequence.truth) path.emplace_back(each.pose.translation.head<2>());
  plan.emplace(std::move(flat), path, config.width, config.height);
}

/// The robot stands above the middle, since the plan lies below it; the camera looks outbound
/// from a little aside, and steeply enough to see over the near wall.
Camera Film::Impl::camera_from(double aside_deg, Time stamp) const {
  Camera result;
  const bool top = config.view == FilmView::kTop;
  result.azimuth_deg = top ? azimuth_deg + 90.0 : azimuth_deg + aside_deg;
  result.elevation_deg = top ? -90.0 : -47.0;
  result.distance = (top ? 13.0 : 8.5) * (config.still ? 0.55 : 1.0);
  const double azimuth = result.azimuth_deg * std::numbers::pi / 180.0;
  const Eigen::Vector3d ahead(std::cos(azimuth), std::sin(azimuth), 0.0);
  result.target = smooth_position(sequence.truth, stamp) - 0.08 * result.distance * ahead;
  return result;
}

/// From the right; a still from the first side on which no person hides the robot. A film does not
/// change sides.
Camera Film::Impl::camera(Time stamp) const {
  const auto robot = pose_at(sequence.truth, stamp);
  if (!config.still || !robot) return camera_from(kAsides.front(), stamp);
  for (const double aside_deg : kAsides) {
    const Camera camera = camera_from(aside_deg, stamp);
    if (!is_hidden(robot->translation, camera.position(), sequence.scene, stamp)) return camera;
  }
  return camera_from(kAsides.front(), stamp);
}

/// The map so far and, a little before it, the last scan, without what is above the cut.
void Film::Impl::show_points(Time stamp) {
  shown.assign(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count(stamp)));
  const auto after =
      std::upper_bound(sequence.scans.begin(), sequence.scans.end(), stamp,
                       [](Time value, const PlacedScan& scan) { return value < scan.end; });
  if (after == sequence.scans.begin()) return;
  const Eigen::Vector3f eye = camera(stamp).position().cast<float>();
  for (const Eigen::Vector3f& p : std::prev(after)->points) {
    const double top = floor_height(sequence.scene.floor, p.x(), p.y()) + kSection;
    if (p.z() <= top) shown.push_back({p + kScanLift * (eye - p).normalized(), kScan});
  }
}

ViewOverlay Film::Impl::overlay(Time stamp) const {
  ViewOverlay result;
  result.points = shown;
  result.point_diameter = config.still ? 0.020F : 0.045F;
  const auto unit = static_cast<float>(config.height / 400.0);
  result.least_diameter = 1.2F * unit;
  result.lines = edges;
  for (ViewLine& edge : result.lines) edge.width = unit;
  result.lines.push_back({line_until(sequence.truth, stamp), kTruth, 2.0F * unit});
  result.lines.push_back(
      {line_until(sequence.estimates.front().trajectory, stamp), kEstimate, 2.0F * unit});
  result.haze = {static_cast<float>(kGround.red), static_cast<float>(kGround.green),
                 static_cast<float>(kGround.blue)};
  const double distance = camera(stamp).distance;
  result.haze_from = static_cast<float>(1.2 * distance);
  result.haze_to = static_cast<float>(6.0 * distance);
  return result;
}

std::size_t Film::Impl::count(Time stamp) const {
  const auto after =
      std::upper_bound(map.begin(), map.end(), stamp,
                       [](Time value, const GrownPoint& point) { return value < point.seen; });
  return static_cast<std::size_t>(after - map.begin());
}

void Film::Impl::label(Canvas& canvas, Time stamp) const {
  const double unit = config.height / 400.0;
  const double left = 14.0 * unit;
  canvas.fill(Rect{0.0, 0.0, static_cast<double>(config.width), 52.0 * unit},
              {0.05, 0.06, 0.08, 0.72});
  const Color light{0.94, 0.95, 0.97};
  const NamedTrajectory& drawn = sequence.estimates.front();
  canvas.text({left, 20.0 * unit}, sequence.scenario,
              {.size = 15.0 * unit, .color = light, .bold = true});
  std::string state = fmt::format("t = {:.0f} s", to_seconds(stamp));
  const auto truth = pose_at(sequence.truth, stamp);
  const auto estimate = pose_at(drawn.trajectory, stamp);
  if (truth && estimate) {
    state += fmt::format(",  error {:.2f} m", (truth->translation - estimate->translation).norm());
  }
  canvas.text({left, 39.0 * unit}, state, {.size = 12.0 * unit, .color = light});
  const TextStyle small{.size = 12.0 * unit, .color = light, .horizontal = Align::kEnd};
  const std::string scan = sequence.scene.people.empty()
                               ? "current scan"
                               : "current scan; people left out of the map by their true places";
  if (!sequence.scans.empty()) {
    const double right = config.width - left;
    canvas.text({right, 39.0 * unit}, scan, small);
    const double end = right - canvas.text_width(scan, small) - 6.0 * unit;
    canvas.line({{end - 16.0 * unit, 39.0 * unit}, {end, 39.0 * unit}},
                {color_of(kScan), 2.5 * unit});
  }
  double x = config.width - left;
  for (const auto& [name, color] :
       {std::pair{"trajectory and map of " + drawn.name, color_of(kEstimate)},
        {std::string("true trajectory"), color_of(kTruth)}}) {
    const TextStyle style{.size = 12.0 * unit, .color = light, .horizontal = Align::kEnd};
    canvas.text({x, 20.0 * unit}, name, style);
    x -= canvas.text_width(name, style) + 6.0 * unit;
    canvas.line({{x - 16.0 * unit, 20.0 * unit}, {x, 20.0 * unit}}, {color, 2.5 * unit});
    x -= 32.0 * unit;
  }
}

Film::Film(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Film::Film(Film&&) noexcept = default;
Film& Film::operator=(Film&&) noexcept = default;
Film::~Film() = default;

Result<Film> Film::create(const FilmedSequence& sequence, const FilmConfig& config) {
  if (sequence.snapshots.empty() || sequence.truth.empty() || sequence.estimates.empty()) {
    return failure("no snapshot of the robot to draw");
  }
  auto impl = std::make_unique<Impl>(sequence, config);
  impl->map = cut_map(sequence.map);
  impl->color_points();
  impl->edges = cut_edges(sequence.scene);
  impl->azimuth_deg = outbound_deg(sequence.truth);
  if (auto shown = impl->show_scene(sequence.snapshots.front().stamp); !shown) {
    return tl::unexpected(shown.error());
  }
  return Film(std::move(impl));
}

std::size_t Film::points_shown(Time stamp) const { return impl_->count(stamp); }

Result<Image> Film::picture(Time wanted) {
  const std::vector<RobotSnapshot>& shots = impl_->sequence.snapshots;
  const auto nearest =
      std::min_element(shots.begin(), shots.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.stamp - wanted) < std::abs(b.stamp - wanted);
      });
  const Time stamp = nearest->stamp;
  if (auto shown = impl_->show_scene(stamp); !shown) return tl::unexpected(shown.error());
  impl_->show_points(stamp);
  auto picture = impl_->view->draw(nearest->qpos, impl_->camera(stamp), impl_->overlay(stamp));
  if (!picture) return picture;
  Canvas canvas = Canvas::over(*picture);
  impl_->plan->draw(canvas, impl_->count(stamp), {nearest->qpos[0], nearest->qpos[1]},
                    heading_at(impl_->sequence.truth, stamp));
  impl_->label(canvas, stamp);
  return canvas.pixels();
}

}  // namespace aims
