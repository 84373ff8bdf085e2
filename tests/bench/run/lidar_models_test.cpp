// SPDX-License-Identifier: BSD-3-Clause
// The LiDAR models against what their makers publish.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "bench/run/estimator_fit.hpp"
#include "bench/scenario/model_sheets.hpp"
#include "bench/scenario/scenario.hpp"
#include "core/angle.hpp"
#include "core/lie.hpp"
#include "sim/sensors/scan_pattern.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

/// What a maker publishes of a sensor.
struct Published {
  std::string name;
  int lines;
  double points_per_second;
  double lowest_deg, highest_deg;
  double range_max;
  double azimuth_step_deg;  ///< between columns; 0: no rings
};

const std::vector<Published> kPublished = {
    {"generic", 16, 288e3, -15.0, 15.0, 100.0, 0.2},
    {"vlp16", 16, 300e3, -15.0, 15.0, 100.0, 0.2},
    {"vlp32c", 32, 600e3, -25.0, 15.0, 200.0, 0.2},
    {"os1_32", 32, 327'680.0, -22.5, 22.5, 120.0, 360.0 / 1024.0},
    {"os1_64", 64, 655'360.0, -22.5, 22.5, 120.0, 360.0 / 1024.0},
    {"os1_128", 128, 1'310'720.0, -22.5, 22.5, 120.0, 360.0 / 1024.0},
    {"xt32", 32, 640e3, -16.0, 15.0, 120.0, 0.18},
    {"mid360", 4, 200e3, -7.0, 52.0, 70.0, 0.0},
};

class LidarModels : public ::testing::Test {
 protected:
  Result<Scenario> load(const std::vector<std::string>& settings,
                        const std::string& yaml = "seed: 1") const {
    std::ofstream(folder_.path() / "s.yaml") << yaml;
    return load_scenario(folder_.path() / "s.yaml", settings);
  }
  LidarConfig lidar(const std::vector<std::string>& settings) const {
    const auto scenario = load(settings);
    EXPECT_TRUE(scenario) << scenario.error().message;
    return scenario ? scenario->simulation.lidar : LidarConfig();
  }
  LidarConfig model(const std::string& name) const { return lidar({"lidar.model=" + name}); }
  std::string error_of(const std::vector<std::string>& settings,
                       const std::string& yaml = "seed: 1") const {
    const auto scenario = load(settings, yaml);
    return scenario ? "" : scenario.error().message;
  }
  TemporaryFolder folder_;
};

/// Firings of the first second.
std::vector<Firing> first_second(const LidarConfig& config) {
  const ScanPattern pattern(config);
  std::vector<Firing> all;
  for (std::int64_t scan = 0; scan < std::llround(config.rate); ++scan) {
    const auto firings = pattern.firings(scan);
    all.insert(all.end(), firings.begin(), firings.end());
  }
  return all;
}

/// Elevations of the rings, the lowest first [deg].
std::vector<double> elevations(const LidarConfig& config) {
  const ScanPattern pattern(config);
  std::vector<double> all;
  for (int ring = 0; ring < pattern.lines(); ++ring) {
    all.push_back(pattern.firing(0, 0, ring).beam.elevation / kRadiansPerDegree);
  }
  return all;
}

TEST_F(LidarModels, AreThosePublished) {
  std::vector<std::string> names;
  for (const LidarModel& each : lidar_models()) names.emplace_back(each.name);
  ASSERT_EQ(names.size(), kPublished.size());
  for (const Published& each : kPublished) {
    EXPECT_EQ(std::ranges::count(names, each.name), 1) << each.name;
  }
  EXPECT_EQ(names.front(), LidarConfig().model) << "the default";
}

TEST_F(LidarModels, HaveThePublishedFieldOfViewLinesAndPointRate) {
  for (const Published& each : kPublished) {
    SCOPED_TRACE(each.name);
    const LidarConfig config = model(each.name);
    const auto firings = first_second(config);
    EXPECT_EQ(ScanPattern(config).lines(), each.lines);
    EXPECT_NEAR(static_cast<double>(firings.size()), each.points_per_second,
                0.04 * each.points_per_second);
    EXPECT_NEAR(points_per_second(config), each.points_per_second, 0.04 * each.points_per_second);
    const auto [lowest, highest] =
        std::ranges::minmax(firings, {}, [](const Firing& f) { return f.beam.elevation; });
    EXPECT_NEAR(lowest.beam.elevation / kRadiansPerDegree, each.lowest_deg, 0.1);
    EXPECT_NEAR(highest.beam.elevation / kRadiansPerDegree, each.highest_deg, 0.1);
    EXPECT_EQ(config.range_max, each.range_max);
    std::vector<int> by_azimuth(360);
    for (const Firing& firing : firings) {
      const double turn = firing.beam.azimuth / (2.0 * std::numbers::pi);
      ++by_azimuth[static_cast<std::size_t>(360.0 * (turn - std::floor(turn))) % 360];
    }
    EXPECT_GT(std::ranges::min(by_azimuth), 0) << "360 degrees around";
  }
}

TEST_F(LidarModels, FireInOrderOfTimeAndTurnByThePublishedStep) {
  for (const Published& each : kPublished) {
    SCOPED_TRACE(each.name);
    const ScanPattern pattern(model(each.name));
    for (const std::int64_t scan : {0, 1, 1234}) {
      const auto firings = pattern.firings(scan);
      for (std::size_t i = 1; i < firings.size(); ++i) {
        ASSERT_GE(firings[i].time_offset_ns, firings[i - 1].time_offset_ns);
      }
      ASSERT_GE(firings.front().time_offset_ns, 0.0);
      ASSERT_LT(firings.back().time_offset_ns, 1e8);
    }
    if (each.azimuth_step_deg == 0.0) continue;
    const double step =
        wrap_angle(pattern.firing(3, 8, 1).beam.azimuth - pattern.firing(3, 9, 1).beam.azimuth);
    EXPECT_NEAR(step / kRadiansPerDegree, each.azimuth_step_deg, 0.002);
  }
}

TEST_F(LidarModels, Vlp16FiresItsLasersInTheOrderOfTheManual) {
  const auto firings = ScanPattern(model("vlp16")).firings(0);
  const double manual[] = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  for (int i = 0; i < 32; ++i) {
    EXPECT_NEAR(firings[i].beam.elevation / kRadiansPerDegree, manual[i % 16], 1e-9);
    EXPECT_NEAR(firings[i].time_offset_ns, 2304.0 * (i % 16) + 55'296.0 * (i / 16), 1e-6);
  }
}

TEST_F(LidarModels, Vlp32cIsDenseAtTheHorizonAndFiresPairs) {
  const auto rings = elevations(model("vlp32c"));
  std::vector<double> steps;
  for (std::size_t i = 1; i < rings.size(); ++i) steps.push_back(rings[i] - rings[i - 1]);
  EXPECT_NEAR(std::ranges::min(steps), 0.333, 0.002);
  EXPECT_EQ(std::ranges::count_if(steps, [](double step) { return step < 0.35; }), 17)
      << "from -4 to 1.667 degrees";
  EXPECT_GT(std::ranges::max(steps), 9.0) << "below -15.6 degrees";
  const auto firings = ScanPattern(model("vlp32c")).firings(0);
  std::set<long> offsets;
  for (int i = 0; i < 32; ++i) {
    EXPECT_NEAR(firings[i].time_offset_ns, 2304.0 * (i / 2), 1e-6);
    const double housing =
        std::numbers::pi - 2.0 * std::numbers::pi * firings[i].time_offset_ns / 1e8;
    offsets.insert(
        std::lround(10.0 * wrap_angle(housing - firings[i].beam.azimuth) / kRadiansPerDegree));
  }
  EXPECT_EQ(offsets, (std::set<long>{-42, -14, 14, 42}));
}

TEST_F(LidarModels, OusterRingsAreUniformAndStaggered) {
  for (const int channels : {32, 64, 128}) {
    const LidarConfig config = model("os1_" + std::to_string(channels));
    const auto rings = elevations(config);
    for (std::size_t i = 1; i < rings.size(); ++i) {
      ASSERT_NEAR(rings[i] - rings[i - 1], 45.0 / (channels - 1), 2e-4);
    }
    const ScanPattern pattern(config);
    std::set<long> azimuths;
    for (int ring = 0; ring < channels; ++ring) {
      ASSERT_EQ(pattern.delay_ns(ring), 0.0) << "one time stamp a column";
      azimuths.insert(
          std::lround(100.0 * pattern.firing(0, 0, ring).beam.azimuth / kRadiansPerDegree));
    }
    EXPECT_EQ(azimuths.size(), static_cast<std::size_t>(channels / 32)) << "columns of beams";
  }
  EXPECT_NEAR(points_per_second(lidar({"lidar.model=os1_128", "lidar.columns=2048"})), 2'621'440.0,
              1.0);
}

TEST_F(LidarModels, Xt32ChannelsAreOneDegreeApartAndFireFromTheTop) {
  const auto firings = ScanPattern(model("xt32")).firings(5);
  for (int i = 0; i < 32; ++i) {
    EXPECT_NEAR(firings[i].beam.elevation / kRadiansPerDegree, 15.0 - i, 1e-9);
    EXPECT_NEAR(firings[i].time_offset_ns, 280.0 + 1512.0 * i, 1e-6);
  }
}

/// Fraction of cells of a field of view, `cells` per degree each way, that `seconds` of firings
/// hit.
double coverage(const LidarConfig& config, double seconds, int lowest_deg, int highest_deg,
                int cells = 1) {
  const ScanPattern pattern(config);
  const int rows = (highest_deg - lowest_deg) * cells;
  const int columns = 360 * cells;
  std::vector<bool> hit(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  for (std::int64_t scan = 0; scan < std::llround(seconds * config.rate); ++scan) {
    for (const Firing& firing : pattern.firings(scan)) {
      const double above = firing.beam.elevation / kRadiansPerDegree - lowest_deg;
      const double around = wrap_angle(firing.beam.azimuth) / kRadiansPerDegree + 180.0;
      const int row = static_cast<int>(std::floor(above * cells));
      if (row < 0 || row >= rows) continue;
      const int column = std::min(static_cast<int>(around * cells), columns - 1);
      hit[static_cast<std::size_t>(row * columns + column)] = true;
    }
  }
  return static_cast<double>(std::ranges::count(hit, true)) / static_cast<double>(hit.size());
}

TEST_F(LidarModels, Mid360CoversMoreOfItsFieldTheLongerItLooks) {
  const LidarConfig config = model("mid360");
  const auto coarse = [&](double seconds) { return coverage(config, seconds, -7, 52); };
  EXPECT_NEAR(coarse(0.1), 0.625, 0.02);
  EXPECT_NEAR(coarse(0.2), 0.849, 0.02);
  EXPECT_NEAR(coarse(0.5), 0.965, 0.01);
  const auto fine = [&](double seconds) { return coverage(config, seconds, -7, 52, 4); };
  const double frame = fine(0.1);
  EXPECT_GT(frame, 0.95 * 20'000 / (1440.0 * 236.0)) << "hardly a cell twice";
  EXPECT_GT(fine(0.2), 1.9 * frame);
  EXPECT_GT(fine(1.0), 7.0 * frame);
  EXPECT_GT(fine(3.0), 11.0 * frame);
  const LidarConfig spinning = model("generic");
  EXPECT_EQ(coverage(spinning, 0.1, -15, 16), coverage(spinning, 1.0, -15, 16));
}

TEST_F(LidarModels, AStoredConfigurationRepeatsThem) {
  for (const Published& each : kPublished) {
    const auto scenario = load({"lidar.model=" + each.name, "sensors=field"});
    SCOPED_TRACE(each.name);
    ASSERT_TRUE(scenario) << scenario.error().message;
    EXPECT_TRUE(validate(scenario->simulation.lidar));
    const std::string text = effective_config(*scenario, 1);
    const auto again = load({}, text);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(effective_config(*again, 1), text);
  }
}

TEST_F(LidarModels, LevelsAddTheErrorsOfTheSensorItself) {
  for (const Published& each : kPublished) {
    SCOPED_TRACE(each.name);
    const std::string name = "lidar.model=" + each.name;
    const LidarConfig ideal = lidar({name, "sensors=ideal"});
    const LidarConfig datasheet = lidar({name, "sensors=datasheet"});
    const LidarConfig field = lidar({name, "sensors=field"});
    EXPECT_TRUE(ideal.beam.is_line());
    EXPECT_EQ(ideal.range_resolution, 0.0);
    EXPECT_EQ(ideal.direction_sigma_deg, 0.0);
    EXPECT_FALSE(datasheet.beam.is_line());
    EXPECT_GT(datasheet.range_resolution, 0.0);
    EXPECT_EQ(datasheet.calibration.range_bias_sigma, 0.0);
    EXPECT_EQ(field.range_resolution, datasheet.range_resolution);
    EXPECT_GT(field.calibration.range_bias_sigma, 0.0);
    EXPECT_GT(field.specular_loss, 0.0);
  }
  EXPECT_EQ(lidar({"lidar.model=mid360", "sensors=datasheet"}).direction_sigma_deg, 0.15);
  EXPECT_EQ(lidar({"lidar.model=xt32"}).range_resolution, 0.004) << "not that of the default";
}

TEST_F(LidarModels, TheDefaultIsGeneric) {
  EXPECT_EQ(config_text(*load({})), config_text(*load({"lidar.model=generic"})));
}

TEST_F(LidarModels, KeysOfTheScenarioLieAboveTheModel) {
  const LidarConfig set = lidar({"lidar.model=xt32", "lidar.range_max=30"});
  EXPECT_EQ(set.range_max, 30.0);
  EXPECT_EQ(set.table.elevations_deg.size(), 32U);
}

TEST_F(LidarModels, AnUnknownModelIsRefusedWithTheNearestOne) {
  const std::string error = error_of({"lidar.model=vlp61"});
  EXPECT_NE(error.find("lidar.model: 'vlp61' is not one of generic, vlp16"), std::string::npos)
      << error;
  EXPECT_NE(error.find("did you mean 'vlp16'?"), std::string::npos) << error;
  const std::string in_file = error_of({}, "lidar: {model: mid36}");
  EXPECT_NE(in_file.find("s.yaml:1:16: lidar.model: expected one of generic"), std::string::npos)
      << in_file;
  EXPECT_NE(in_file.find("did you mean 'mid360'?"), std::string::npos) << in_file;
}

TEST_F(LidarModels, ModesThatASensorLacksAreRefused) {
  EXPECT_NE(error_of({"lidar.model=os1_64", "lidar.rate=5"})
                .find("lidar.rate: expected one of 10, 20 of os1_64, got 5"),
            std::string::npos);
  EXPECT_NE(error_of({"lidar.model=os1_64", "lidar.columns=1800"})
                .find("lidar.columns: expected one of 512, 1024, 2048 of os1_64, got 1800"),
            std::string::npos);
  EXPECT_EQ(error_of({"lidar.model=os1_64", "lidar.rate=20", "lidar.columns=512"}), "");
  EXPECT_NE(error_of({}, "draw: [{key: lidar.model, values: [vlp16, xt32]}]")
                .find("'lidar.model' chooses figures below"),
            std::string::npos);
}

TEST_F(LidarModels, SettingsWithoutEffectOnASensorAreRefused) {
  const std::map<std::string, std::string> cases = {
      {"lidar.rings=32", "lidar.pattern is rosette: it has lines, no rings and no encoder"},
      {"lidar.calibration.azimuth_sigma_deg=0.1", "no rings and no encoder"},
      {"lidar.calibration.ring_range_sigma=0.01", "no rings and no encoder"},
      {"lidar.calibration.ring_elevation_sigma_deg=0.1", "no rings and no encoder"},
      {"lidar.defects.dead_ring_fraction=0.5", "no rings and no encoder"},
      {"lidar.start_azimuth_deg=0", "no rings and no encoder"}};
  for (const auto& [setting, reason] : cases) {
    const std::string error = error_of({"lidar.model=mid360", setting});
    EXPECT_NE(error.find("has no effect"), std::string::npos) << setting << ": " << error;
    EXPECT_NE(error.find(reason), std::string::npos) << error;
  }
  EXPECT_NE(
      error_of({"lidar.model=vlp16", "lidar.rings=32"}).find("elevations_deg lists the rings"),
      std::string::npos);
  EXPECT_NE(
      error_of({"lidar.model=vlp16", "lidar.columns=900"}).find("column_interval_us is fixed"),
      std::string::npos);
  EXPECT_NE(error_of({"lidar.rosette.point_rate=1e5"}).find("lidar.pattern is spinning"),
            std::string::npos);
}

TEST_F(LidarModels, EstimatorsOfRingsStateWhatTheyLack) {
  const auto notes = [&](const std::string& name, const std::string& run) {
    const auto scenario = load({"lidar.model=" + name, "run=[" + run + "]"});
    EXPECT_TRUE(scenario) << scenario.error().message;
    return scenario ? ring_notes(*scenario) : std::vector<std::string>();
  };
  EXPECT_TRUE(notes("generic", "loam, lego_loam, lins, lio_sam, aims_d").empty());
  EXPECT_TRUE(notes("vlp16", "loam, lego_loam, lins, lio_sam").empty());
  EXPECT_TRUE(notes("mid360", "aims_d, fast_lio2, leg").empty());
  const auto lines = notes("mid360", "loam, lego_loam, lins, lio_sam");
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "loam needs the ring of each point, which the LiDAR lacks");
  const auto rows = notes("os1_64", "loam, lego_loam, lio_sam");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0],
            "lego_loam has a range image of 16 rows 2 deg apart, but the LiDAR has 64 rings 0.714 "
            "deg apart: set its image.rows and image.row_angle_deg");
  EXPECT_TRUE(notes("os1_64", "fit=lego_loam+image.rows=64+image.row_angle_deg=0.714").empty());
}

}  // namespace
}  // namespace aims
