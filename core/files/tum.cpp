// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/tum.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "core/files/number_lines.hpp"
#include "core/files/text_file.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::size_t kColumns = 8;
constexpr double kNormTolerance = 1e-3;

/// "1700000000123456789', likely in ns": of whole numbers, their digits tell the unit.
std::string likely_unit(std::string_view stamp) {
  if (stamp.find_first_not_of("0123456789") != std::string_view::npos) return "";
  if (stamp.size() < 12) return "";
  return fmt::format(", likely in {}", stamp.size() < 15 ? "ms" : stamp.size() < 18 ? "us" : "ns");
}

Result<StampedPose> parse_line(std::string_view line, PoseRules rules) {
  const bool strict = rules == PoseRules::kStrict;
  const std::vector<std::string_view> words = words_of(line);
  if (words.size() != kColumns) {
    return failure(
        fmt::format("expected 8 columns 'stamp x y z qx qy qz qw', found {}", words.size()));
  }
  const auto stamp = parse_stamp(words[0]);
  if (!stamp) {
    return failure(
        fmt::format("expected a stamp in seconds, found '{}'{}", words[0], likely_unit(words[0])));
  }
  std::array<double, kColumns> v{};
  for (std::size_t i = 1; i < kColumns; ++i) {
    const auto number = parse_number(words[i], strict);
    if (!number) {
      return failure(fmt::format("column {}: expected a {}number, found '{}'", i + 1,
                                 strict ? "finite " : "", words[i]));
    }
    v[i] = *number;
  }
  Eigen::Quaterniond rotation(v[7], v[4], v[5], v[6]);
  const double norm = rotation.norm();
  const bool unit = std::abs(norm - 1.0) <= kNormTolerance;
  if (strict && !unit) {
    return failure(fmt::format("expected a quaternion of norm 1, found norm {:g}", norm));
  }
  // Only a norm that is off by more than rounding is touched, so that a round trip is exact.
  if (unit && std::abs(norm - 1.0) > 1e-14) rotation.normalize();
  return StampedPose{*stamp, {rotation, {v[1], v[2], v[3]}}};
}

}  // namespace

std::string tum_text(std::span<const StampedPose> poses) {
  constexpr std::size_t kLine = 120;  // about
  std::string out;
  out.reserve(kLine * poses.size());
  for (const StampedPose& each : poses) {
    const Eigen::Vector3d& p = each.pose.translation;
    const Eigen::Quaterniond& q = each.pose.rotation;
    fmt::format_to(std::back_inserter(out), "{} {} {} {} {} {} {} {}\n", stamp_text(each.stamp),
                   p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  return out;
}

Result<Trajectory> parse_tum(std::string_view text, const std::string& name, PoseRules rules) {
  Trajectory trajectory;
  LineReader lines(text, name);
  while (const auto line = lines.next()) {
    const auto pose = parse_line(*line, rules);
    if (!pose) return lines.error(pose.error().message);
    if (rules == PoseRules::kStrict && !trajectory.empty() &&
        pose->stamp <= trajectory.back().stamp) {
      return lines.error(fmt::format("expected a stamp after {}, found {}",
                                     stamp_text(trajectory.back().stamp), stamp_text(pose->stamp)));
    }
    trajectory.push_back(*pose);
  }
  return trajectory;
}

Result<void> write_tum(const std::filesystem::path& file, const Trajectory& trajectory) {
  return write_file_atomically(file, tum_text(trajectory));
}

Result<Trajectory> read_tum(const std::filesystem::path& file, PoseRules rules) {
  const auto text = read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse_tum(*text, file.string(), rules);
}

}  // namespace aims
