// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include "live/dds/dds_transport.hpp"

namespace aims {

/// Declares --domain, by default $ROS_DOMAIN_ID, else 0.
void add_domain_option(CLI::App& app, DdsOptions& options);

/// Declares --node: `help` says of what.
void add_node_option(CLI::App& app, DdsOptions& options, const std::string& help);

}  // namespace aims
