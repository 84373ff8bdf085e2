// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/clouds/point_cloud.hpp"
#include "recordings/reading_notes.hpp"

namespace aims {

/// Names of a point's ring field in known drivers.
std::span<const std::string_view> ring_field_names();

/// Finds out from the first clouds how to determine the ring of a point.
class RingSurvey {
 public:
  /// Reads the layout of a cloud, before its points.
  void begin(const PointTable& table);
  /// Adds the point at `index`, which is finite and not at the origin.
  void add(const PointTable& table, std::size_t index, const Eigen::Vector3d& position);

  /// Fills in how rings are read; appends assumptions to `notes`.
  void decide(CloudReading& reading, ReadingNotes& notes) const;

 private:
  struct Mean {
    double elevation_sum = 0.0;      ///< [rad]
    double elevation_squares = 0.0;  ///< [rad^2]
    int points = 0;

    double mean() const { return elevation_sum / points; }
    double deviation() const;
  };

  bool highest_first() const;
  bool are_lines() const;
  bool is_constant() const;
  void derive(const std::string& lack, CloudReading& reading, ReadingNotes& notes) const;
  void derive_instead(const std::string& lack, CloudReading& reading, ReadingNotes& notes) const;
  LidarRings rings() const;

  bool begun_ = false;
  RingSource source_ = RingSource::kNone;
  std::string name_;
  std::optional<PointField> field_;  ///< of the current cloud
  std::vector<Mean> rings_;
  std::vector<float> elevations_;  ///< of the first points [rad]
  std::optional<double> number_;   ///< of the first point
  bool other_numbers_ = false;     ///< a point has another number
};

}  // namespace aims
