// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace aims {

/// How the values of a message become bytes.
enum class Serialization {
  kRos1,   ///< little endian, without padding
  kCdr,    ///< ROS 2: XCDR version 1 behind a header of 4 bytes, either byte order, with padding
  kOther,  ///< e.g. protobuf: listed, not decoded
};

/// The language in which a message type is defined.
enum class DefinitionLanguage { kRos1Msg, kRos2Msg, kRos2Idl };

struct MessageFormat {
  Serialization serialization = Serialization::kRos1;
  DefinitionLanguage language = DefinitionLanguage::kRos1Msg;

  bool operator==(const MessageFormat&) const = default;
};

inline constexpr MessageFormat kRos1Format{};
inline constexpr MessageFormat kRos2Format{Serialization::kCdr, DefinitionLanguage::kRos2Msg};

/// A message type.
struct MessageType {
  std::string name;        ///< e.g. "sensor_msgs/Imu", in ROS 2 too
  std::string md5;         ///< 32 hex digits that identify the version of the type; ROS 1 alone
  std::string definition;  ///< text of its fields, then of every type that it uses
  MessageFormat format = {};
};

}  // namespace aims
