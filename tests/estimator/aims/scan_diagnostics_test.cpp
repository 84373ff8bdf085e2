// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/aims/scan_diagnostics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace aims {
namespace {

TEST(ScanSeries, HaveDistinctNamesAUnitAndAMeaning) {
  std::set<std::string> names;
  for (const SeriesInfo& info : scan_series()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_FALSE(info.unit.empty()) << info.name;
    EXPECT_FALSE(info.meaning.empty()) << info.name;
  }
  EXPECT_TRUE(names.contains(std::string(kIterationsSeries)));
}

TEST(ScanSeries, HaveOneValueEachInTheirOrder) {
  ScanDiagnostics scan;
  scan.stamp = 7;
  scan.points_used = 300;
  scan.D = 0.25;
  scan.innovation_position = {1.0, 2.0, 3.0};
  scan.covariance.position = Eigen::Vector3d(4.0, 5.0, 6.0).asDiagonal();
  Diagnostics diagnostics{scan_series(), {row_of(scan)}};
  EXPECT_EQ(diagnostics.scans[0].stamp, 7);
  EXPECT_EQ(diagnostics.scans[0].values.size(), diagnostics.series.size());
  EXPECT_EQ(diagnostics.value(0, "points_used"), 300.0);
  EXPECT_EQ(diagnostics.value(0, "D"), 0.25);
  EXPECT_EQ(diagnostics.value(0, "innovation_position_y"), 2.0);
  EXPECT_EQ(diagnostics.scans[0].covariance->position(2, 2), 6.0);
  EXPECT_TRUE(std::isnan(diagnostics.value(0, "C_IL"))) << "not computed";
  EXPECT_TRUE(std::isnan(diagnostics.value(0, "no_such_series")));
  EXPECT_FALSE(diagnostics.updated(0)) << "no iterations";
}

}  // namespace
}  // namespace aims
