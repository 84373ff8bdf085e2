// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/pcap/ouster_packets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/files/byte_cursor.hpp"
#include "core/files/number_lines.hpp"
#include "core/files/text_file.hpp"
#include "core/files/yaml_scalars.hpp"

namespace aims {

/// Where things stand in a packet of a profile [bytes].
struct OusterScans::Layout {
  std::string_view profile;
  std::size_t packet_header, column_header, column_footer, packet_footer, pixel;
  std::size_t frame;  ///< of the frame number, in the packet or, with `in_column`, column
  bool frame_in_column;
  std::size_t status;  ///< in the column; behind its pixels where it has a footer
  std::uint32_t range_mask;
  std::size_t range_bytes;
  int range_unit;            ///< [mm]
  std::size_t reflectivity;  ///< in the pixel
  std::size_t reflectivity_bytes;
  std::size_t second = 0;   ///< return, of the same form, in the pixel; 0: none
  std::size_t signals = 0;  ///< of both returns, in the pixel
};

namespace {

constexpr double kGravity = 9.80665;  ///< of the unit of the accelerometer [m/s^2]
constexpr std::size_t kMaxBeams = 256;

using Scalars = std::map<std::string, std::string>;

/// A time in nanoseconds; one that no clock gives is 0.
Time stamp_at(const std::byte* bytes) {
  const auto stamp = load_number<std::uint64_t>(bytes);
  return stamp < (std::uint64_t{1} << 62) ? static_cast<Time>(stamp) : 0;
}

/// The value of the one key that is or ends in `key`: newer files have groups.
const std::string* find(const Scalars& scalars, std::string_view key) {
  for (const auto& [name, value] : scalars) {
    const bool same = name == key;
    if (same || (name.ends_with(key) && name[name.size() - key.size() - 1] == '.')) return &value;
  }
  return nullptr;
}

std::vector<double> numbers_of(const Scalars& scalars, std::string_view key) {
  std::vector<double> numbers;
  while (numbers.size() <= kMaxBeams) {
    const std::string* text = find(scalars, fmt::format("{}.{}", key, numbers.size()));
    const auto number = text != nullptr ? parse_number(*text) : std::nullopt;
    if (!number) break;
    numbers.push_back(*number);
  }
  return numbers;
}

/// A positive whole number, or the given one where the key is missing; 0 for anything else.
int count_of(const Scalars& scalars, std::string_view key, int otherwise) {
  const std::string* text = find(scalars, key);
  if (text == nullptr) return otherwise;
  const auto number = parse_number(*text);
  return number && *number >= 1.0 && *number <= 65535.0 ? static_cast<int>(*number) : 0;
}

/// A row-major transform in millimetres, or the identity where the key is missing.
std::optional<Pose> transform_of(const Scalars& scalars, std::string_view key) {
  const std::vector<double> m = numbers_of(scalars, key);
  if (m.empty()) return Pose();
  if (m.size() != 16) return std::nullopt;
  Eigen::Matrix3d R;
  R << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  if (!(R * R.transpose()).isIdentity(1e-3) || R.determinant() < 0.0) return std::nullopt;
  return Pose{Eigen::Quaterniond(R).normalized(), 1e-3 * Eigen::Vector3d(m[3], m[7], m[11])};
}

bool is_read(std::string_view profile) {
  constexpr auto kProfiles = std::to_array<std::string_view>(
      {"LEGACY", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL", "RNG15_RFL8_NIR8"});
  return std::ranges::find(kProfiles, profile) != kProfiles.end();
}

/// Columns of a turn, and of the part of it that is sent.
void set_columns(const Scalars& scalars, OusterMetadata& metadata) {
  metadata.columns_per_frame = count_of(scalars, "columns_per_frame", 0);
  if (const std::string* mode = find(scalars, "lidar_mode");
      mode != nullptr && metadata.columns_per_frame == 0) {
    std::from_chars(mode->data(), mode->data() + mode->size(), metadata.columns_per_frame);
  }
  metadata.window_columns = metadata.columns_per_frame;
  const std::vector<double> window = numbers_of(scalars, "column_window");
  if (window.size() == 2) {
    const double columns = window[1] - window[0] + 1.0;
    const double turn = columns > 0.0 ? 0.0 : metadata.columns_per_frame;
    metadata.window_columns = static_cast<int>(
        std::clamp(columns + turn, 1.0, static_cast<double>(metadata.columns_per_frame)));
  }
}

}  // namespace

const OusterScans::Layout& OusterScans::layout() const {
  static constexpr std::array<Layout, 4> kLayouts = {{
      {"LEGACY", 0, 16, 4, 0, 12, 10, true, 0, 0xfffff, 4, 1, 4, 2},
      {"RNG19_RFL8_SIG16_NIR16", 32, 12, 0, 32, 12, 2, false, 10, 0x7ffff, 4, 1, 4, 1},
      {"RNG19_RFL8_SIG16_NIR16_DUAL", 32, 12, 0, 32, 16, 2, false, 10, 0x7ffff, 4, 1, 3, 1, 4, 8},
      {"RNG15_RFL8_NIR8", 32, 12, 0, 32, 4, 2, false, 10, 0x7fff, 2, 8, 2, 1},
  }};
  const auto found = std::ranges::find(kLayouts, metadata_.profile, &Layout::profile);
  return found == kLayouts.end() ? kLayouts.front() : *found;
}

Result<OusterMetadata> read_ouster_metadata(const std::filesystem::path& file) {
  const auto text = read_text_file(file, std::size_t{1} << 20);
  if (!text) return tl::unexpected(text.error());
  return parse_ouster_metadata(*text, file.string());
}

Result<OusterMetadata> parse_ouster_metadata(const std::string& text, const std::string& name) {
  const auto scalars = yaml_scalars(text, name);  // JSON is YAML
  if (!scalars) return tl::unexpected(scalars.error());
  const auto refuse = [&](std::string_view key, const std::string& what) {
    return failure(fmt::format("{}: {}: expected {}", name, key, what));
  };
  OusterMetadata metadata;
  const std::string* profile = find(*scalars, "udp_profile_lidar");
  metadata.profile = profile == nullptr || profile->empty() ? "LEGACY" : *profile;
  if (!is_read(metadata.profile)) {
    return refuse("udp_profile_lidar",
                  fmt::format("LEGACY, RNG19_RFL8_SIG16_NIR16, RNG19_RFL8_SIG16_NIR16_DUAL or "
                              "RNG15_RFL8_NIR8, found '{}'",
                              metadata.profile));
  }
  metadata.altitude_deg = numbers_of(*scalars, "beam_altitude_angles");
  metadata.azimuth_deg = numbers_of(*scalars, "beam_azimuth_angles");
  const std::size_t beams = metadata.altitude_deg.size();
  if (beams == 0 || beams > kMaxBeams || metadata.azimuth_deg.size() != beams) {
    return refuse(
        "beam_altitude_angles, beam_azimuth_angles",
        fmt::format("an angle of each beam, found {} and {}", beams, metadata.azimuth_deg.size()));
  }
  const std::string* origin = find(*scalars, "lidar_origin_to_beam_origin_mm");
  metadata.origin_to_beam = 1e-3 * (origin ? parse_number(*origin).value_or(0.0) : 0.0);
  set_columns(*scalars, metadata);
  metadata.columns_per_packet = count_of(*scalars, "columns_per_packet", 16);
  if (metadata.columns_per_frame < 1 || metadata.columns_per_packet < 1) {
    return refuse("columns_per_frame, columns_per_packet", "numbers above 0");
  }
  const auto lidar = transform_of(*scalars, "lidar_to_sensor_transform");
  const auto imu = transform_of(*scalars, "imu_to_sensor_transform");
  if (!lidar || !imu) {
    return refuse("lidar_to_sensor_transform, imu_to_sensor_transform", "rigid transforms");
  }
  metadata.T_sensor_lidar = *lidar;
  metadata.T_sensor_imu = *imu;
  return metadata;
}

OusterScans::OusterScans(OusterMetadata metadata) : metadata_(std::move(metadata)) {}

std::size_t OusterScans::lidar_packet_size() const {
  const Layout& packet = layout();
  const std::size_t column =
      packet.column_header + packet.column_footer + packet.pixel * metadata_.altitude_deg.size();
  return packet.packet_header + packet.packet_footer +
         column * static_cast<std::size_t>(metadata_.columns_per_packet);
}

std::optional<LidarScan> OusterScans::add(std::span<const std::byte> packet) {
  const Layout& at = layout();
  const std::size_t column_size =
      at.column_header + at.column_footer + at.pixel * metadata_.altitude_deg.size();
  std::optional<LidarScan> ended;
  for (int i = 0; i < metadata_.columns_per_packet; ++i) {
    const std::byte* column = &packet[at.packet_header + static_cast<std::size_t>(i) * column_size];
    const auto frame =
        load_number<std::uint16_t>(at.frame_in_column ? column + at.frame : &packet[at.frame]);
    const std::size_t status = at.column_footer > 0 ? column_size - at.column_footer : at.status;
    if ((std::to_integer<int>(column[status]) & 1) == 0) continue;  // not measured
    if (frame == before_ && frame != frame_) continue;              // late
    if (frame != frame_) {
      if (auto whole = finish(); whole) ended = std::move(whole);
      received_.assign(static_cast<std::size_t>(metadata_.columns_per_frame), false);
      before_ = std::exchange(frame_, frame);
      frames_ = std::min(frames_ + 1, 2);
    }
    const auto measurement = load_number<std::uint16_t>(column + 8);
    if (measurement >= received_.size()) beyond_ = measurement;
    if (measurement >= received_.size() || received_[measurement]) continue;
    received_[measurement] = true;
    add_column(column);
  }
  return ended;
}

std::optional<LidarScan> OusterScans::finish(bool at_end) {
  const auto columns = std::ranges::count(received_, true);
  most_columns_ = std::max(most_columns_, columns);
  const bool complete = columns >= metadata_.window_columns;
  LidarScan scan = std::exchange(scan_, {});
  const bool inner = frames_ > 1 && !at_end;
  if (scan.points.empty() || (!inner && !complete)) return std::nullopt;
  return scan;
}

/// The return with the larger signal: their order depends on the configuration of the sensor.
const std::byte* OusterScans::stronger_return(const std::byte* pixel) const {
  const Layout& at = layout();
  if (at.second == 0) return pixel;
  const std::byte* signals = pixel + at.signals;
  const bool later = load_number<std::uint16_t>(signals + 2) > load_number<std::uint16_t>(signals);
  return later ? pixel + at.second : pixel;
}

void OusterScans::add_column(const std::byte* column) {
  const Layout& at = layout();
  const auto stamp = stamp_at(column);
  const auto measurement = load_number<std::uint16_t>(column + 8);
  const double encoder = 2.0 * std::numbers::pi *
                         (1.0 - static_cast<double>(measurement) / metadata_.columns_per_frame);
  const double origin = metadata_.origin_to_beam;
  const std::size_t beams = metadata_.altitude_deg.size();
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const std::byte* pixel = stronger_return(column + at.column_header + beam * at.pixel);
    const std::uint32_t raw =
        at.range_bytes == 4 ? load_number<std::uint32_t>(pixel) : load_number<std::uint16_t>(pixel);
    const double range = 1e-3 * at.range_unit * (raw & at.range_mask);
    if (range == 0.0) continue;
    const double azimuth = encoder - metadata_.azimuth_deg[beam] * std::numbers::pi / 180.0;
    const double altitude = metadata_.altitude_deg[beam] * std::numbers::pi / 180.0;
    const double across = (range - origin) * std::cos(altitude);
    LidarPoint point;
    point.position = Eigen::Vector3d(across * std::cos(azimuth) + origin * std::cos(encoder),
                                     across * std::sin(azimuth) + origin * std::sin(encoder),
                                     (range - origin) * std::sin(altitude))
                         .cast<float>();
    const std::byte* reflectivity = pixel + at.reflectivity;
    const int reflected = at.reflectivity_bytes == 2 ? load_number<std::uint16_t>(reflectivity)
                                                     : std::to_integer<int>(*reflectivity);
    point.intensity = static_cast<float>(std::min(reflected, 255)) / 255.0F;
    point.ring = static_cast<std::uint16_t>(beams - 1 - beam);
    if (scan_.points.empty()) scan_.stamp = stamp;
    // Columns of one frame lie within a turn of 0.2 s.
    const Duration after = std::clamp<Duration>(stamp - scan_.stamp, 0, kSecond);
    point.time_offset_ns = static_cast<std::int32_t>(after);
    scan_.end = std::max(scan_.end, scan_.stamp + after);
    scan_.points.push_back(point);
  }
}

ImuSample OusterScans::imu_of(std::span<const std::byte> packet) {
  ImuSample sample;
  // The times of accelerometer and gyroscope; that of the latter.
  sample.stamp = stamp_at(&packet[16]);
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t at = 24 + 4 * static_cast<std::size_t>(axis);
    sample.specific_force[axis] = kGravity * load_number<float>(&packet[at]);
    sample.angular_velocity[axis] = load_number<float>(&packet[at + 12]) * std::numbers::pi / 180.0;
  }
  return sample;
}

}  // namespace aims
