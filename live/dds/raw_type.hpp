// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

struct ddsi_sertype;
struct ddsi_serdata;

namespace aims {

/// Longest message that is received [bytes]: a cloud of 4 million points.
inline constexpr std::size_t kMaxSample = std::size_t{128} << 20;

/// A type of CycloneDDS under that name whose samples are bytes: CDR behind its header of four
/// bytes. No definition is needed. `dds_create_topic_sertype` takes over the reference; `dds_write`
/// takes a `std::span<const std::byte>` as sample.
ddsi_sertype* make_raw_type(const std::string& name);

/// The bytes of a sample that `dds_takecdr` gave, without what pads them; empty for one without
/// data.
std::span<const std::byte> raw_bytes(const ddsi_serdata& sample);

/// Who sent a sample, and as its how many-th, beginning with 1; 0: it did not come by the network.
struct SampleOrigin {
  std::array<std::byte, 16> writer{};
  std::uint64_t number = 0;
};
SampleOrigin origin_of(const ddsi_serdata& sample);

}  // namespace aims
