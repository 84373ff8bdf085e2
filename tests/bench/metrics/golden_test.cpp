// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>

#include "bench/metrics/absolute_error.hpp"
#include "bench/metrics/alignment.hpp"
#include "bench/metrics/relative_error.hpp"

namespace aims {
namespace {

/// Agreement with figures made by data/make_golden.py after evo's definitions.
class Golden : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ifstream file(folder_ + "/golden.txt");
    std::string name;
    for (double value = 0.0; file >> name >> value;) golden_[name] = value;
    ASSERT_FALSE(golden_.empty());
    pairs_ = paired("");
  }

  Trajectory read(const std::string& name) const {
    std::ifstream file(folder_ + "/" + name);
    Trajectory trajectory;
    double t = 0.0;
    Eigen::Vector3d p;
    Eigen::Quaterniond q;
    while (file >> t >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z() >> q.w()) {
      trajectory.push_back({from_seconds(t), {q.normalized(), p}});
    }
    return trajectory;
  }

  std::vector<PosePair> paired(const std::string& name) const {
    return associate(read(name + "estimate.tum"), read(name + "truth.tum"), Association::kNearest,
                     10 * kMillisecond);
  }

  const std::string folder_ = AIMS_GOLDEN_DIR;
  std::map<std::string, double> golden_;
  std::vector<PosePair> pairs_;
};

TEST_F(Golden, AssociationFindsTheSameNumberOfPairs) {
  EXPECT_EQ(static_cast<double>(pairs_.size()), golden_.at("pairs"));
}

TEST_F(Golden, AbsoluteErrorAgrees) {
  EXPECT_NEAR(*ate_rmse(pairs_), golden_.at("ape_raw"), 1e-9);
  EXPECT_NEAR(*ate_rmse(aligned(pairs_, align_start(pairs_))), golden_.at("ape_origin"), 1e-9);
  const Alignment se3 = align_se3(pairs_);
  EXPECT_EQ(se3.spread, PositionSpread::kFull);
  EXPECT_NEAR(*ate_rmse(aligned(pairs_, se3)), golden_.at("ape_se3"), 1e-9);
}

TEST_F(Golden, AbsoluteErrorOfAWalkThatSwaysByMillimetresAgrees) {
  const std::vector<PosePair> pairs = paired("straight_");
  ASSERT_EQ(pairs.size(), 120U);
  const Alignment se3 = align_se3(pairs);
  EXPECT_EQ(se3.spread, PositionSpread::kFull) << "evo gives a number";
  EXPECT_NEAR(*ate_rmse(aligned(pairs, se3)), golden_.at("straight_ape_se3"), 1e-9);
}

TEST_F(Golden, RelativeErrorAgrees) {
  for (const double delta : {1.0, 10.0}) {
    for (const bool from_truth : {false, true}) {
      for (const bool all : {false, true}) {
        const std::string name = "rpe_" + std::to_string(static_cast<int>(delta)) + "m_" +
                                 (from_truth ? "ref_" : "est_") + (all ? "all" : "consecutive");
        const RpeScore score = relative_pose_error(
            pairs_, {.delta = delta, .all_pairs = all, .pairs_from_truth = from_truth});
        EXPECT_EQ(score.pairs, golden_.at(name + "_pairs")) << name;
        EXPECT_NEAR(score.translation_rmse_m.value(), golden_.at(name + "_trans"), 1e-9) << name;
        EXPECT_NEAR(score.rotation_rmse_rad.value(), golden_.at(name + "_rot"), 1e-9) << name;
      }
    }
  }
}

}  // namespace
}  // namespace aims
