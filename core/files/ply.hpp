// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace aims {

/// A cloud of points as binary little-endian PLY: one element `vertex` of float32 x, y, z [m].
std::string ply_text(std::span<const Eigen::Vector3f> points);

/// Reads binary little-endian PLY whose first element is `vertex` with float32 x, y, z, in that
/// order and first; other properties and elements are skipped. Errors name the file and what was
/// expected.
Result<std::vector<Eigen::Vector3f>> parse_ply(std::string_view text, const std::string& name);

/// Writes `ply_text` atomically.
Result<void> write_ply(const std::filesystem::path& file, std::span<const Eigen::Vector3f> points);

/// Reads a PLY file with `parse_ply`.
Result<std::vector<Eigen::Vector3f>> read_ply(const std::filesystem::path& file);

}  // namespace aims
