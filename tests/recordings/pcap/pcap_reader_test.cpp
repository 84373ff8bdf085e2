// SPDX-License-Identifier: BSD-3-Clause
// Packets with one answer each; tests/formats/pcap_test.py has entire captures of a room.
#include "recordings/pcap/pcap_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "recordings/pcap/ouster_packets.hpp"
#include "recordings/pcap/velodyne_packets.hpp"
#include "tests/recordings/pcap/room_packets.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Bytes that are put one after the other, little endian.
struct Packet {
  std::vector<std::byte> bytes = {};

  template <class Value>
  Packet& put(Value value) {
    const auto* from = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), from, from + sizeof(value));
    return *this;
  }
  Packet& zeros(std::size_t count) {
    bytes.resize(bytes.size() + count);
    return *this;
  }
  std::string text() const { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }
};

/// A VLP-16's packet whose blocks begin at these azimuths [0.01 deg]; only laser 1, at +1 degree,
/// has returns, at 10 m, in both sequences of each block.
Packet velodyne_packet(const std::vector<int>& azimuths, std::uint32_t microseconds,
                       std::uint8_t model = 0x22) {
  Packet packet;
  for (const int azimuth : azimuths) {
    packet.put<std::uint16_t>(0xeeff).put(static_cast<std::uint16_t>(azimuth));
    for (int firing = 0; firing < 32; ++firing) {
      packet.put<std::uint16_t>(firing % 16 == 1 ? 5000 : 0).put<std::uint8_t>(51);
    }
  }
  return packet.put(microseconds).put<std::uint8_t>(0x37).put(model);
}

std::vector<int> blocks_from(int first, int step) {
  std::vector<int> azimuths;
  for (int i = 0; i < 12; ++i) azimuths.push_back((first + i * step) % 36000);
  return azimuths;
}

