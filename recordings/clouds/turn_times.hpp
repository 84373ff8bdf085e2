// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// The times of the points of one spinning LiDAR over their azimuths, by one field. What a blind
/// sector hides has no effect, nor what clouds are lost.
class TurnTimes {
 public:
  /// Begins the cloud of that number, counted from 0.
  void begin(std::size_t cloud);
  /// Adds a return of it, in the axes of the LiDAR and in the order of the cloud.
  void add(const Eigen::Vector3d& position, double time);

  /// Whether times fall from point to point of each ring, in the order of the clouds.
  bool fall() const;

  /// Time of a turn by the points' times, in the unit of the field; negative: clockwise. Nothing
  /// where times are not proportional to azimuths, as those of a Livox.
  std::optional<double> turn() const;

  /// By how much of a turn the azimuths advance from cloud to cloud otherwise than times and stamps
  /// say [-0.5, 0.5]. `stamps`: of the clouds; `origins`: their stamps on the clock of the points'
  /// times, in the unit of the field; `unit_ns`: that unit. Nothing where that varies, as by stamps
  /// that jitter.
  std::optional<double> misfit(const std::vector<Time>& stamps, const std::vector<double>& origins,
                               double unit_ns) const;

 private:
  static constexpr std::size_t kBins = 36;
  struct Bin {  ///< of azimuths
    int points = 0;
    double azimuth = 0.0, time = 0.0;  ///< sums, of the time after the first point's
  };
  struct Cloud {
    std::array<Bin, kBins> bins;
    std::optional<double> first;  ///< time of the first point
  };
  static std::optional<double> turn_of(const Cloud& cloud);
  static double phase_of(const Cloud& cloud, double turn, double origin);

  std::vector<Cloud> clouds_;
  std::vector<std::optional<double>> last_times_;  ///< in this cloud, by elevation
  int rising_ = 0, falling_ = 0;                   ///< times from point to point of a ring
};

}  // namespace aims
