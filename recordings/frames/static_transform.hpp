// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "recordings/frames/fixed_transform.hpp"

namespace aims {

/// The arguments of a ROS static_transform_publisher: "x y z yaw pitch roll PARENT CHILD [PERIOD]",
/// "x y z qx qy qz qw PARENT CHILD [PERIOD]", or the options of ROS 2, "--x 1 --yaw 0.1 --frame-id
/// PARENT --child-frame-id CHILD". The name of the program may come first. Errors begin with
/// `place`.
Result<FixedTransform> parse_static_transform(std::string_view arguments, std::string_view place);

/// Every static_transform_publisher of a launch file or a script. Errors: "name:line: ...".
Result<std::vector<FixedTransform>> parse_static_transforms(std::string_view text,
                                                            const std::string& name);

/// The fixed joints of a URDF file. Errors: "name:line: ...".
Result<std::vector<FixedTransform>> parse_urdf(std::string_view text, const std::string& name);

}  // namespace aims
