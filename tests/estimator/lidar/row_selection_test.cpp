// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/lidar/row_selection.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr int kWalls = 3000;
constexpr int kFace = 25;

Vector6 row(const Eigen::Vector3d& p, const Eigen::Vector3d& n) {
  Vector6 h;
  h << p.cross(n), n;
  return h;
}

/// A corridor along x, with one small face across it: its rows come last.
std::vector<Vector6> corridor(RandomStream& random) {
  std::vector<Vector6> rows;
  for (int i = 0; i < kWalls; ++i) {
    const double x = random.uniform(-20.0, 20.0);
    if (i % 3 == 0) {
      rows.push_back(row({x, random.uniform(-1.0, 1.0), -0.5}, Eigen::Vector3d::UnitZ()));
    } else {
      const double side = i % 3 == 1 ? 1.0 : -1.0;
      const Eigen::Vector3d noise = 0.005 * random.normal3();
      rows.push_back(row({x, 1.1 * side, random.uniform(-0.5, 1.5)},
                         (side * Eigen::Vector3d::UnitY() + noise).normalized()));
    }
  }
  for (int i = 0; i < kFace; ++i) {
    rows.push_back(row({8.0, 1.0, random.uniform(-0.5, 1.5)}, Eigen::Vector3d::UnitX()));
  }
  return rows;
}

/// Information about the way along the corridor when all else is unknown too.
double along(const Matrix6& A) { return 1.0 / A.inverse()(3, 3); }

TEST(RowSelection, KeepsTheFewRowsThatInformTheWeakAxis) {
  RandomStream random(1, "row_selection");
  const auto rows = corridor(random);
  std::vector<KeptRow> kept;
  select_rows(rows, 400, kept);
  EXPECT_NEAR(static_cast<double>(kept.size()), 400.0, 2.0);
  int face = 0;
  Matrix6 all = Matrix6::Zero();
  Matrix6 even = Matrix6::Zero();
  Matrix6 weighted = Matrix6::Zero();
  Matrix6 plain = Matrix6::Zero();
  for (const Vector6& h : rows) all += h * h.transpose();
  for (std::size_t i = 0; i < rows.size(); i += rows.size() / 400) {
    even += rows[i] * rows[i].transpose();
  }
  for (const KeptRow& each : kept) {
    const Vector6& h = rows[static_cast<std::size_t>(each.index)];
    face += each.index >= kWalls;
    weighted += each.weight * h * h.transpose();
    plain += h * h.transpose();
  }
  EXPECT_EQ(face, kFace);
  EXPECT_NEAR(along(weighted), along(all), 0.05 * along(all));
  EXPECT_GT(along(plain), 0.9 * along(all));
  EXPECT_LT(along(even), 0.3 * along(all));  // what even thinning would leave
}

// Whatever the axis, the weighted sum estimates the information of all rows.
TEST(RowSelection, WeightedInformationIsUnbiased) {
  Vector6 ratio = Vector6::Zero();
  constexpr int kRuns = 50;
  for (int run = 0; run < kRuns; ++run) {
    RandomStream random(static_cast<std::uint64_t>(run), "row_selection");
    const auto rows = corridor(random);
    std::vector<KeptRow> kept;
    select_rows(rows, 300, kept);
    Matrix6 all = Matrix6::Zero();
    Matrix6 weighted = Matrix6::Zero();
    for (const Vector6& h : rows) all += h * h.transpose();
    for (const KeptRow& each : kept) {
      const Vector6& h = rows[static_cast<std::size_t>(each.index)];
      weighted += each.weight * h * h.transpose();
    }
    ratio += weighted.diagonal().cwiseQuotient(all.diagonal()) / kRuns;
  }
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(ratio(i), 1.0, 0.03) << "axis " << i;
}

TEST(RowSelection, KeepsAllBelowTheLimit) {
  RandomStream random(1, "row_selection");
  const auto rows = corridor(random);
  std::vector<KeptRow> kept;
  select_rows(rows, 5000, kept);
  ASSERT_EQ(kept.size(), rows.size());
  EXPECT_EQ(kept.back().index, kWalls + kFace - 1);
  EXPECT_EQ(kept.back().weight, 1.0);
}

TEST(RowSelection, IsRepeatable) {
  RandomStream random(1, "row_selection");
  const auto rows = corridor(random);
  std::vector<KeptRow> first;
  std::vector<KeptRow> second;
  select_rows(rows, 400, first);
  select_rows(rows, 400, second);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].index, second[i].index);
}

}  // namespace
}  // namespace aims
