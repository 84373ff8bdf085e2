// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/measurements.hpp"
#include "recordings/bag/bag_writer.hpp"
#include "recordings/messages/message_bytes.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_type.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims::test {

/// When the recordings here begin.
inline constexpr Time kStart = 100 * kSecond;
/// LiDAR and base at the IMU's place.
inline const std::vector<FrameTransform> kMounted = {{"imu", "lidar", {}}, {"imu", "base", {}}};

/// A sensor_msgs/PointCloud2 as it is on the wire, whether or not it holds together.
struct RawCloud {
  struct Field {
    std::string name;
    std::uint32_t offset = 0;
    std::uint8_t type = 7;  ///< sensor_msgs/PointField; 7: float32
    std::uint32_t count = 1;
  };
  Time stamp = 0;
  std::string frame = "lidar";
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<Field> fields;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::vector<std::byte> data;

  /// One row of x, y, z, time as float32; 16 bytes a point.
  static RawCloud of(Time stamp, const std::vector<std::array<float, 4>>& points);
  MessageBytes bytes() const;
};

/// Writes a bag message by message: an IMU at rest, clouds, and whatever a test adds.
class RobotRecording {
 public:
  explicit RobotRecording(const std::filesystem::path& file);

  void add(const std::string& topic, const MessageType& type, Time record_time,
           const MessageBytes& message);
  /// An IMU at rest from `begin` on, 50 Hz, in frame "imu".
  void add_imu(Time begin, int samples, double force = 9.81, const std::string& topic = "/imu");
  void add_cloud(const RawCloud& cloud, Time record_time, const std::string& topic = "/points");
  /// Clouds of eight points at 10 Hz, timed over 90 ms, recorded when they end.
  void add_clouds(Time begin, int count);
  void add_transforms(const std::vector<FrameTransform>& transforms,
                      const std::string& topic = "/tf_static");
  void close();

 private:
  BagWriter bag_;
  std::map<std::string, std::uint32_t> connections_;
};

/// A test with a place for its bag.
class RecordingTest : public ::testing::Test {
 public:
  /// Whether the text of a warning holds `part`.
  static bool warns(const RecordingSetup& setup, const std::string& part);

 protected:
  std::filesystem::path bag() const { return folder_.path() / "robot.bag"; }
  TemporaryFolder folder_;
};

/// What reading a bag gives.
struct Recording {
  std::string error;  ///< empty: none
  RecordingSetup setup;
  std::vector<Delivery> deliveries;
  std::map<std::string, int> counts;
  Trajectory truth;

  bool noted(const std::string& part) const;
};
Recording read_recording(const std::filesystem::path& file, const RecordingConfig& config = {});

}  // namespace aims::test
