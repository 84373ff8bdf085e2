// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/measurements.hpp"

namespace aims {

/// What the metadata of an Ouster sensor states (a JSON file, as the sensor gives it).
struct OusterMetadata {
  std::string profile;               ///< of the packets, e.g. "LEGACY"
  std::vector<double> altitude_deg;  ///< of the beams, from the highest on
  std::vector<double> azimuth_deg;
  double origin_to_beam = 0.0;  ///< from the axis to the beams' origin [m]
  int columns_per_frame = 1024;
  int window_columns = 1024;  ///< that are measured of a frame (column_window)
  int columns_per_packet = 16;
  Pose T_sensor_lidar;
  Pose T_sensor_imu;
};

/// Reads such a file. Error, naming file and key, for what is missing, and for a profile of packets
/// other than LEGACY, RNG19_RFL8_SIG16_NIR16 (also _DUAL) and RNG15_RFL8_NIR8.
Result<OusterMetadata> read_ouster_metadata(const std::filesystem::path& file);

/// The same of the text of such a file; `name` is its name in errors.
Result<OusterMetadata> parse_ouster_metadata(const std::string& text, const std::string& name);

/// Puts the scans of an Ouster sensor together from its packets (Ouster sensor documentation, data
/// packet format): a scan ends where the frame number changes. Each point has the time of its
/// column, in the sensor's clock. Of two returns the one with the larger signal is used. LiDAR axes
/// as there.
class OusterScans {
 public:
  explicit OusterScans(OusterMetadata metadata);

  std::size_t lidar_packet_size() const;
  static constexpr std::size_t kImuPacketSize = 48;

  /// Adds a packet of the LiDAR; returns the scan that it ends. The first frame is left out where
  /// it is incomplete. Columns that come twice, or after their frame, are left out.
  std::optional<LidarScan> add(std::span<const std::byte> packet);

  /// The scan in progress; of the first and the last frame only if it is complete.
  std::optional<LidarScan> finish(bool at_end = false);

  /// Columns of the frame that has most.
  std::ptrdiff_t most_columns() const { return most_columns_; }

  /// A column that the metadata do not have.
  std::optional<int> column_beyond() const { return beyond_; }

  /// The sample in a packet of the IMU: specific force [m/s^2], angular velocity [rad/s].
  static ImuSample imu_of(std::span<const std::byte> packet);

 private:
  struct Layout;
  const Layout& layout() const;
  const std::byte* stronger_return(const std::byte* pixel) const;
  void add_column(const std::byte* column);

  OusterMetadata metadata_;
  LidarScan scan_;
  std::vector<bool> received_;                   ///< columns of the frame
  std::optional<std::uint16_t> frame_, before_;  ///< that is read, and the one before
  std::ptrdiff_t most_columns_ = 0;
  std::optional<int> beyond_;
  int frames_ = 0;  ///< that have begun
};

}  // namespace aims
