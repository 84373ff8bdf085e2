// SPDX-License-Identifier: BSD-3-Clause
#include "live/dds/dds_options.hpp"

#include <fmt/format.h>

#include <regex>

#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::uint32_t kMaxDomain = 232;  ///< beyond it ports exceed 65535

std::string is_domain(const std::string& text) {
  const auto domain = number_from<std::uint32_t>(text);
  return domain && *domain <= kMaxDomain
             ? ""
             : fmt::format("expected a number from 0 to {}, also in $ROS_DOMAIN_ID, got '{}'",
                           kMaxDomain, text);
}

constexpr std::size_t kLongestNode = 200;  ///< DDS allows 255 characters for a topic

/// What ROS 2 takes as a namespace: words of letters, digits and _, joined by /.
std::string is_node_name(const std::string& name) {
  const std::regex words("[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z0-9_]+)*");
  return name.size() <= kLongestNode && std::regex_match(name, words)
             ? ""
             : fmt::format("expected at most {} letters, digits, _ and /, e.g. aims, got '{}'",
                           kLongestNode, name);
}

}  // namespace

void add_domain_option(CLI::App& app, DdsOptions& options) {
  app.add_option("--domain", options.domain, "DDS domain ($ROS_DOMAIN_ID, else 0)")
      ->envname("ROS_DOMAIN_ID")
      ->check(is_domain);
}

void add_node_option(CLI::App& app, DdsOptions& options, const std::string& help) {
  app.add_option("--node", options.node, help)->check(is_node_name);
}

}  // namespace aims
