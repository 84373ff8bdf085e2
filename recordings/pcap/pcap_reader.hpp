// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "recordings/bag/chunk_reader.hpp"
#include "recordings/bag/kind_source.hpp"

namespace aims {

/// Reads a capture of a LiDAR's packets (.pcap) as messages: scans as sensor_msgs/PointCloud2; of
/// an Ouster also its IMU as sensor_msgs/Imu and its frames on /tf_static. NAME.json beside
/// NAME.pcap is the metadata of an Ouster; without it the packets are those of a Velodyne VLP-16 or
/// a Hesai XT32 or XT16, by their first bytes.
/// The incomplete scans at both ends are left out.
class PcapReader final : public KindSource {
 public:
  /// Error for a capture without such packets. Of a truncated capture `recover` reads the part
  /// before.
  static Result<PcapReader> open(const std::filesystem::path& file, BagOpenOptions options = {});
  PcapReader(PcapReader&&) noexcept;
  PcapReader& operator=(PcapReader&&) noexcept;
  ~PcapReader() override;

  std::string name() const override;
  void rewind() override;

 private:
  struct Impl;
  explicit PcapReader(std::unique_ptr<Impl> impl);
  /// The offset is that of the frame which completes the message.
  Result<std::optional<Made>> make() override;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
