// SPDX-License-Identifier: BSD-3-Clause
#include "tests/recordings/pcap/room_packets.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace aims::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr Duration kTurn = kSecond / 10;
constexpr std::array<double, 16> kVlp16 = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                           -7,  9, -5,  11, -3,  13, -1, 15};
constexpr std::array<double, 16> kVlp16HeightMm = {11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                                   5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};

double range_in_room(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double range = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) < 1e-9) continue;
    const double wall = std::copysign(kRoom[axis], direction[axis]);
    range = std::min(range, (wall - origin[axis]) / direction[axis]);
  }
  return range;
}

/// Little-endian bytes, one after the other.
struct Bytes {
  std::vector<std::byte> all;

  template <class Value>
  Bytes& put(Value value) {
    const auto* from = reinterpret_cast<const std::byte*>(&value);
    all.insert(all.end(), from, from + sizeof(value));
    return *this;
  }
  Bytes& zeros(std::size_t count) {
    all.resize(all.size() + count);
    return *this;
  }
};

void put_vlp16_return(Bytes& out, int laser, double azimuth) {
  const double elevation = kVlp16[static_cast<std::size_t>(laser)] * kDegree;
  const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                  -std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  const double height = 1e-3 * kVlp16HeightMm[static_cast<std::size_t>(laser)];
  const double range = range_in_room({0.0, 0.0, height}, direction);
  out.put(static_cast<std::uint16_t>(std::lround(range / 0.002)));
  out.put(static_cast<std::uint8_t>(100 + laser));
}

/// Date and time of day to the second, as a Hesai counts them.
void put_utc(Bytes& out, Time time) {
  using namespace std::chrono;
  const sys_seconds at{seconds(time / kSecond)};
  const auto day = floor<days>(at);
  const year_month_day date(day);
  const hh_mm_ss clock(at - day);
  for (const auto value :
       {static_cast<int>(date.year()) - 1900, static_cast<int>(static_cast<unsigned>(date.month())),
        static_cast<int>(static_cast<unsigned>(date.day())),
        static_cast<int>(clock.hours().count()), static_cast<int>(clock.minutes().count()),
        static_cast<int>(clock.seconds().count())}) {
    out.put(static_cast<std::uint8_t>(value));
  }
  out.put(static_cast<std::uint32_t>(time % kSecond / 1000));
}

void put_big(Bytes& out, int value) {
  out.put(static_cast<std::uint8_t>(value >> 8)).put(static_cast<std::uint8_t>(value));
}

/// The date as an RS-LiDAR-16 counts it, from 2000 on.
void put_rs16_date(Bytes& out, Time time) {
  Bytes date;
  put_utc(date, time);
  date.all.resize(6);
  date.all[0] = static_cast<std::byte>(std::to_integer<int>(date.all[0]) - 100);
  out.all.insert(out.all.end(), date.all.begin(), date.all.end());
  const auto microseconds = static_cast<int>(time % kSecond / 1000);
  put_big(out, microseconds / 1000);
  put_big(out, microseconds % 1000);
}

/// Channels 1 to 8 from the lowest to the middle, 9 to 16 from the highest [deg].
double rs16_elevation(int channel) {
  return channel < 8 ? -15.0 + 2.0 * channel : 15.0 - 2.0 * (channel - 8);
}

void put_rs16_return(Bytes& out, int channel, double azimuth, const Rs16& sensor) {
  const double up = (rs16_elevation(channel % 16) + sensor.tilt) * kDegree;
  const Eigen::Vector3d across(std::cos(azimuth), -std::sin(azimuth), 0.0);
  const Eigen::Vector3d direction = std::cos(up) * across + std::sin(up) * Eigen::Vector3d::UnitZ();
  const double range = range_in_room(0.03825 * across, direction);
  const bool in_front = sensor.dual && channel < 16;  // a return of something thin
  put_big(out, static_cast<int>(std::lround((in_front ? 0.5 : 1.0) * range / 0.005)));
  out.put(static_cast<std::uint8_t>(in_front ? 20 : 100 + channel));
}

constexpr std::size_t kBeams = 16, kColumns = 512;

double beam_altitude(std::size_t beam) { return 20.0 - 40.0 * static_cast<double>(beam) / 15.0; }
double beam_azimuth(std::size_t beam) { return beam % 2 == 0 ? 2.1 : -2.1; }

