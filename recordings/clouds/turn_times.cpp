// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/clouds/turn_times.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/median.hpp"
#include "recordings/clouds/scan_period.hpp"

namespace aims {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;
constexpr double kElevationBin = 1e-3;  ///< [rad]
constexpr int kFewestSteps = 200;       ///< of times
constexpr double kNearlyAll = 0.9;      ///< of them
constexpr int kFewestBins = 8;
constexpr double kSame = 0.4;  ///< by which slopes differ where azimuths are proportional to times
constexpr double kMostly = 0.7;  ///< of the slopes
constexpr std::size_t kFewestClouds = 5;
constexpr double kSameTurn = 0.05;  ///< by which turns of clouds differ
constexpr double kSteady = 0.9;     ///< length of the mean of unit vectors

double azimuth_of(const Eigen::Vector3d& position) {
  const double azimuth = std::atan2(position.y(), position.x());
  return azimuth < 0.0 ? azimuth + kFullTurn : azimuth;
}

}  // namespace

void TurnTimes::begin(std::size_t cloud) {
  clouds_.resize(cloud + 1);
  last_times_.assign(static_cast<std::size_t>(std::numbers::pi / kElevationBin) + 1, {});
}

void TurnTimes::add(const Eigen::Vector3d& position, double time) {
  const double distance = position.head<2>().norm();
  if (!std::isfinite(time) || !(distance > 0.0)) return;
  const double elevation = std::atan2(position.z(), distance) + std::numbers::pi / 2.0;
  auto& last = last_times_.at(static_cast<std::size_t>(elevation / kElevationBin));
  if (last && time != *last) ++(time > *last ? rising_ : falling_);
  last = time;
  Cloud& cloud = clouds_.back();
  if (!cloud.first) cloud.first = time;
  const double azimuth = azimuth_of(position);
  const auto at = static_cast<std::size_t>(azimuth / kFullTurn * static_cast<double>(kBins));
  Bin& bin = cloud.bins.at(std::min(at, kBins - 1));
  ++bin.points;
  bin.azimuth += azimuth;
  bin.time += time - *cloud.first;
}

bool TurnTimes::fall() const {
  const int steps = rising_ + falling_;
  return steps >= kFewestSteps && falling_ > kNearlyAll * steps;
}

/// By the slope of times over azimuths from bin to bin; where a turn begins and ends it is another.
std::optional<double> TurnTimes::turn_of(const Cloud& cloud) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < kBins; ++i) {
    const Bin &bin = cloud.bins[i], &next = cloud.bins[(i + 1) % kBins];
    if (bin.points == 0 || next.points == 0) continue;
    double step = next.azimuth / next.points - bin.azimuth / bin.points;
    if (step < 0.0) step += kFullTurn;
    if (step > 0.0) slopes.push_back((next.time / next.points - bin.time / bin.points) / step);
  }
  if (std::ssize(slopes) < kFewestBins) return std::nullopt;
  const double slope = *upper_median(slopes);
  const auto same = std::ranges::count_if(
      slopes, [slope](double each) { return std::abs(each - slope) < kSame * std::abs(slope); });
  if (static_cast<double>(same) < kMostly * static_cast<double>(slopes.size())) return std::nullopt;
  return kFullTurn * slope;
}

std::optional<double> TurnTimes::turn() const {
  std::vector<double> turns;
  for (const Cloud& each : clouds_) {
    if (const auto turn = turn_of(each)) turns.push_back(*turn);
  }
  if (turns.size() < kFewestClouds || turns.size() < kMostly * static_cast<double>(clouds_.size()))
    return std::nullopt;
  const double turn = *upper_median(turns);
  const auto same = std::ranges::count_if(
      turns, [turn](double each) { return std::abs(each - turn) < kSameTurn * std::abs(turn); });
  if (static_cast<double>(same) < kMostly * static_cast<double>(turns.size())) return std::nullopt;
  return turn;
}

/// The azimuth at the origin of the times.
double TurnTimes::phase_of(const Cloud& cloud, double turn, double origin) {
  std::complex<double> sum = 0.0;
  for (const Bin& each : cloud.bins) {
    if (each.points == 0) continue;
    const double time = each.time / each.points + *cloud.first - origin;
    sum += std::polar(1.0, each.azimuth / each.points - kFullTurn * time / turn);
  }
  return std::arg(sum);
}

std::optional<double> TurnTimes::misfit(const std::vector<Time>& stamps,
                                        const std::vector<double>& origins, double unit_ns) const {
  const auto turn = this->turn();
  const auto usual = upper_median(spacings(stamps));
  if (!turn || !usual) return std::nullopt;
  std::complex<double> sum = 0.0;
  std::size_t pairs = 0;
  for (std::size_t i = 1; i < clouds_.size(); ++i) {
    const Duration step = stamps[i] - stamps[i - 1];
    if (std::abs(step - *usual) > *usual / 10) continue;
    if (!clouds_[i].first || !clouds_[i - 1].first) continue;
    const double turned =
        phase_of(clouds_[i], *turn, origins[i]) - phase_of(clouds_[i - 1], *turn, origins[i - 1]);
    sum += std::polar(1.0, turned - kFullTurn * static_cast<double>(step) / unit_ns / *turn);
    ++pairs;
  }
  if (pairs < kFewestClouds || std::abs(sum) < kSteady * static_cast<double>(pairs))
    return std::nullopt;
  return std::arg(sum) / kFullTurn;
}

}  // namespace aims
