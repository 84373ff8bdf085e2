// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "recordings/frames/fixed_transform.hpp"

namespace aims {

/// The fixed transforms of a calibration, recognized by its content:
/// - YAML or JSON with keys T_A_B or A_T_B (pose of B in A; Kalibr's T_cam_imu below cam0, and
///   T_cn_cnm1), A_to_B_transform (of A in B; Ouster's in mm) or A_in_B, as lists of 16 or 12
///   numbers, lists of rows, or OpenCV matrices; A_in_B also as a map of translation and
///   quaternion_xyzw, rotation_matrix or rotation_rpy_deg; FAST-LIO's extrinsic_T and extrinsic_R;
///   MultiCal's T_here_B (pose of B in the sensor that the key stands below); T_A_B_t_xyz_q_xyzw as
///   7 numbers (Oxford Spires);
/// - a URDF file: its fixed joints;
/// - a launch file or script: its static_transform_publishers.
/// Errors name `name`, the line, and what was expected.
Result<std::vector<FixedTransform>> parse_calibration(const std::string& text,
                                                      const std::string& name);

/// The pose of frame `child` in frame `parent` over the transforms of the file. Names that are
/// empty: the only frame whose name tells the IMU ("imu", "body") as parent, or the LiDAR as child.
/// Errors list the frames of the file.
Result<Pose> read_extrinsic(const std::filesystem::path& file, const std::string& parent,
                            const std::string& child);

}  // namespace aims
