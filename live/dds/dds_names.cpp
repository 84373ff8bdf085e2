// SPDX-License-Identifier: BSD-3-Clause
#include "live/dds/dds_names.hpp"

#include <string_view>

namespace aims {
namespace {

constexpr std::string_view kTopicPrefix = "rt/";
constexpr std::string_view kMiddle = "::msg::dds_::";

}  // namespace

std::string dds_topic(const std::string& topic) {
  return std::string(kTopicPrefix) + topic.substr(topic.starts_with("/") ? 1 : 0);
}

std::optional<std::string> ros_topic(const std::string& dds) {
  if (!dds.starts_with(kTopicPrefix) || dds.size() == kTopicPrefix.size()) return std::nullopt;
  return dds.substr(kTopicPrefix.size() - 1);  // from the slash on
}

std::string dds_type(const std::string& type) {
  const std::size_t slash = type.find('/');
  if (slash == std::string::npos) return type;
  return type.substr(0, slash) + std::string(kMiddle) + type.substr(slash + 1) + "_";
}

std::optional<std::string> ros_type(const std::string& dds) {
  const std::size_t middle = dds.find(kMiddle);
  const std::size_t name = middle + kMiddle.size();
  if (middle == std::string::npos || middle == 0 || dds.size() < name + 2 || !dds.ends_with("_")) {
    return std::nullopt;
  }
  return dds.substr(0, middle) + "/" + dds.substr(name, dds.size() - name - 1);
}

}  // namespace aims