TEST(VelodyneScans, TurnsTheHeadBetweenBlocksAndAfterTheLast) {
  VelodyneScans scans;
  // The first packet passes zero at its start; the last but one reaches 340 degrees.
  constexpr int kStep = 300;
  ASSERT_TRUE(scans.add(velodyne_packet(blocks_from(35900, 50), 0).bytes, 0));
  for (int packet = 0; packet < 9; ++packet) {
    const auto time = static_cast<std::uint32_t>(1'328 * (packet + 1));
    ASSERT_TRUE(
        scans.add(velodyne_packet(blocks_from(600 + packet * 12 * kStep, kStep), time).bytes, 0));
  }
  const auto added = scans.add(velodyne_packet(blocks_from(100, kStep), 13'280).bytes, 0);
  ASSERT_TRUE(added && *added);
  const LidarScan& scan = **added;
  ASSERT_EQ(scan.points.size(), 2U * (10 + 9 * 12));
  int checked = 0;
  for (std::size_t i = 2 * 10; i < scan.points.size(); ++i) {
    const LidarPoint& point = scan.points[i];
    const std::size_t block = (i - 20) / 2;
    // The manual's example: firing n of a block is 55.296 us * (n / 16) + 2.304 us * (n % 16) after
    // it.
    const double after = (i % 2 == 0 ? 0.0 : 55.296) + 2.304;
    const double azimuth = 0.01 * (600.0 + kStep * double(block) + kStep * after / 110.592);
    const double found = std::atan2(-point.position.y(), point.position.x()) / kDegree;
    EXPECT_NEAR(std::remainder(found - azimuth, 360.0), 0.0, 1e-3) << "block " << block;
    const double across = std::hypot(point.position.x(), point.position.y());
    EXPECT_NEAR(across, 10.0 * std::cos(kDegree), 1e-5);
    EXPECT_NEAR(point.position.z(), 10.0 * std::sin(kDegree) - 0.0007, 1e-5);
    EXPECT_EQ(point.ring, 8);
    EXPECT_NEAR(point.intensity, 0.2, 1e-6);
    const double time =
        1e3 * (1'328.0 * double(1 + block / 12) + 110.592 * double(block % 12) + after);
    EXPECT_NEAR(double(scan.stamp) + point.time_offset_ns, time, 1.0);
    ++checked;
  }
  EXPECT_EQ(checked, 216);
}

TEST(VelodyneScans, RefusesOtherModels) {
  VelodyneScans scans;
  const auto added = scans.add(velodyne_packet(blocks_from(0, 20), 0, 0xa1).bytes, 0);
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().message,
            "packets of a VLS-128 (0xa1); read are those of one VLP-16, Puck Hi-Res, HDL-32E or "
            "VLP-32C");
  ASSERT_TRUE(scans.add(velodyne_packet(blocks_from(0, 20), 0).bytes, 0));
  const auto other = scans.add(velodyne_packet(blocks_from(0, 20), 0, 0x28).bytes, 0);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().message, "packets of a VLP-32C; read are those of one VLP-16");
}

OusterMetadata ouster(const std::string& profile) {
  OusterMetadata metadata;
  metadata.profile = profile;
  metadata.altitude_deg = {10.0, -10.0};
  metadata.azimuth_deg = {3.0, -3.0};
  metadata.columns_per_frame = 360;
  metadata.columns_per_packet = 1;
  return metadata;
}

/// What one beam returns; the second return is that of the profile of two.
struct Return {
  std::uint32_t range_mm = 0;
  std::uint8_t reflectivity = 0;
  std::uint16_t signal = 0;
};

/// A packet of two returns a beam, of one column, the same for all beams.
Packet dual_packet(std::uint16_t frame, std::uint16_t column, const Return& first,
                   const Return& second) {
  Packet packet;
  packet.put<std::uint16_t>(1).put(frame).zeros(28);
  packet.put(std::uint64_t{1'000'000} * column).put(column).put<std::uint16_t>(1);
  for (int beam = 0; beam < 2; ++beam) {
    for (const Return& each : {first, second}) {
      // The upper bits are flags.
      packet.put(each.range_mm | std::uint32_t{each.reflectivity} << 24 | 0xf80000U);
    }
    packet.put(first.signal).put(second.signal).put<std::uint16_t>(7).zeros(2);
  }
  return packet.zeros(32);
}

TEST(VelodyneScans, CompleteRevolutionsAtBothEndsAreScans) {
  VelodyneScans scans;
  for (int packet = 0; packet < 10; ++packet) {
    const auto added = scans.add(velodyne_packet(blocks_from(packet * 12 * 300, 300),
                                                 static_cast<std::uint32_t>(1'328 * packet))
                                     .bytes,
                                 0);
    ASSERT_TRUE(added && !*added);
  }
  const auto whole = scans.finish();
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->points.size(), 2U * 120);
  ASSERT_TRUE(scans.add(velodyne_packet(blocks_from(0, 300), 13'280).bytes, 0));
  EXPECT_FALSE(scans.finish()) << "a tenth of a revolution";
}

TEST(OusterScans, OneFrameWithAllItsColumnsIsAScan) {
  OusterMetadata metadata = ouster("RNG19_RFL8_SIG16_NIR16_DUAL");
  metadata.columns_per_frame = metadata.window_columns = 8;
  const Return hit{4000, 51, 100};
  for (const int columns : {7, 8}) {
    OusterScans scans(metadata);
    for (int i = 0; i < columns; ++i) {
      EXPECT_FALSE(scans.add(dual_packet(5, static_cast<std::uint16_t>(i), hit, hit).bytes));
    }
    EXPECT_EQ(scans.finish(true).has_value(), columns == 8);
  }
}

TEST(OusterScans, TakesTheStrongerOfTwoReturns) {
  OusterScans scans(ouster("RNG19_RFL8_SIG16_NIR16_DUAL"));
  const Return near{4000, 51, 100}, far{9000, 102, 300}, none{0, 0, 0};
  struct Case {
    Return first, second;
    double range;
    double intensity;
  };
  const std::vector<Case> cases = {{near, far, 9.0, 0.4},
                                   {far, near, 9.0, 0.4},
                                   {near, none, 4.0, 0.2},
                                   {{4000, 51, 300}, far, 4.0, 0.2},
                                   {none, {5000, 51, 1}, 5.0, 0.2}};
  const Packet before = dual_packet(0, 0, near, far);
  ASSERT_EQ(before.bytes.size(), scans.lidar_packet_size());
  scans.add(before.bytes);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    scans.add(dual_packet(1, static_cast<std::uint16_t>(i), cases[i].first, cases[i].second).bytes);
  }
  const auto scan = scans.add(dual_packet(2, 0, none, none).bytes);
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->points.size(), 2 * cases.size());
  for (std::size_t i = 0; i < scan->points.size(); ++i) {
    const LidarPoint& point = scan->points[i];
    const Case& expected = cases[i / 2];
    EXPECT_NEAR(point.position.norm(), expected.range, 1e-5) << i;
    EXPECT_NEAR(point.intensity, expected.intensity, 1e-6) << i;
    // The encoder runs against the axes; a beam's azimuth counts likewise.
    const double azimuth = -double(i / 2) - (i % 2 == 0 ? 3.0 : -3.0);
    EXPECT_NEAR(std::remainder(
                    std::atan2(point.position.y(), point.position.x()) / kDegree - azimuth, 360.0),
                0.0, 1e-4);
    EXPECT_NEAR(std::asin(point.position.z() / expected.range) / kDegree, i % 2 == 0 ? 10.0 : -10.0,
                1e-4);
    EXPECT_EQ(point.time_offset_ns, 1'000'000 * static_cast<int>(i / 2));
  }
}

std::string at_byte(std::size_t position) { return "at byte " + std::to_string(position) + ": "; }

class Capture : public testing::Test {
 protected:
  std::string refusal(const std::string& bytes, BagOpenOptions options = {}) {
    EXPECT_TRUE(write_file_atomically(folder_.path() / "c.pcap", bytes));
    const auto reader = PcapReader::open(folder_.path() / "c.pcap", options);
    if (reader) return "accepted";
    const std::string start = (folder_.path() / "").string();
    EXPECT_TRUE(reader.error().message.starts_with(start)) << reader.error().message;
    return reader.error().message.substr(std::min(start.size(), reader.error().message.size()));
  }

  static std::string header(std::uint32_t magic = 0xa1b2c3d4, std::uint32_t link = 101) {
    return Packet().put(magic).zeros(16).put(link).text();
  }

  /// The file with these frames behind a header.
  Result<PcapReader> read(const std::string& frames) {
    EXPECT_TRUE(write_file_atomically(folder_.path() / "c.pcap", header() + frames));
    return PcapReader::open(folder_.path() / "c.pcap");
  }

  /// A frame as below, of 10.0.0.`host` to this port.
  static std::string sent_frame(const Packet& payload, std::uint8_t host, std::uint8_t port) {
    std::string all = frame(payload);
    constexpr std::size_t kIp = 16;
    all[kIp + 12] = 10;
    all[kIp + 15] = static_cast<char>(host);
    all[kIp + 23] = static_cast<char>(port);
    return all;
  }

  /// A frame with an IPv4 packet of UDP; `missing` bytes at its end are not there.
  static std::string frame(const Packet& payload, std::size_t missing = 0) {
    const auto big = [](std::size_t value) {
      return static_cast<std::uint16_t>((value & 0xff) << 8 | value >> 8);
    };
    Packet ip;
    ip.put<std::uint8_t>(0x45).put<std::uint8_t>(0).put(big(28 + payload.bytes.size())).zeros(5);
    ip.put<std::uint8_t>(17).zeros(10).zeros(4).put(big(8 + payload.bytes.size())).zeros(2);
    const auto size = static_cast<std::uint32_t>(ip.bytes.size() + payload.bytes.size());
    const std::string all =
        Packet().zeros(8).put(size).put(size).text() + ip.text() + payload.text();
    return all.substr(0, all.size() - missing);
  }

  TemporaryFolder folder_;
};

TEST_F(Capture, RefusesWhatIsMalformed) {
  const std::string packet = frame(velodyne_packet(blocks_from(0, 20), 0));
  EXPECT_EQ(refusal(""), "c.pcap: at byte 0: expected a capture (.pcap)");
  EXPECT_EQ(refusal(header().substr(0, 23)), "c.pcap: at byte 0: expected a capture (.pcap)");
  EXPECT_EQ(refusal(header(0x12345678)), "c.pcap: at byte 0: expected a capture (.pcap)");
  EXPECT_NE(refusal(header(0x0a0d0d0a)).find("found pcapng"), std::string::npos);
  EXPECT_NE(refusal(header(0xa1b2c3d4, 105)).find("at byte 20: expected frames of Ethernet"),
            std::string::npos);
  EXPECT_NE(refusal(header() + packet.substr(0, 10)).find("at byte 24: expected 16 bytes"),
            std::string::npos);
  EXPECT_NE(refusal(header() + packet + frame(velodyne_packet(blocks_from(0, 20), 0), 1))
                .find(at_byte(24 + packet.size() + 16)),
            std::string::npos);
  EXPECT_NE(refusal(header() + Packet().zeros(8).put(std::uint32_t{1} << 19).zeros(4).text())
                .find("at byte 24: expected a frame of at most 262144 bytes, found 524288"),
            std::string::npos);
  EXPECT_NE(refusal(header() + packet + frame(velodyne_packet(blocks_from(0, 20), 0, 0x28)))
                .find(at_byte(24 + packet.size()) + "packets of a VLP-32C"),
            std::string::npos);
  EXPECT_NE(refusal(header() + packet).find("expected complete scans of a Velodyne VLP-16"),
            std::string::npos);
}

TEST_F(Capture, OfOtherLidarsNamesThem) {
  const auto of = [](std::initializer_list<int> first, std::size_t size) {
    Packet packet;
    for (const int byte : first) packet.put(static_cast<std::uint8_t>(byte));
    packet.zeros(size - first.size());
    return packet;
  };
  const std::pair<Packet, std::string> packets[] = {
      {of({0xff, 0xee}, 1262), "; packets of a Hesai Pandar40P;"},
      {of({0xee, 0xff, 64, 6}, 1194), "packets of a Hesai Pandar64 with 1194 bytes"},
      {of({0xee, 0xff, 1, 4, 0, 0, 128, 2}, 861), "packets of a Hesai Pandar128"},
      {of({0xee, 0xff, 3, 2, 0, 0, 128, 2}, 1127), "packets of a Hesai QT128"},
      {of({0x55, 0xaa, 0x5a, 0xa5}, 1210), "; packets of a RoboSense M1, M2 or E1;"},
      {of({0, 0x64, 0x05}, 1380), "; packets of a Livox HAP or Mid-360;"},
      {of({1}, 12608), "; packets of an Ouster;"}};
  for (const auto& [packet, expected] : packets) {
    const std::string message = refusal(header() + frame(packet));
    EXPECT_NE(message.find(expected), std::string::npos) << expected << '\n' << message;
  }
}

TEST_F(Capture, OfTwoLidarsIsRefusedWithTheFilter) {
  const auto packets = test::vlp16_packets(1'700'000'123 * kSecond, 2);
  const auto of = [&](std::uint8_t host, std::uint8_t port, int changed) {
    std::string frames;
    for (const auto& each : packets) {
      Packet other{each.payload};
      other.bytes[10] ^= static_cast<std::byte>(changed);  // a reflectivity or range
      frames += sent_frame({each.payload}, 1, 8) + sent_frame(other, host, port);
    }
    const auto reader = read(frames);
    return reader ? "" : reader.error().message;
  };
  EXPECT_NE(of(2, 8, 1).find("found those of 10.0.0.1 to port 8 and of 10.0.0.2 to port 8: "
                             "`tcpdump -r IN -w OUT 'src host 10.0.0.1'`"),
            std::string::npos)
      << of(2, 8, 1);
  EXPECT_NE(of(1, 9, 1).find("'udp dst port 8'"), std::string::npos) << of(1, 9, 1);
  EXPECT_EQ(of(2, 9, 0), "") << "a relay of the same packets";
}

TEST_F(Capture, PacketsInSwappedOrderMakeNoOtherScans) {
  for (std::size_t offset : {0U, 1U}) {
    auto packets = test::vlp16_packets(1'700'000'123 * kSecond, 3);
    for (std::size_t i = offset; i + 1 < packets.size(); i += 2) {
      std::swap(packets[i], packets[i + 1]);
    }
    std::string frames;
    for (const auto& each : packets) frames += frame({each.payload});
    const auto reader = read(frames);
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_LE(reader->connections()[0].messages, 3U) << offset;
    EXPECT_GE(reader->connections()[0].messages, 2U) << offset;
  }
}

TEST_F(Capture, PacketsThatAreMissingAreCounted) {
  const auto packets = test::vlp16_packets(1'700'000'123 * kSecond, 3);
  const auto lost = [&](std::size_t every) {
    std::string frames;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      if (every == 0 || i % every != 7) frames += frame({packets[i].payload});
    }
    const auto reader = read(frames);
    EXPECT_TRUE(reader) << reader.error().message;
    return reader ? reader->summary().lost_packets : -1.0;
  };
  EXPECT_EQ(lost(0), 0.0);
  EXPECT_NEAR(lost(20), 0.05, 0.005);
}

TEST_F(Capture, OtherDatagramsOfItsSizeAreNoPackets) {
  std::string frames;
  for (const auto& each : test::vlp16_packets(1'700'000'123 * kSecond, 2)) {
    frames += frame({each.payload}) + sent_frame(Packet().zeros(1206), 2, 9);
  }
  const auto reader = read(frames);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->connections()[0].messages, 2U);
}

TEST_F(Capture, WhatItCutIsNamed) {
  std::string cut = frame(velodyne_packet(blocks_from(0, 20), 0), 1034);
  cut[8] = static_cast<char>(200);  // kept of 1234 bytes
  cut[9] = 0;
  EXPECT_NE(
      refusal(header() + cut + cut).find("2 packets that the capture cut, to 200 of 1234 bytes"),
      std::string::npos)
      << refusal(header() + cut);
}

TEST_F(Capture, OfAnOusterWithPacketsTwiceHasEachPointOnce) {
  ASSERT_TRUE(write_file_atomically(folder_.path() / "c.json", test::ouster_metadata_text()));
  std::string once, twice;
  for (const auto& each : test::ouster_lidar_packets(1'700'000'123 * kSecond, 0, 2)) {
    once += frame({each.payload});
    twice += frame({each.payload}) + frame({each.payload});
  }
  const auto size_of = [&](const std::string& frames) {
    auto reader = read(frames);
    EXPECT_TRUE(reader);
    std::size_t size = 0;
    while (true) {
      const auto message = reader->next();
      if (!message || !*message) return size;
      size += (*message)->data.size();
    }
  };
  EXPECT_EQ(size_of(twice), size_of(once));
}

TEST(OusterScans, ColumnsThatComeAgainAreLeftOut) {
  OusterMetadata metadata = ouster("RNG19_RFL8_SIG16_NIR16_DUAL");
  metadata.columns_per_frame = metadata.window_columns = 8;
  OusterScans scans(metadata);
  const Return hit{4000, 51, 100};
  const auto add = [&](int frame, int column) {
    const auto packet = dual_packet(static_cast<std::uint16_t>(frame),
                                    static_cast<std::uint16_t>(column), hit, hit);
    return scans.add(packet.bytes).has_value();
  };
  for (int i = 0; i < 7; ++i) EXPECT_FALSE(add(5, i) || add(5, i));
  EXPECT_FALSE(add(5, 2)) << "later, again";
  EXPECT_EQ(scans.finish(true), std::nullopt);
  EXPECT_EQ(scans.most_columns(), 7);
  EXPECT_FALSE(scans.column_beyond());
  EXPECT_FALSE(add(6, 9));
  EXPECT_EQ(scans.column_beyond(), 9);
}

TEST(OusterScans, APacketAfterItsFrameEndsNone) {
  OusterMetadata metadata = ouster("RNG19_RFL8_SIG16_NIR16_DUAL");
  metadata.columns_per_frame = metadata.window_columns = 8;
  OusterScans scans(metadata);
  const Return hit{4000, 51, 100};
  std::size_t ended = 0;
  // Column 7 of each frame comes after column 0 of the next.
  for (const auto& [frame, column] : std::vector<std::pair<int, int>>{
           {1, 0}, {1, 3}, {2, 0}, {1, 7}, {2, 3}, {3, 0}, {2, 7}, {3, 3}, {4, 0}, {3, 7}}) {
    const auto scan = scans.add(
        dual_packet(static_cast<std::uint16_t>(frame), static_cast<std::uint16_t>(column), hit, hit)
            .bytes);
    if (!scan) continue;
    ++ended;
    EXPECT_EQ(scan->points.size(), 4U) << "two columns of two beams";
  }
  EXPECT_EQ(ended, 2U);
}

TEST_F(Capture, OfAHesaiHasItsScans) {
  std::string bytes = header();
  for (const auto& each : test::xt_packets(1'700'000'123 * kSecond, 2)) {
    bytes += frame(Packet{each.payload});
  }
  ASSERT_TRUE(write_file_atomically(folder_.path() / "c.pcap", bytes));
  const auto reader = PcapReader::open(folder_.path() / "c.pcap");
  ASSERT_TRUE(reader) << reader.error().message;
  ASSERT_EQ(reader->connections().size(), 1U);
  EXPECT_EQ(reader->connections()[0].topic, "/lidar/points");
  EXPECT_EQ(reader->connections()[0].messages, 2U);
}

TEST_F(Capture, OfARobosenseHasItsScans) {
  const test::Rs16 sensor = {.tilt = 0.5};
  std::string bytes = header() + frame(Packet{test::rs16_information(kSecond, sensor).payload});
  for (const auto& each : test::rs16_packets(1'700'000'123 * kSecond, 2, sensor)) {
    bytes += frame(Packet{each.payload});
  }
  ASSERT_TRUE(write_file_atomically(folder_.path() / "c.pcap", bytes));
  const auto reader = PcapReader::open(folder_.path() / "c.pcap");
  ASSERT_TRUE(reader) << reader.error().message;
  ASSERT_EQ(reader->connections().size(), 1U);
  EXPECT_EQ(reader->connections()[0].messages, 2U);
}

TEST_F(Capture, NamesTheProfileThatIsNotRead) {
  ASSERT_TRUE(write_file_atomically(folder_.path() / "c.json",
                                    R"({"udp_profile_lidar": "FUSA_RNG15_RFL8_NIR8_DUAL"})"));
  EXPECT_EQ(refusal(header()),
            "c.json: udp_profile_lidar: expected LEGACY, RNG19_RFL8_SIG16_NIR16, "
            "RNG19_RFL8_SIG16_NIR16_DUAL or RNG15_RFL8_NIR8, found 'FUSA_RNG15_RFL8_NIR8_DUAL'");
}

}  // namespace
}  // namespace aims