void put_ouster_column(Bytes& out, Time stamp, std::size_t column, int frame) {
  constexpr double kOrigin = 0.015806;
  const double encoder = 2.0 * std::numbers::pi * (1.0 - static_cast<double>(column) / kColumns);
  out.put(static_cast<std::uint64_t>(stamp)).put(static_cast<std::uint16_t>(column));
  out.put(static_cast<std::uint16_t>(frame)).put(std::uint32_t{0});
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    const double azimuth = encoder - beam_azimuth(beam) * kDegree;
    const double up = beam_altitude(beam) * kDegree;
    const Eigen::Vector3d origin =
        kOrigin * Eigen::Vector3d(std::cos(encoder), std::sin(encoder), 0.0);
    const Eigen::Vector3d direction(std::cos(up) * std::cos(azimuth),
                                    std::cos(up) * std::sin(azimuth), std::sin(up));
    const double range = range_in_room(origin, direction) + kOrigin;
    out.put(static_cast<std::uint32_t>(std::lround(1000.0 * range)));
    out.put(std::uint16_t{77}).put(std::uint16_t{500}).put(std::uint16_t{3}).put(std::uint16_t{0});
  }
  out.put(std::uint32_t{0xffffffff});
}

}  // namespace

std::vector<RoomPacket> vlp16_packets(Time start, int turns) {
  constexpr double kBlock = 2 * 55'296.0;  // [ns]
  std::vector<RoomPacket> packets;
  for (int first = 0; first * kBlock < turns * static_cast<double>(kTurn); first += 12) {
    // The sensor's clock has whole microseconds.
    const Time time = start + static_cast<Time>(first * kBlock) / 1000 * 1000;
    Bytes out;
    for (int i = 0; i < 12; ++i) {
      const double begin = 36000.0 * (first + i) * kBlock / static_cast<double>(kTurn);
      out.put(std::uint16_t{0xeeff});
      out.put(static_cast<std::uint16_t>(static_cast<long>(begin) % 36000));
      for (int firing = 0; firing < 32; ++firing) {
        const double after = firing / 16 * 55'296.0 + firing % 16 * 2'304.0;
        const double turned = 2.0 * std::numbers::pi * after / static_cast<double>(kTurn);
        put_vlp16_return(out, firing % 16, begin * kDegree / 100.0 + turned);
      }
    }
    out.put(static_cast<std::uint32_t>(time % (3600 * kSecond) / 1000));
    out.put(std::uint8_t{0x37}).put(std::uint8_t{0x22});
    packets.push_back({time + 1'400'000, std::move(out.all)});
  }
  return packets;
}

VelodyneBeams hdl32e() {
  return {0x21,
          {-30.67, -9.33,  -29.33, -8.00,  -28.00, -6.67,  -26.67, -5.33,  -25.33, -4.00,  -24.00,
           -2.67,  -22.67, -1.33,  -21.33, 0.00,   -20.00, 1.33,   -18.67, 2.67,   -17.33, 4.00,
           -16.00, 5.33,   -14.67, 6.67,   -13.33, 8.00,   -12.00, 9.33,   -10.67, 10.67},
          std::vector<double>(32, 0.0),
          0.002,
          46.080,
          1.152};
}

VelodyneBeams vlp32c() {
  return {0x28,
          {-25,    -1,     -1.667, -15.639, -11.31, 0,      -0.667, -8.843, -7.254, 0.333,  -0.333,
           -6.148, -5.333, 1.333,  0.667,   -4,     -4.667, 1.667,  1,      -3.667, -3.333, 3.333,
           2.333,  -2.667, -3,     7,       4.667,  -2.333, -2,     15,     10.333, -1.333},
          {1.4, -4.2, 1.4, -1.4, 1.4, -1.4, 4.2, -1.4, 1.4, -4.2, 1.4, -1.4, 4.2, -1.4, 4.2, -1.4,
           1.4, -4.2, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4, 1.4, -1.4, 1.4, -4.2, 4.2, -1.4, 1.4, -1.4},
          0.004,
          55.296,
          2.304,
          2};
}

