// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>

#include "recordings/messages/message_bytes.hpp"

namespace aims::test {

/// A type that a definition uses, as a bag lists it behind the definition.
inline std::string used(const std::string& type, const std::string& fields) {
  return "\n" + std::string(80, '=') + "\nMSG: " + type + "\n" + fields;
}

inline std::string used_header() {
  return used("std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id\n");
}

/// "float64 x, y, z" under that name.
inline std::string used_vector(const std::string& type) {
  return used(type, "float64 x\nfloat64 y\nfloat64 z\n");
}

template <class Number>
void fill(MessageBytes& out, std::size_t count, Number value = {}) {
  for (std::size_t i = 0; i < count; ++i) out.put(value);
}

inline void put_header(MessageBytes& out, Time stamp, const std::string& frame) {
  out.put(std::uint32_t{0});
  out.time(stamp);
  out.text(frame);
}

template <class Number>
void put_vector(MessageBytes& out, const Eigen::Vector3d& v) {
  for (const double each : v) out.put(static_cast<Number>(each));
}

}  // namespace aims::test
