// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace aims {

// What is fed with any bytes: it may refuse them, but never crash, hang or take much memory.

/// The bytes of a bag: read by its index and by scanning, every message decoded; then as a
/// recording.
void fuzz_bag(std::span<const std::uint8_t> input);
/// The same of an MCAP file, of a capture of a VLP-16, and of a SQLite file of rosbag2.
void fuzz_mcap(std::span<const std::uint8_t> input);
void fuzz_pcap(std::span<const std::uint8_t> input);
void fuzz_db3(std::span<const std::uint8_t> input);
/// The metadata of an Ouster (its length, JSON), and packets of the size that it states.
void fuzz_ouster(std::span<const std::uint8_t> input);
/// A message definition, and the bytes of a message, of ROS 1; and of ROS 2 (CDR), whose
/// definition is read as .msg and as OMG IDL.
void fuzz_message(std::span<const std::uint8_t> input);
void fuzz_cdr(std::span<const std::uint8_t> input);
/// Messages of a robot's topics in a sound bag, their content free: read as a recording.
void fuzz_recording(std::span<const std::uint8_t> input);
/// Sound messages of a robot's state, and of the packets of a LiDAR, with bytes changed.
void fuzz_states(std::span<const std::uint8_t> input);
void fuzz_legs(std::span<const std::uint8_t> input);  ///< of single legs, also in batches
void fuzz_packets(std::span<const std::uint8_t> input);
/// Messages of three bags as one recording: in order of time, the same when read again.
void fuzz_merged(std::span<const std::uint8_t> input);
/// A scenario, a configuration of `aims estimate`, plans; or lines of `--set KEY=VALUE`.
void fuzz_yaml(std::span<const std::uint8_t> input);
/// A text as TUM, KITTI, CSV, PLY and waypoint times, each read and what was read written again.
void fuzz_tables(std::span<const std::uint8_t> input);
/// JSON as every file of results: read as records, as a store of jobs, and for a page.
void fuzz_json(std::span<const std::uint8_t> input);

}  // namespace aims