VelodyneBeams puck_hi_res() {
  return {0x24,
          {-10, 0.667, -8.667, 2, -7.333, 3.333, -6, 4.667, -4.667, 6, -3.333, 7.333, -2, 8.667,
           -0.667, 10},
          std::vector<double>(16, 0.0),
          0.002,
          55.296,
          2.304};
}

std::vector<RoomPacket> velodyne_packets(Time start, int turns, const VelodyneBeams& beams) {
  const std::size_t lasers = beams.elevation.size();
  const double block = 1e3 * beams.cycle * static_cast<double>(32 / lasers);  // [ns]
  std::vector<RoomPacket> packets;
  for (int first = 0; first * block < turns * static_cast<double>(kTurn); first += 12) {
    const Time time = start + static_cast<Time>(first * block) / 1000 * 1000;
    Bytes out;
    for (int i = 0; i < 12; ++i) {
      const double begin = 36000.0 * (first + i) * block / static_cast<double>(kTurn);
      out.put(std::uint16_t{0xeeff});
      out.put(static_cast<std::uint16_t>(static_cast<long>(begin) % 36000));
      for (std::size_t firing = 0; firing < 32; ++firing) {
        const std::size_t laser = firing % lasers;
        const double after = 1e3 * (static_cast<double>(firing / lasers) * beams.cycle +
                                    static_cast<double>(laser / beams.at_once) * beams.firing);
        const double azimuth = begin * kDegree / 100.0 + beams.ahead[laser] * kDegree +
                               2.0 * std::numbers::pi * after / static_cast<double>(kTurn);
        const double up = beams.elevation[laser] * kDegree;
        const double range = range_in_room(
            {0, 0, 0},
            {std::cos(up) * std::cos(azimuth), -std::cos(up) * std::sin(azimuth), std::sin(up)});
        out.put(static_cast<std::uint16_t>(std::lround(range / beams.unit)));
        out.put(static_cast<std::uint8_t>(100 + laser));
      }
    }
    out.put(static_cast<std::uint32_t>(time % (3600 * kSecond) / 1000));
    out.put(std::uint8_t{0x37}).put(beams.code);
    packets.push_back({time + 1'400'000, std::move(out.all)});
  }
  return packets;
}

