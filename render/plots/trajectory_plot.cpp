// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/trajectory_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/plots/plot.hpp"
#include "render/plots/scene_plan.hpp"

namespace aims {
namespace {

constexpr int kWidth = 1800;
constexpr double kFollow = 2.0;  ///< the axes follow estimates up to this far from the truth [m]

/// An estimate compared with the truth at its stamps.
struct Comparison {
  std::vector<double> distance;           ///< travelled by the truth [m]
  std::vector<Eigen::Vector3d> position;  ///< estimated [m]
  std::vector<double> error;              ///< distance from the truth [m]
};

/// Distance travelled by the truth at each of its stamps [m]; steps below 10 cm do not count, so
/// that swaying on the spot is no travel.
std::vector<double> travelled(const Trajectory& truth) {
  std::vector<double> distance;
  Eigen::Vector2d last = truth.front().pose.translation.head<2>();
  double sum = 0.0;
  for (const StampedPose& sample : truth) {
    const Eigen::Vector2d position = sample.pose.translation.head<2>();
    const double step = (position - last).norm();
    if (step > 0.1) {
      sum += step;
      last = position;
    }
    distance.push_back(sum + (step > 0.1 ? 0.0 : step));
  }
  for (std::size_t i = 1; i < distance.size(); ++i) {
    distance[i] = std::max(distance[i], distance[i - 1]);
  }
  return distance;
}

double distance_at(const Trajectory& truth, const std::vector<double>& distance, Time stamp) {
  const auto after =
      std::lower_bound(truth.begin(), truth.end(), stamp,
                       [](const StampedPose& sample, Time value) { return sample.stamp < value; });
  const auto index = std::min<std::ptrdiff_t>(after - truth.begin(),
                                              static_cast<std::ptrdiff_t>(truth.size()) - 1);
  return distance[static_cast<std::size_t>(index)];
}

Comparison compare(const Trajectory& truth, const std::vector<double>& distance,
                   const Trajectory& estimate) {
  Comparison result;
  for (const StampedPose& sample : estimate) {
    const auto true_pose = pose_at(truth, sample.stamp);
    if (!true_pose) continue;
    result.distance.push_back(distance_at(truth, distance, sample.stamp));
    result.position.push_back(sample.pose.translation);
    result.error.push_back((sample.pose.translation - true_pose->translation).norm());
  }
  return result;
}

const Stroke kTruthStroke{{0.0, 0.0, 0.0}, 3.5};

struct Study {
  std::vector<double> truth_distance;
  std::vector<Comparison> estimates;
  std::vector<Stroke> strokes;  ///< of the estimates
  Extent x, y, z;               ///< of the axes [m]
  Extent error;                 ///< [m]
};

/// Ranges of the axes: those of the truth and of estimates while they are near it.
Study study(const TrajectoryPlot& plot) {
  Study result;
  result.truth_distance = travelled(plot.truth);
  const auto include = [&](const Eigen::Vector3d& position) {
    result.x.include(position.x());
    result.y.include(position.y());
    result.z.include(position.z());
  };
  for (const StampedPose& sample : plot.truth) include(sample.pose.translation);
  std::vector<std::string> names;
  for (const NamedTrajectory& estimate : plot.estimates) names.push_back(estimate.name);
  result.strokes = series_strokes(names);
  for (const NamedTrajectory& estimate : plot.estimates) {
    result.estimates.push_back(compare(plot.truth, result.truth_distance, estimate.trajectory));
    const Comparison& comparison = result.estimates.back();
    for (std::size_t i = 0; i < comparison.error.size(); ++i) {
      if (!std::isfinite(comparison.error[i])) continue;
      result.error.include(comparison.error[i]);
      if (comparison.error[i] <= kFollow) include(comparison.position[i]);
    }
  }
  result.x = result.x.widened(4.0);
  result.y = result.y.widened(1.5);
  result.z = result.z.widened(std::max(0.1, 0.1 * result.z.span()));
  return result;
}

bool leaves(const Study& study, const Comparison& comparison) {
  return std::any_of(
      comparison.position.begin(), comparison.position.end(), [&](const Eigen::Vector3d& p) {
        return !(study.x.contains(p.x()) && study.y.contains(p.y()) && study.z.contains(p.z()));
      });
}

/// Chooses the panel's height for equal scales, or labels by how much y is enlarged.
void set_plan_scale(Panel& panel, const std::string& label, Extent x, Extent y) {
  const double width = panel_width(kWidth);
  const double equal = width * y.span() / x.span();
  panel.height = std::clamp(equal, 260.0, 800.0);
  const double enlargement = panel.height / equal;
  if (enlargement < 1.0) {
    x = x.widened(0.5 * x.span() * (1.0 / enlargement - 1.0));
  }
  panel.x = {label, x.min, x.max};
  const bool enlarged = enlargement > 1.01;
  panel.y = {enlarged ? fmt::format("y, scale ×{:.1f} [m]", enlargement) : "y [m]", y.min, y.max};
  panel.title = enlarged ? fmt::format("Plan, y scale ×{:.1f}", enlargement) : "Plan";
}

Panel plan_panel(const TrajectoryPlot& plot, const Study& study) {
  Panel panel;
  const bool has_walls = !plot.scene.solids.empty();
  set_plan_scale(panel, has_walls ? "x, along the corridor [m]" : "x [m]", study.x, study.y);
  panel.areas = scene_plan(plot.scene);
  const auto add = [&](const Trajectory& trajectory, const Stroke& stroke) {
    std::vector<Eigen::Vector2d> points;
    for (const StampedPose& sample : trajectory)
      points.emplace_back(sample.pose.translation.head<2>());
    panel.series.push_back({"", std::move(points), stroke});
  };
  add(plot.truth, kTruthStroke);
  for (std::size_t i = plot.estimates.size(); i-- > 0;)  // the first lies on top
    add(plot.estimates[i].trajectory, study.strokes[i]);
  for (const WaypointTime& waypoint_time : plot.waypoint_times) {
    const auto pose = pose_at(plot.truth, waypoint_time.stamp);
    const auto same = [&](const Mark& mark) { return mark.label == waypoint_time.point; };
    if (!pose || std::any_of(panel.marks.begin(), panel.marks.end(), same)) continue;
    panel.marks.push_back({pose->translation.head<2>(), waypoint_time.point});
  }
  return panel;
}

std::vector<Event> events_of(const TrajectoryPlot& plot, const Study& study) {
  std::vector<Event> events;
  for (const WaypointTime& waypoint_time : plot.waypoint_times) {
    if (plot.truth.front().stamp > waypoint_time.stamp ||
        plot.truth.back().stamp < waypoint_time.stamp)
      continue;
    events.push_back(
        {distance_at(plot.truth, study.truth_distance, waypoint_time.stamp), waypoint_time.point});
  }
  return events;
}

/// A panel over the distance travelled, with a line per estimate; the first lies on top.
template <class Value>
Panel distance_panel(const TrajectoryPlot& plot, const Study& study, std::string title,
                     const Value& value) {
  const double end = std::max(1.0, study.truth_distance.back());
  Panel panel{.title = std::move(title), .x = {"distance travelled [m]", -0.01 * end, 1.01 * end}};
  panel.height = 230.0;
  panel.events = events_of(plot, study);
  for (std::size_t k = study.estimates.size(); k-- > 0;) {
    const Comparison& comparison = study.estimates[k];
    std::vector<Eigen::Vector2d> line;
    for (std::size_t i = 0; i < comparison.error.size(); ++i)
      line.emplace_back(comparison.distance[i], value(comparison, i));
    panel.series.push_back({"", std::move(line), study.strokes[k]});
  }
  return panel;
}

Panel height_panel(const TrajectoryPlot& plot, const Study& study) {
  Panel panel = distance_panel(
      plot, study, "Height",
      [](const Comparison& comparison, std::size_t i) { return comparison.position[i].z(); });
  panel.y = {"z [m]", study.z.min, study.z.max};
  std::vector<Eigen::Vector2d> truth;
  for (std::size_t i = 0; i < plot.truth.size(); ++i)
    truth.emplace_back(study.truth_distance[i], plot.truth[i].pose.translation.z());
  panel.series.insert(panel.series.begin(), {"", std::move(truth), kTruthStroke});
  return panel;
}

Panel error_panel(const TrajectoryPlot& plot, const Study& study) {
  Panel panel = distance_panel(plot, study, "Position error (logarithmic)",
                               [](const Comparison& comparison, std::size_t i) {
                                 return std::max(1e-4, comparison.error[i]);
                               });
  const double largest = std::isfinite(study.error.max) ? study.error.max : 1.0;
  panel.y = {"error [m]", 0.01, std::clamp(1.3 * largest, 0.1, 1e4), true};
  return panel;
}

}  // namespace

Result<void> write_trajectory_plot(const std::filesystem::path& path, const TrajectoryPlot& plot) {
  if (plot.truth.empty()) return failure(path.string() + ": no true trajectory to plot against");
  const Study result = study(plot);
  Figure figure{.title = plot.title, .subtitle = plot.subtitle, .width = kWidth};
  figure.legend.push_back({"truth", kTruthStroke});
  for (std::size_t i = 0; i < plot.estimates.size(); ++i) {
    const Comparison& comparison = result.estimates[i];
    std::string name = plot.estimates[i].name;
    if (comparison.error.empty())
      name += " (no poses)";
    else if (leaves(result, comparison))
      name += " (leaves the axes)";
    figure.legend.push_back({name, result.strokes[i]});
  }
  figure.panels = {plan_panel(plot, result), height_panel(plot, result), error_panel(plot, result)};
  return write_figure(path, figure);
}

}  // namespace aims
