// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sensors/return_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/angle.hpp"
#include "sim/sensors/lidar.hpp"
#include "tests/sim/sensors/closed_room.hpp"

namespace aims {
namespace {

using Eigen::Vector3d;
using testing::ClosedRoom;
using testing::flawless_lidar;
using testing::Spread;

/// Calls `visit(point, direction, what the room holds there)` for every point of some scans.
template <typename Visit>
void for_each_point(const ClosedRoom& room, Lidar& lidar, int scans, Visit visit) {
  for (int i = 0; i < scans; ++i) {
    const LidarScan scan = lidar.scan(0, room.poses());
    for (const LidarPoint& point : scan.points) {
      const Vector3d direction = point.position.cast<double>().normalized();
      visit(point, direction, room.along(direction));
    }
  }
}

TEST(RangeNoise, GrowsAsTheReceivedPowerFalls) {
  const ClosedRoom room{.reflectivity = 0.3};
  const RayCaster caster(room.scene());
  LidarConfig config = flawless_lidar();
  config.range_sigma = 0.008;
  config.range_sigma_at_threshold = 0.03;
  config.range_at_10_percent = 20.0;
  Lidar lidar(config, caster, 1);
  std::map<std::pair<int, int>, std::pair<Spread, Spread>> bins;  // residual over sigma, and sigma
  for_each_point(room, lidar, 5, [&](const LidarPoint& point, const Vector3d&, const auto& real) {
    const double power = 0.3 / 0.1 * real.cosine * std::pow(20.0 / real.range, 2);
    const double sigma = std::sqrt(std::pow(0.008, 2) + std::pow(0.03, 2) / power);
    auto& [scaled, sigmas] = bins[{static_cast<int>(real.range / 2.5),  // by range and incidence
                                   static_cast<int>(std::acos(real.cosine) * 3.0)}];
    scaled.add((point.position.cast<double>().norm() - real.range) / sigma);
    sigmas.add(sigma);
  });
  double least = 1.0;
  double greatest = 0.0;
  int checked = 0;
  for (const auto& [bin, spreads] : bins) {
    const auto& [scaled, sigmas] = spreads;
    if (scaled.count < 500) continue;
    ++checked;
    const double error = 4.0 / std::sqrt(scaled.count);
    EXPECT_NEAR(scaled.mean(), 0.0, error) << bin.first << ' ' << bin.second;
    EXPECT_NEAR(scaled.std(), 1.0, error) << bin.first << ' ' << bin.second;
    least = std::min(least, sigmas.mean());
    greatest = std::max(greatest, sigmas.mean());
  }
  EXPECT_GE(checked, 8);
  EXPECT_GT(greatest / least, 1.5) << "the room must show noise of different size";
}

TEST(RangeBias, IsTheDrawnOneByRingAndIncidence) {
  const ClosedRoom room;
  const RayCaster caster(room.scene());
  LidarConfig config = flawless_lidar();
  config.calibration = {.range_bias_sigma = 0.02,
                        .incidence_bias_mean = 0.007,
                        .incidence_bias_sigma = 0.002,
                        .ring_range_sigma = 0.01};
  Lidar lidar(config, caster, 4);
  const LidarCalibration& drawn = lidar.calibration();
  EXPECT_GT(std::abs(drawn.range_bias), 1e-3);
  double worst = 0.0;
  double steepest = 0.0;
  for_each_point(room, lidar, 1, [&](const LidarPoint& point, const Vector3d&, const auto& real) {
    const double expected = drawn.range_bias + drawn.ring_range[point.ring] +
                            drawn.incidence_bias * (1.0 / real.cosine - 1.0);
    worst = std::max(worst, std::abs(point.position.cast<double>().norm() - real.range - expected));
    steepest = std::max(steepest, 1.0 / real.cosine);
  });
  EXPECT_LT(worst, 1e-4);
  EXPECT_GT(steepest, 3.0);
}

TEST(LidarCalibration, HasTheConfiguredDeviationsOverRuns) {
  LidarConfig config;
  config.calibration = {.range_bias_sigma = 0.02,
                        .incidence_bias_mean = 0.007,
                        .incidence_bias_sigma = 0.003,
                        .ring_range_sigma = 0.01,
                        .ring_elevation_sigma_deg = 0.05,
                        .azimuth_sigma_deg = 0.1};
  Spread bias, incidence, ring, elevation, azimuth;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const LidarCalibration drawn = draw_calibration(config, seed);
    bias.add(drawn.range_bias / 0.02);
    incidence.add((drawn.incidence_bias - 0.007) / 0.003);
    ring.add(drawn.ring_range[5] / 0.01);
    elevation.add(drawn.ring_elevation[9] / (0.05 * kRadiansPerDegree));
    azimuth.add(drawn.azimuth_cosine / (0.1 * kRadiansPerDegree));
    azimuth.add(drawn.azimuth_sine / (0.1 * kRadiansPerDegree));
  }
  for (const Spread& each : {bias, incidence, ring, elevation, azimuth}) {
    EXPECT_NEAR(each.mean(), 0.0, 4.0 / std::sqrt(each.count));
    EXPECT_NEAR(each.std(), 1.0, 4.0 / std::sqrt(2.0 * each.count));
  }
}

TEST(RangeResolution, RoundsEveryRangeToItsStep) {
  const ClosedRoom room;
  const RayCaster caster(room.scene());
  LidarConfig config = flawless_lidar();
  config.range_resolution = 0.02;
  Lidar lidar(config, caster, 1);
  Spread residual;
  double off = 0.0;
  for_each_point(room, lidar, 1, [&](const LidarPoint& point, const Vector3d&, const auto& real) {
    const double range = point.position.cast<double>().norm();
    off = std::max(off, std::abs(range - 0.02 * std::round(range / 0.02)));
    residual.add(range - real.range);
  });
  EXPECT_LT(off, 1e-5);
  EXPECT_NEAR(residual.std(), 0.02 / std::sqrt(12.0), 2e-4);
  EXPECT_NEAR(residual.mean(), 0.0, 2e-4);
}

TEST(BeamDirections, AreReportedNominalAndFiredWithTheDrawnErrors) {
  const ClosedRoom room;
  const RayCaster caster(room.scene());
  LidarConfig config = flawless_lidar();
  config.calibration = {.ring_elevation_sigma_deg = 0.3, .azimuth_sigma_deg = 0.5};
  Lidar lidar(config, caster, 2);
  const LidarCalibration& drawn = lidar.calibration();
  double worst = 0.0;
  Spread nominal_error;
  for_each_point(
      room, lidar, 1, [&](const LidarPoint& point, const Vector3d& reported, const auto& real) {
        const double elevation = std::asin(reported.z());
        ASSERT_NEAR(elevation * 180.0 / std::numbers::pi, -15.0 + 2.0 * point.ring, 1e-3);
        const double azimuth = std::atan2(reported.y(), reported.x());
        const double true_elevation = elevation + drawn.ring_elevation[point.ring];
        const double true_azimuth = azimuth + drawn.azimuth_cosine * std::cos(azimuth) +
                                    drawn.azimuth_sine * std::sin(azimuth);
        const Vector3d fired(std::cos(true_elevation) * std::cos(true_azimuth),
                             std::cos(true_elevation) * std::sin(true_azimuth),
                             std::sin(true_elevation));
        const double range = point.position.cast<double>().norm();
        worst = std::max(worst, std::abs(range - room.along(fired).range));
        nominal_error.add(range - real.range);
      });
  EXPECT_LT(worst, 1e-4);
  EXPECT_GT(nominal_error.std(), 0.005);
}

/// Share of the beams that return, by incidence, against the formula.
void expect_detection(const LidarConfig& config, double reflectivity) {
  const ClosedRoom room{.reflectivity = reflectivity};
  const RayCaster caster(room.scene());
  LidarConfig everything = config;
  everything.range_at_10_percent = 1e4;
  std::map<int, std::pair<int, double>> expected;  // beams, and sum of probabilities
  Lidar all(everything, caster, 1);
  for_each_point(room, all, 1, [&](const LidarPoint&, const Vector3d&, const auto& real) {
    const double mirrored = 0.04 + 0.96 * std::pow(1.0 - real.cosine, 5);
    const double kept = std::pow(1.0 - config.specular_loss * mirrored, 2);
    auto& [beams, sum] = expected[static_cast<int>(real.cosine * 5.0)];
    ++beams;
    sum += detection_probability(config, reflectivity * kept, real.cosine, real.range);
  });
  std::map<int, int> seen;
  Lidar lidar(config, caster, 1);
  for_each_point(room, lidar, 1, [&](const LidarPoint&, const Vector3d&, const auto& real) {
    ++seen[static_cast<int>(real.cosine * 5.0)];
  });
  for (const auto& [bin, beams] : expected) {
    const auto& [count, sum] = beams;
    EXPECT_NEAR(seen[bin], sum, 4.0 * std::sqrt(0.25 * count) + 1.0) << "incidence bin " << bin;
  }
}

TEST(Detection, FollowsReflectivityIncidenceAndSpecularLoss) {
  LidarConfig config = flawless_lidar();
  config.range_at_10_percent = 8.0;
  expect_detection(config, 0.3);
  expect_detection(config, 0.05);
  config.specular_loss = 1.0;
  expect_detection(config, 0.3);
}

TEST(Detection, SpecularLossTakesGrazingReturnsFirst) {
  const ClosedRoom room{.reflectivity = 0.3};
  const RayCaster caster(room.scene());
  LidarConfig config = flawless_lidar();
  config.range_at_10_percent = 8.0;
  const auto returns = [&](double loss) {
    config.specular_loss = loss;
    Lidar lidar(config, caster, 1);
    std::pair<int, int> grazing_and_facing{};
    for_each_point(room, lidar, 1, [&](const LidarPoint&, const Vector3d&, const auto& real) {
      ++(real.cosine < 0.4 ? grazing_and_facing.first : grazing_and_facing.second);
    });
    return grazing_and_facing;
  };
  const auto matt = returns(0.0);
  const auto smooth = returns(1.0);
  EXPECT_LT(smooth.first, 0.9 * matt.first);
  EXPECT_GT(smooth.second, 0.9 * matt.second);
}

TEST(Intensity, IsReflectivityTimesCosineWithNoiseAndSteps) {
  const ClosedRoom room{.reflectivity = 0.6};
  const RayCaster caster(room.scene());
  LidarConfig config = flawless_lidar();
  config.intensity_resolution = 0.01;
  Lidar stepped(config, caster, 1);
  std::set<float> values;
  for_each_point(room, stepped, 1, [&](const LidarPoint& point, const Vector3d&, const auto& real) {
    ASSERT_NEAR(point.intensity, 0.6 * real.cosine, 0.005 + 1e-5);
    values.insert(point.intensity);
  });
  EXPECT_LE(values.size(), 61U);
  config.intensity_resolution = 0.0;
  config.intensity_sigma = 0.05;
  Lidar noisy(config, caster, 1);
  Spread relative;
  for_each_point(room, noisy, 1, [&](const LidarPoint& point, const Vector3d&, const auto& real) {
    relative.add(point.intensity / (0.6 * real.cosine));
  });
  EXPECT_NEAR(relative.mean(), 1.0, 4.0 * 0.05 / std::sqrt(relative.count));
  EXPECT_NEAR(relative.std(), 0.05, 4.0 * 0.05 / std::sqrt(2.0 * relative.count));
}

TEST(ScanTruth, HoldsTheNoiseOfEveryRange) {
  const ClosedRoom room;
  const RayCaster caster(room.scene());
  LidarConfig config = flawless_lidar();
  config.range_sigma = 0.01;
  ScanTruth plain;
  Lidar(config, caster, 1).scan(0, room.poses(), &plain);
  EXPECT_TRUE(plain.range_sigmas.empty());
  config.range_sigma_at_threshold = 0.03;
  config.range_at_10_percent = 20.0;
  config.range_resolution = 0.01;
  ScanTruth truth;
  Lidar lidar(config, caster, 1);
  const LidarScan scan = lidar.scan(0, room.poses(), &truth);
  ASSERT_EQ(truth.range_sigmas.size(), scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const auto real = room.along(scan.points[i].position.cast<double>().normalized());
    const double power = 5.0 * real.cosine * std::pow(20.0 / real.range, 2);
    ASSERT_NEAR(truth.range_sigmas[i], std::sqrt(1e-4 + 9e-4 / power + 1e-4 / 12.0), 1e-5);
  }
}

}  // namespace
}  // namespace aims
