// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/kitti.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/SVD>
#include <limits>

#include "core/files/number_lines.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::size_t kColumns = 12;
constexpr double kOrthonormalTolerance = 5e-3;

using PoseRows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

/// The rotation nearest to a matrix that is almost one, as rounded decimals are.
Eigen::Quaterniond nearest_rotation(const Eigen::Matrix3d& R) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Eigen::Quaterniond(svd.matrixU() * svd.matrixV().transpose()).normalized();
}

Result<Pose> pose_of(const PoseRows& rows) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Matrix3d R = rows.leftCols<3>();
  if (!rows.allFinite()) return Pose{Eigen::Quaterniond(kNaN, kNaN, kNaN, kNaN), rows.col(3)};
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= kOrthonormalTolerance)) {
    return failure(
        fmt::format("expected a rotation in columns 1-3, 5-7 and 9-11, found a matrix "
                    "whose RᵀR is {:g} off the identity",
                    off));
  }
  if (R.determinant() < 0.0) {
    return failure("expected a rotation in columns 1-3, 5-7 and 9-11, found a reflection");
  }
  return Pose{nearest_rotation(R), rows.col(3)};
}

Result<Pose> parse_line(std::string_view line, PoseRules rules) {
  const std::vector<std::string_view> words = words_of(line);
  if (words.size() != kColumns) {
    return failure(
        fmt::format("expected 12 columns, the rows of a 3x4 pose, found {}", words.size()));
  }
  const bool strict = rules == PoseRules::kStrict;
  PoseRows rows;
  for (std::size_t i = 0; i < kColumns; ++i) {
    const auto number = parse_number(words[i], strict);
    if (!number) {
      return failure(fmt::format("column {}: expected a {}number, found '{}'", i + 1,
                                 strict ? "finite " : "", words[i]));
    }
    rows(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = *number;
  }
  return pose_of(rows);
}

}  // namespace

Result<std::vector<Pose>> parse_kitti(std::string_view text, const std::string& name,
                                      PoseRules rules) {
  std::vector<Pose> poses;
  LineReader lines(text, name);
  while (const auto line = lines.next()) {
    const auto pose = parse_line(*line, rules);
    if (!pose) return lines.error(pose.error().message);
    poses.push_back(*pose);
  }
  return poses;
}

Result<std::vector<Time>> parse_times(std::string_view text, const std::string& name) {
  std::vector<Time> times;
  LineReader lines(text, name);
  while (const auto line = lines.next()) {
    const std::vector<std::string_view> words = words_of(*line);
    const auto stamp = words.size() == 1 ? parse_stamp(words[0]) : std::nullopt;
    if (!stamp) return lines.error(fmt::format("expected one stamp in seconds, found '{}'", *line));
    if (!times.empty() && *stamp <= times.back()) {
      return lines.error(fmt::format("expected a stamp after {}, found {}",
                                     stamp_text(times.back()), stamp_text(*stamp)));
    }
    times.push_back(*stamp);
  }
  return times;
}

}  // namespace aims
