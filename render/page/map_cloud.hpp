// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/lie.hpp"
#include "render/page/page_data.hpp"
#include "render/page/surface_distance.hpp"

namespace aims {

/// Points that a page shows at most: of one map, and of all maps.
inline constexpr std::size_t kMostMapPoints = 60000;
inline constexpr std::size_t kMostPagePoints = 300000;
/// Steps of the places of a map's points [m]; coarser for a map beyond 655 m.
inline constexpr double kMapStep = 0.01;
/// Height over the local floor above which a map's points count as ceiling [m].
inline constexpr double kCeilingCut = 2.0;
/// Distance [m] to the true surface that the largest error byte stands for.
inline constexpr float kLargestMapError = 0.5F;

/// At most `most` of the points, one in each cube of a grid, as fine as that allows; their order
/// is kept.
std::vector<Eigen::Vector3f> thinned_cloud(std::span<const Eigen::Vector3f> points,
                                           std::size_t most);

/// Points that each of so many maps shows at most.
std::size_t most_points(std::size_t maps);

/// A map, given in its odometry frame [m], in the world: "points" of which "n" are shown, those
/// "below" `kCeilingCut` first; places "p" in steps of `kMapStep`; distances to the true surface as
/// bytes of `kLargestMapError`, null without a surface. Null without points. `most`: as of
/// `most_points`; `roofed`: whether there may be a ceiling.
Json map_json(std::span<const Eigen::Vector3f> points, const Pose& T_world_odom,
              const SurfaceDistance* surface, std::size_t most, bool roofed, PageData& page);

/// Indices of points, those that `first` holds before the others, each part along a space-filling
/// curve: neighbours in the list are neighbours in space, which compresses well.
std::vector<std::size_t> ordered_in_space(std::span<const Eigen::Vector3f> points,
                                          const std::vector<bool>& first);

}  // namespace aims
