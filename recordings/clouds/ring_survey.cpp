// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/clouds/ring_survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.hpp"
#include "core/median.hpp"

namespace aims {
namespace {

constexpr std::size_t kMaxRings = 256;
constexpr std::size_t kMaxElevations = 100'000;
/// Standard deviation of the elevations of a ring, beyond which it is none [rad].
constexpr double kRingDeviation = 0.07;
constexpr double kRingGap = 1e-3;  ///< between the elevations of neighbouring rings, at least [rad]

constexpr std::array<std::string_view, 5> kRingFields = {"ring", "line", "channel", "laser_id",
                                                         "scan_id"};

/// Centres of the clusters of elevations; empty when there are no clear clusters.
std::vector<double> ring_elevations(std::vector<float> elevations) {
  std::sort(elevations.begin(), elevations.end());
  std::vector<double> rings;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= elevations.size(); ++i) {
    if (i < elevations.size() && elevations[i] - elevations[i - 1] < kRingGap) continue;
    if (elevations[i - 1] - elevations[begin] > 5.0 * kRingGap) return {};
    rings.push_back(0.5 * (elevations[begin] + elevations[i - 1]));
    if (rings.size() > kMaxRings) return {};
    begin = i;
  }
  if (rings.size() < 2) return {};
  return rings;
}

}  // namespace

std::span<const std::string_view> ring_field_names() { return kRingFields; }

void RingSurvey::begin(const PointTable& table) {
  const std::size_t smaller = std::min(table.width, table.height);
  const ColumnLayout* ring = table.find_any(kRingFields);
  // The first clouds of a driver may lack what the others have.
  if (source_ != RingSource::kField && ring != nullptr) {
    source_ = RingSource::kField;
    name_ = ring->name;
    rings_.clear();
    number_.reset();
    other_numbers_ = false;
  } else if (!begun_ && smaller > 1 && smaller <= kMaxRings) {
    source_ = table.height <= table.width ? RingSource::kRow : RingSource::kColumn;
  }
  begun_ = true;
  field_.reset();
  if (source_ != RingSource::kField) return;
  if (const ColumnLayout* column = table.find(name_)) field_.emplace(table, *column);
}

void RingSurvey::add(const PointTable& table, std::size_t index, const Eigen::Vector3d& position) {
  const double elevation = std::atan2(position.z(), std::hypot(position.x(), position.y()));
  if (elevations_.size() < kMaxElevations) elevations_.push_back(static_cast<float>(elevation));
  if (source_ == RingSource::kNone || (source_ == RingSource::kField && !field_)) return;
  double ring = -1.0;
  if (source_ == RingSource::kRow) ring = static_cast<double>(index / table.width);
  if (source_ == RingSource::kColumn) ring = static_cast<double>(index % table.width);
  if (field_) ring = field_->at(table.point(index));
  if (!number_) number_ = ring;
  other_numbers_ = other_numbers_ || ring != *number_;
  if (!(ring >= 0.0) || ring >= static_cast<double>(kMaxRings)) return;
  const auto at = static_cast<std::size_t>(ring);
  if (at >= rings_.size()) rings_.resize(at + 1);
  rings_[at].elevation_sum += elevation;
  rings_[at].elevation_squares += elevation * elevation;
  ++rings_[at].points;
}

/// Whether the elevation decreases from ring to ring.
bool RingSurvey::highest_first() const {
  int rising = 0, falling = 0;
  std::optional<double> below;
  for (const Mean& ring : rings_) {
    if (ring.points == 0) continue;
    const double mean = ring.mean();
    if (below) ++(mean > *below ? rising : falling);
    below = mean;
  }
  return falling >= 3 && rising * 10 <= falling;
}

double RingSurvey::Mean::deviation() const {
  return std::sqrt(std::max(0.0, elevation_squares / points - mean() * mean()));
}

/// Whether the points of a ring are spread over elevations, as those of the lines of a rosette are.
bool RingSurvey::are_lines() const {
  std::vector<double> deviations;
  for (const Mean& ring : rings_) {
    if (ring.points > 0) deviations.push_back(ring.deviation());
  }
  return upper_median(deviations).value_or(0.0) > kRingDeviation;
}

LidarRings RingSurvey::rings() const {
  std::vector<double> means;
  for (const Mean& ring : rings_) {
    if (ring.points > 0) means.push_back(ring.mean());
  }
  if (means.empty()) return {};
  const auto [lowest, highest] = std::ranges::minmax(means);
  const double gaps = std::max(1.0, static_cast<double>(means.size()) - 1.0);
  return {static_cast<int>(rings_.size()), (highest - lowest) / gaps / kRadiansPerDegree};
}

/// Whether a field of rings holds one and the same number, though the points lie at many
/// elevations.
bool RingSurvey::is_constant() const {
  if (source_ != RingSource::kField || other_numbers_ || elevations_.empty()) return false;
  const auto [lowest, highest] = std::ranges::minmax(elevations_);
  return highest - lowest > kRingDeviation;
}

/// Rings from the elevations of the points; `lack` says why.
void RingSurvey::derive(const std::string& lack, CloudReading& reading, ReadingNotes& notes) const {
  reading.ring_field.clear();
  reading.ring_source = RingSource::kNone;
  reading.ring_elevations = ring_elevations(elevations_);
  const std::size_t count = reading.ring_elevations.size();
  if (count == 0) {
    const std::string text = lack + " and their elevations form no clusters: all are ring 0";
    return elevations_.empty() ? notes.push_back(text) : notes.warn("rings unknown", text);
  }
  reading.ring_source = RingSource::kElevation;
  const double span = reading.ring_elevations.back() - reading.ring_elevations.front();
  reading.rings = {static_cast<int>(count),
                   span / (static_cast<double>(count) - 1.0) / kRadiansPerDegree};
  notes.push_back(fmt::format("{}: derived from elevation, {} rings", lack, count));
}

/// The same where the recording has rings that are none.
void RingSurvey::derive_instead(const std::string& lack, CloudReading& reading,
                                ReadingNotes& notes) const {
  notes.warn("rings derived from elevation",
             lack + ": it is no ring; enable it in the LiDAR's driver");
  derive(lack, reading, notes);
}

void RingSurvey::decide(CloudReading& reading, ReadingNotes& notes) const {
  reading.ring_source = source_;
  reading.ring_field = name_;
  if (source_ == RingSource::kNone) return derive("points have no ring", reading, notes);
  if (is_constant()) {
    return derive_instead(fmt::format("point field '{}' is the same for all points", name_),
                          reading, notes);
  }
  if (source_ != RingSource::kField) {
    notes.push_back(fmt::format("points have no ring: derived from the {} of the organised cloud",
                                source_ == RingSource::kRow ? "row" : "column"));
  }
  // Points of a rosette lie at all elevations.
  if (source_ == RingSource::kField && are_lines() && !ring_elevations(elevations_).empty()) {
    return derive_instead(
        fmt::format("point field '{}' does not go with the elevations of the points, which form "
                    "groups",
                    name_),
        reading, notes);
  }
  if (are_lines()) {
    notes.push_back(
        fmt::format("points of one {} are spread over elevations: lines of a rosette, not rings",
                    source_ == RingSource::kField ? "'" + name_ + "'" : "row"));
    return;
  }
  reading.rings = rings();
  if (!highest_first()) return;
  reading.flipped_rings = static_cast<int>(rings_.size());
  notes.push_back("ring 0 is the highest: renumbered from the lowest");
}

}  // namespace aims
