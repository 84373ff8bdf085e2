// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "recordings/bag/chunk_reader.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// Reads a capture of a LiDAR's packets (.pcap) as messages: scans as sensor_msgs/PointCloud2; of
/// an Ouster also its IMU as sensor_msgs/Imu and its frames on /tf_static. NAME.json beside
/// NAME.pcap is the metadata of an Ouster; without it the packets are those of a Velodyne VLP-16.
/// The incomplete scans at both ends are left out.
class PcapReader final : public MessageSource {
 public:
  /// Error for a capture without such packets. Of a truncated capture `recover` reads the part
  /// before.
  static Result<PcapReader> open(const std::filesystem::path& file, BagOpenOptions options = {});
  PcapReader(PcapReader&&) noexcept;
  PcapReader& operator=(PcapReader&&) noexcept;
  ~PcapReader() override;

  std::string name() const override;
  const std::vector<BagConnection>& connections() const override;
  /// A chunk is the capture.
  const BagSummary& summary() const override;
  void select(std::span<const std::string> topics) override;
  /// The offset of a message is that of the frame which completes it.
  Result<std::optional<BagMessage>> next() override;
  void rewind() override;

 private:
  struct Impl;
  explicit PcapReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