std::vector<RoomPacket> xt_packets(Time start, int turns, int lasers) {
  constexpr Duration kBlock = 50'000;
  std::vector<RoomPacket> packets;
  for (int first = 0; first < turns * 2000; first += 8) {
    Bytes out;
    out.put(std::uint8_t{0xee}).put(std::uint8_t{0xff}).put(std::uint8_t{6}).put(std::uint8_t{1});
    out.zeros(2).put(static_cast<std::uint8_t>(lasers)).put(std::uint8_t{8}).zeros(1);
    out.put(std::uint8_t{4}).zeros(2);
    for (int block = first; block < first + 8; ++block) {
      out.put(static_cast<std::uint16_t>(18 * block % 36000));
      for (int channel = 0; channel < lasers; ++channel) {
        const int beam = lasers == 16 ? 2 * channel : channel;
        const double after = 280.0 + beam * 1512.0;
        const double azimuth = (0.18 * block + 0.18 * after / kBlock) * kDegree;
        const double up = (15.0 - beam) * kDegree;
        const Eigen::Vector3d direction(std::cos(up) * std::sin(azimuth),
                                        std::cos(up) * std::cos(azimuth), std::sin(up));
        const double range = range_in_room(Eigen::Vector3d::Zero(), direction);
        out.put(static_cast<std::uint16_t>(std::lround(range / 0.004)));
        out.put(static_cast<std::uint8_t>(100 + beam)).zeros(1);
      }
    }
    const Time last = start + (first + 7) * kBlock;
    out.zeros(10).put(std::uint8_t{0x37}).put(std::uint16_t{600});
    put_utc(out, last);
    out.put(std::uint8_t{0x42}).put(static_cast<std::uint32_t>(first / 8));
    packets.push_back({last + 60'000, std::move(out.all)});
  }
  return packets;
}

std::vector<RoomPacket> rs16_packets(Time start, int turns, const Rs16& sensor) {
  constexpr double kFiring = 55'500.0;  // [ns]
  const int firings = sensor.dual ? 1 : 2;
  const double block_time = firings * kFiring;
  std::vector<RoomPacket> packets;
  for (int first = 0; first * block_time < turns * static_cast<double>(kTurn); first += 12) {
    // The sensor's clock has whole microseconds.
    const Time time = start + static_cast<Time>(first * block_time) / 1000 * 1000;
    Bytes out;
    out.put(std::uint64_t{0xa050a55a0a05aa55}).zeros(12);
    put_rs16_date(out, time);
    out.put(std::uint8_t{1}).zeros(11);
    for (int block = first; block < first + 12; ++block) {
      const double begin = 36000.0 * block * block_time / static_cast<double>(kTurn);
      out.put(std::uint16_t{0xeeff});
      put_big(out, static_cast<int>(begin) % 36000);
      for (int channel = 0; channel < 32; ++channel) {
        const double after = (sensor.dual ? 0 : channel / 16) * kFiring + channel % 16 * 2'800.0;
        const double azimuth =
            begin * kDegree / 100.0 + 2.0 * std::numbers::pi * after / static_cast<double>(kTurn);
        put_rs16_return(out, channel, azimuth, sensor);
      }
    }
    out.zeros(4).put(std::uint16_t{0xff00});
    packets.push_back({time + 1'500'000, std::move(out.all)});
  }
  return packets;
}

RoomPacket rs16_information(Time time, const Rs16& sensor) {
  Bytes out;
  out.put(std::uint64_t{0x555511115a00ffa5}).zeros(292);
  out.put(static_cast<std::uint8_t>(sensor.dual ? 0 : 1)).zeros(864);
  for (int channel = 0; channel < 16; ++channel) {
    const auto angle = std::lround(1e4 * std::abs(rs16_elevation(channel) + sensor.tilt));
    out.put(static_cast<std::uint8_t>(angle >> 16));
    put_big(out, static_cast<int>(angle & 0xffff));
  }
  out.zeros(35);
  return {time, std::move(out.all)};
}

std::vector<RoomPacket> ouster_lidar_packets(Time start, Time clock, int turns) {
  std::vector<RoomPacket> packets;
  for (int frame = 0; frame < turns; ++frame) {
    for (std::size_t first = 0; first < kColumns; first += 16) {
      Bytes out;
      for (std::size_t column = first; column < first + 16; ++column) {
        const auto after = static_cast<Duration>(column * kTurn / kColumns);
        put_ouster_column(out, clock + frame * kTurn + after, column, frame);
      }
      const auto sent = static_cast<Duration>((first + 16) * kTurn / kColumns);
      packets.push_back({start + frame * kTurn + sent, std::move(out.all)});
    }
  }
  return packets;
}

std::vector<RoomPacket> ouster_imu_packets(Time start, Time clock, int packets) {
  std::vector<RoomPacket> all;
  for (int k = 0; k < packets; ++k) {
    const Duration after = k * 10 * kMillisecond;
    Bytes out;
    for (int i = 0; i < 3; ++i) out.put(static_cast<std::uint64_t>(clock + after));
    for (const float value : {0.0F, 0.6F, 0.8F, 10.0F, -20.0F, 30.0F}) out.put(value);
    all.push_back({start + after + kMillisecond, std::move(out.all)});
  }
  return all;
}

std::string ouster_metadata_text() {
  std::string altitudes, azimuths;
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    altitudes += fmt::format("{}{}", beam == 0 ? "" : ", ", beam_altitude(beam));
    azimuths += fmt::format("{}{}", beam == 0 ? "" : ", ", beam_azimuth(beam));
  }
  return fmt::format(
      R"({{"beam_intrinsics": {{"beam_altitude_angles": [{}], "beam_azimuth_angles": [{}],)"
      R"( "lidar_origin_to_beam_origin_mm": 15.806}},)"
      R"( "config_params": {{"lidar_mode": "512x10", "udp_profile_lidar": "LEGACY"}},)"
      R"( "lidar_data_format": {{"columns_per_frame": 512, "columns_per_packet": 16}},)"
      R"( "lidar_intrinsics": {{"lidar_to_sensor_transform":)"
      R"( [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1]}},)"
      R"( "imu_intrinsics": {{"imu_to_sensor_transform":)"
      R"( [1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1]}}}})",
      altitudes, azimuths);
}

}  // namespace aims::test
