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

/// Points of a map that a page shows at most.
inline constexpr std::size_t kMostMapPoints = 60000;
/// Distance [m] to the true surface that the largest error byte stands for.
inline constexpr float kLargestMapError = 0.5F;

/// At most `most` of the points, one in each cube of a grid, as fine as that allows; their order
/// is kept.
std::vector<Eigen::Vector3f> thinned_cloud(std::span<const Eigen::Vector3f> points,
                                           std::size_t most);

/// A map, given in its odometry frame [m], in the world: places as 16-bit fractions of its box,
/// distances to the true surface as bytes of `kLargestMapError`; those are null without a surface,
/// the whole without points.
PageData::Json map_json(std::span<const Eigen::Vector3f> points, const Pose& T_world_odom,
                        const SurfaceDistance* surface, PageData& page);

}  // namespace aims
