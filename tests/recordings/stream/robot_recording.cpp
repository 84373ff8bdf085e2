// SPDX-License-Identifier: BSD-3-Clause
#include "tests/recordings/stream/robot_recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "recordings/messages/message_types.hpp"
#include "tests/recordings/stream/recorded_deliveries.hpp"

namespace aims::test {
namespace {

constexpr Duration kPeriod = 100 * kMillisecond;

BagWriter open_bag(const std::filesystem::path& file) {
  auto bag = BagWriter::create(file);
  EXPECT_TRUE(bag) << bag.error().message;
  return std::move(*bag);
}

}  // namespace

RawCloud RawCloud::of(Time stamp, const std::vector<std::array<float, 4>>& points) {
  RawCloud cloud;
  cloud.stamp = stamp;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.fields = {{"x", 0}, {"y", 4}, {"z", 8}, {"time", 12}};
  cloud.point_step = 16;
  cloud.row_step = 16 * cloud.width;
  cloud.data.resize(cloud.row_step);
  if (!points.empty()) std::memcpy(cloud.data.data(), points.data(), cloud.data.size());
  return cloud;
}

MessageBytes RawCloud::bytes() const {
  MessageBytes out;
  out.put(std::uint32_t{0});
  out.time(stamp);
  out.text(frame);
  out.put(height);
  out.put(width);
  out.length(fields.size());
  for (const Field& field : fields) {
    out.text(field.name);
    out.put(field.offset);
    out.put(field.type);
    out.put(field.count);
  }
  out.put(false);
  out.put(point_step);
  out.put(row_step);
  out.array(data);
  out.put(true);
  return out;
}

RobotRecording::RobotRecording(const std::filesystem::path& file) : bag_(open_bag(file)) {}

void RobotRecording::add(const std::string& topic, const MessageType& type, Time record_time,
                         const MessageBytes& message) {
  auto found = connections_.find(topic);
  if (found == connections_.end()) {
    found = connections_.emplace(topic, bag_.add_connection(topic, type)).first;
  }
  const auto ok = bag_.write(found->second, record_time, message.view());
  EXPECT_TRUE(ok) << ok.error().message;
}

void RobotRecording::add_imu(Time begin, int samples, double force, const std::string& topic) {
  for (int k = 0; k < samples; ++k) {
    ImuSample sample;
    sample.stamp = begin + k * 20 * kMillisecond;
    sample.specific_force.z() = force;
    add(topic, imu_type(), sample.stamp + kMillisecond,
        imu_message({0, sample.stamp, "imu"}, sample));
  }
}

void RobotRecording::add_cloud(const RawCloud& cloud, Time record_time, const std::string& topic) {
  add(topic, point_cloud_type(), record_time, cloud.bytes());
}

void RobotRecording::add_clouds(Time begin, int count) {
  for (int k = 0; k < count; ++k) {
    std::vector<std::array<float, 4>> points;
    for (int i = 0; i < 8; ++i) {
      const auto turn = static_cast<float>(i);
      points.push_back({4.0F - turn, 2.0F, 0.1F * turn, 0.09F / 7.0F * turn});
    }
    const Time stamp = begin + k * kPeriod;
    add_cloud(RawCloud::of(stamp, points), stamp + kPeriod);
  }
}

void RobotRecording::add_transforms(const std::vector<FrameTransform>& transforms,
                                    const std::string& topic) {
  add(topic, transforms_type(), kSecond, transforms_message(kSecond, transforms));
}

void RobotRecording::close() {
  const auto ok = bag_.close();
  EXPECT_TRUE(ok) << ok.error().message;
}

bool RecordingTest::warns(const RecordingSetup& setup, const std::string& part) {
  return std::ranges::any_of(setup.warnings, [&](const ReadingWarning& each) {
    return each.text.find(part) != std::string::npos;
  });
}

bool Recording::noted(const std::string& part) const {
  return std::any_of(
             setup.notes.begin(), setup.notes.end(),
             [&](const std::string& note) { return note.find(part) != std::string::npos; }) ||
         RecordingTest::warns(setup, part);
}

Recording read_recording(const std::filesystem::path& file, const RecordingConfig& config) {
  Recording recording;
  auto reader = RecordingReader::open(file, config);
  if (!reader) {
    recording.error = reader.error().message;
    return recording;
  }
  auto read = read_all(*reader);
  if (!read) {
    recording.error = read.error().message;
    return recording;
  }
  recording.deliveries = std::move(*read);
  recording.setup = reader->setup();
  recording.counts = reader->counts();
  recording.truth = reader->truth();
  return recording;
}

}  // namespace aims::test
