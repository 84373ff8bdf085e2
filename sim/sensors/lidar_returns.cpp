// SPDX-License-Identifier: BSD-3-Clause
// From the returns of a block of firings to points and their true hits. Each random stream is drawn
// from in the order of firing, and so each step is one loop over the block.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/angle.hpp"
#include "sim/sensors/lidar.hpp"

namespace aims {
namespace {

/// The nearest multiple of `step` of a value above minus half a step; a step of zero leaves it.
double rounded(double value, double step) {
  return step > 0.0 ? step * static_cast<double>(static_cast<std::int64_t>(value / step + 0.5))
                    : value;
}

/// Grows a vector; the index of its first new element.
template <class T>
std::size_t grow(std::vector<T>& vector, std::size_t count) {
  const std::size_t before = vector.size();
  vector.resize(before + count);
  return before;
}

}  // namespace

void Lidar::append_points(int block, const std::vector<Returns>& returns, LidarScan& scan,
                          ScanTruth* truth) {
  const BeamPacket* beams = &beams_.packets[block * pattern_.lines()];
  receive_block(returns);
  detect(beams, lanes_of(block), returns);
  measure_ranges(returns);
  append_measured(beams, returns, scan.points);
  if (truth == nullptr) return;
  append_hits(returns, *truth);
  append_noise(block, *truth);
}

/// Powers and range errors.
void Lidar::receive_block(const std::vector<Returns>& returns) {
  for (int line = 0; line < pattern_.lines(); ++line) {
    const Returns& each = returns[line];
    Received& received = received_[line];
    model_.powers(each.strength, each.hits.distance, received.power);
    if (model_.noise_differs()) {
      model_.range_sigmas(each.strength, each.hits.distance, received.sigma);
    }
    if (model_.has_bias()) model_.range_biases(line, each.cosine, received.bias);
  }
}

/// Lists the firings whose return is detected.
void Lidar::detect(const BeamPacket* beams, int lanes, const std::vector<Returns>& returns) {
  const double certain = 1.0 - config_.miss_probability;
  detected_.clear();
  for (int lane = 0; lane < lanes; ++lane) {
    for (const int line : pattern_.firing_order()) {
      if (returns[line].hits.surface[lane] < 0 || !beams[line].open[lane]) continue;
      const double probability = detection_probability(config_, received_[line].power[lane]);
      if (detection_.chance(certain * probability)) detected_.push_back({line, lane});
    }
  }
}

/// Measures ranges, and strikes from the list those that the sensor does not report.
void Lidar::measure_ranges(const std::vector<Returns>& returns) {
  ranges_.resize(detected_.size());
  noise_.normal(ranges_);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < detected_.size(); ++i) {
    const auto [line, lane] = detected_[i];
    const Received& received = received_[line];
    const double sigma = model_.noise_differs() ? received.sigma[lane] : config_.range_sigma;
    double range = returns[line].hits.distance[lane] + sigma * ranges_[i];
    if (model_.has_bias()) range += received.bias[lane];
    range = rounded(range, config_.range_resolution);
    if (range < config_.range_min || range > config_.range_max) continue;
    detected_[kept] = {line, lane};
    ranges_[kept++] = range;
  }
  detected_.resize(kept);
  ranges_.resize(kept);
}

void Lidar::append_measured(const BeamPacket* beams, const std::vector<Returns>& returns,
                            std::vector<LidarPoint>& points) {
  const std::size_t count = detected_.size();
  const std::span added(points.data() + grow(points, count), count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [line, lane] = detected_[i];
    const BeamDirections& nominal = beams[line].nominal;
    added[i].position = {nominal.x[lane], nominal.y[lane], nominal.z[lane]};
    added[i].time_offset_ns = beams[line].time_offset_ns[lane];
    added[i].ring = static_cast<std::uint16_t>(line);
  }
  if (config_.direction_sigma_deg > 0.0) turn_directions(added);
  const bool noisy = config_.intensity_sigma > 0.0;
  draws_.resize(count);
  if (noisy) intensity_noise_.normal(draws_);
  for (std::size_t i = 0; i < count; ++i) {
    added[i].position *= static_cast<float>(ranges_[i]);
    double intensity = returns[detected_[i].line].strength[detected_[i].lane];
    if (noisy) intensity *= 1.0 + config_.intensity_sigma * draws_[i];
    intensity = rounded(intensity, config_.intensity_resolution);
    added[i].intensity = static_cast<float>(std::clamp(intensity, 0.0, 1.0));
  }
}

/// Turns the nominal directions by the noise of the sensor's angles.
void Lidar::turn_directions(std::span<LidarPoint> directions) {
  const double sigma = config_.direction_sigma_deg * kRadiansPerDegree;
  for (LidarPoint& each : directions) {
    const Eigen::Vector3f nominal = each.position;
    const auto across = static_cast<float>(sigma * direction_noise_.normal());
    const auto up = static_cast<float>(sigma * direction_noise_.normal());
    const Eigen::Vector3f sideways = Eigen::Vector3f::UnitZ().cross(nominal).normalized();
    each.position = (nominal + across * sideways + up * nominal.cross(sideways)).normalized();
  }
}

void Lidar::append_hits(const std::vector<Returns>& returns, ScanTruth& truth) {
  for (int line = 0; line < pattern_.lines(); ++line) {
    const RayPacket& rays = returns[line].rays;
    const HitPacket& hits = returns[line].hits;
    Received& received = received_[line];
    for (int i = 0; i < kRayPacketSize; ++i) {
      received.x[i] = rays.origin_x[i] + hits.distance[i] * rays.direction_x[i];
      received.y[i] = rays.origin_y[i] + hits.distance[i] * rays.direction_y[i];
      received.z[i] = rays.origin_z[i] + hits.distance[i] * rays.direction_z[i];
      // A footprint's normal is that of another ray than its centre's.
      const float along =
          hits.normal_x[i] * rays.direction_x[i] +
          (hits.normal_y[i] * rays.direction_y[i] + hits.normal_z[i] * rays.direction_z[i]);
      received.cosine[i] = std::clamp(-along, 0.0F, 1.0F);
    }
  }
  const std::size_t count = detected_.size();
  const std::size_t first = grow(truth.points, count);
  grow(truth.normals, count);
  grow(truth.surfaces, count);
  grow(truth.cosines, count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [line, lane] = detected_[i];
    const HitPacket& hits = returns[line].hits;
    const Received& received = received_[line];
    truth.normals[first + i] = {hits.normal_x[lane], hits.normal_y[lane], hits.normal_z[lane]};
    truth.surfaces[first + i] = hits.surface[lane];
    truth.points[first + i] = {received.x[lane], received.y[lane], received.z[lane]};
    truth.cosines[first + i] = received.cosine[lane];
  }
}

/// Rounding to a step adds step^2 / 12 to the variance.
void Lidar::append_noise(int block, ScanTruth& truth) const {
  if (config_.beam.is_line() && !model_.noise_differs() && config_.range_resolution == 0.0) return;
  const double rounding = config_.range_resolution * config_.range_resolution / 12.0;
  for (const auto [line, lane] : detected_) {
    const double sigma = model_.noise_differs() ? received_[line].sigma[lane] : config_.range_sigma;
    truth.range_sigmas.push_back(edges_.marked(line, block * kRayPacketSize + lane)
                                     ? std::numeric_limits<float>::infinity()
                                     : static_cast<float>(std::sqrt(sigma * sigma + rounding)));
  }
}

}  // namespace aims
