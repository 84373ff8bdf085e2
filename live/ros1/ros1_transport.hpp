// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "live/transport.hpp"

namespace aims {

/// The arguments without those of ROS ("topic:=other", "__name:=other") and without the program's
/// name.
std::vector<std::string> arguments_without_ros(int argc, char** argv);

/// Registers a node of a ROS 1 network. Error without a master.
Result<std::unique_ptr<Transport>> connect_to_ros1(int argc, char** argv, const std::string& name);

}  // namespace aims
