// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/quality_of_service.hpp"

#include <fmt/format.h>

namespace aims {
namespace {

constexpr std::string_view kDurability = "durability:";

}  // namespace

std::string offered_quality(bool latching) {
  constexpr std::string_view kForever = "\n    sec: 9223372036\n    nsec: 854775807";
  return fmt::format(
      "- history: 1\n"
      "  depth: {}\n"
      "  reliability: 1\n"
      "  {} {}\n"
      "  deadline:{}\n"
      "  lifespan:{}\n"
      "  liveliness: 1\n"
      "  liveliness_lease_duration:{}\n"
      "  avoid_ros_namespace_conventions: false",
      latching ? 1 : 10, kDurability, latching ? 1 : 2, kForever, kForever, kForever);
}

bool is_transient_local(std::string_view offered) {
  const std::size_t key = offered.find(kDurability);
  if (key == std::string_view::npos) return false;
  const std::size_t value = offered.find_first_not_of(' ', key + kDurability.size());
  if (value == std::string_view::npos) return false;
  const std::string_view stated = offered.substr(value, offered.find('\n', value) - value);
  return stated == "1" || stated == "transient_local";
}

}  // namespace aims
