// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/fast_lio2/registration.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/estimator/baselines/fast_lio2/random_states.hpp"

namespace aims::fast_lio2 {
namespace {

constexpr unsigned kSeed = 17;
constexpr double kVariance = 1e-3;

/// Points and the planes that they lie on at `truth`.
struct Scene {
  State truth;
  std::vector<Eigen::Vector3f> points;
  std::vector<FittedPlane> planes;
};

Scene random_scene(const State& truth, int count, std::mt19937& random) {
  Scene scene{truth, {}, {}};
  for (int i = 0; i < count; ++i) {
    scene.points.push_back(test::random_vector(random, 4.0).cast<float>());
    const Eigen::Vector3f normal = test::random_vector(random, 1.0).normalized().cast<float>();
    const auto at =
        static_cast<float>(normal.cast<double>().dot(to_world(truth, scene.points.back())));
    scene.planes.push_back({normal, -at});
  }
  return scene;
}

ScanResiduals residuals_of(const Scene& scene, const State& x, bool estimate_extrinsic) {
  ScanResiduals result;
  const auto rows = static_cast<Eigen::Index>(scene.points.size());
  result.distances.resize(rows);
  result.jacobian.resize(rows, Error::kMeasured);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto row = point_residual(x, scene.points[k], scene.planes[k], estimate_extrinsic);
    // In double precision, which the row itself does not have.
    result.distances(i) = scene.planes[k].normal.cast<double>().dot(to_world(x, scene.points[k])) +
                          scene.planes[k].offset;
    result.jacobian.row(i) = row.jacobian.transpose();
  }
  return result;
}

/// Updates with the scene, and notes at which iterations points are associated.
Update update_with(const Scene& scene, const Belief& prior, const Iterations& config,
                   std::vector<bool>* searches = nullptr) {
  ScanResiduals now;
  return iterated_update(
      prior,
      [&](const State& x, bool search) -> const ScanResiduals& {
        if (searches != nullptr) searches->push_back(search);
        now = residuals_of(scene, x, config.estimate_extrinsic);
        return now;
      },
      kVariance, config);
}

TEST(FastLio2Update, FindsThePoseFromAnUncertainPrior) {
  std::mt19937 random(kSeed);
  for (int i = 0; i < 10; ++i) {
    const State truth = test::random_state(random);
    const Scene scene = random_scene(truth, 300, random);
    Belief prior;
    ErrorVector error = ErrorVector::Zero();
    error.head<6>() = test::random_error(random, 0.05).head<6>();
    prior.state = plus(truth, error);
    const Update update = update_with(scene, prior, {.max = 6});
    EXPECT_TRUE(update.converged);
    const ErrorVector left = minus(update.belief.state, truth);
    EXPECT_LT(left.head<6>().norm(), 1e-3) << "seed " << kSeed << ", case " << i;
  }
}

// A linear problem, one iteration: the textbook update in covariance form.
TEST(FastLio2Update, OneIterationIsTheKalmanUpdate) {
  std::mt19937 random(kSeed);
  const State truth = test::random_state(random);
  for (const int count : {5, 200}) {  // fewer and more rows than states
    const Scene scene = random_scene(truth, count, random);
    Belief prior{plus(truth, test::random_error(random, 1e-6)),
                 test::random_covariance(random, 0.05)};
    const ScanResiduals z = residuals_of(scene, prior.state, true);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(count, Error::kSize);
    H.leftCols<Error::kMeasured>() = z.jacobian;
    const Eigen::MatrixXd S =
        H * prior.covariance * H.transpose() + kVariance * Eigen::MatrixXd::Identity(count, count);
    const Eigen::MatrixXd K = prior.covariance * H.transpose() * S.inverse();
    const ErrorMatrix expected = prior.covariance - K * H * prior.covariance;
    const Update update =
        update_with(scene, prior, {.max = 1, .convergence = 1.0, .estimate_extrinsic = true});
    EXPECT_LT((update.belief.covariance - expected).norm(), 1e-5 * expected.norm())
        << "seed " << kSeed << ", " << count << " rows";
    const ErrorVector step = minus(update.belief.state, prior.state);
    EXPECT_LT((step + K * z.distances).norm(), 1e-6);
  }
}

/// Cost of a state: prior and residuals.
double cost(const Scene& scene, const Belief& prior, const State& x) {
  const ErrorVector moved = minus(x, prior.state);
  const Eigen::VectorXd r = residuals_of(scene, x, true).distances;
  return moved.dot(prior.covariance.inverse() * moved) + r.squaredNorm() / kVariance;
}

// The manifold's corrections of the prior: without them the iterations end elsewhere.
TEST(FastLio2Update, IterationsMinimizePriorAndResidualsTogether) {
  std::mt19937 random(kSeed);
  const State truth = test::random_state(random);
  const Scene scene = random_scene(truth, 12, random);
  Belief prior;
  // Far off in rotation, and more certain about some axes than about others.
  ErrorVector error = test::random_error(random, 0.2);
  part(error, Error::kRotation) << 0.6, -0.4, 0.5;
  prior.state = plus(truth, error);
  prior.covariance = 0.04 * ErrorMatrix::Identity() + test::random_covariance(random, 0.1);
  const Update update =
      update_with(scene, prior, {.max = 50, .convergence = 1e-9, .estimate_extrinsic = true});
  EXPECT_TRUE(update.converged);
  const double least = cost(scene, prior, update.belief.state);
  for (int k = 0; k < Error::kSize; ++k) {
    constexpr double kStep = 1e-3;
    for (const double step : {-kStep, kStep}) {
      const State other = plus(update.belief.state, step * ErrorVector::Unit(k));
      EXPECT_GE(cost(scene, prior, other), least - 1e-6) << "seed " << kSeed << ", entry " << k;
    }
  }
}

TEST(FastLio2Update, AssociatesAgainAfterASmallStepAndBeforeTheLastIteration) {
  std::mt19937 random(kSeed);
  const State truth = test::random_state(random);
  const Scene scene = random_scene(truth, 300, random);
  Belief prior;
  prior.state = truth;
  std::vector<bool> searches;
  Update update = update_with(scene, prior, {.max = 3}, &searches);
  EXPECT_EQ(searches, (std::vector<bool>{true, true}));  // two small steps end it
  EXPECT_EQ(update.iterations, 2);
  searches.clear();
  update = update_with(scene, prior, {.max = 3, .convergence = 1e-300}, &searches);
  EXPECT_EQ(searches, (std::vector<bool>{true, false, false, true}));
  EXPECT_EQ(update.iterations, 4);
  EXPECT_FALSE(update.converged);
}

TEST(FastLio2Update, WithoutResidualsTheBeliefStays) {
  const Belief prior;
  const Scene empty{State(), {}, {}};
  const Update update = update_with(empty, prior, {.max = 3});
  EXPECT_EQ(update.iterations, 0);
  EXPECT_EQ(minus(update.belief.state, prior.state).norm(), 0.0);
  EXPECT_EQ(update.belief.covariance, prior.covariance);
}

TEST(FastLio2Update, TheMountIsEstimatedOnlyOnDemand) {
  std::mt19937 random(kSeed);
  const State truth = test::random_state(random);
  const Scene scene = random_scene(truth, 300, random);
  Belief prior;
  prior.state = plus(truth, 0.02 * ErrorVector::Unit(Error::kMountTranslation));
  prior.covariance.diagonal().segment<6>(Error::kPosition).setConstant(1e-10);
  Update update = update_with(scene, prior, {.max = 10});
  EXPECT_EQ(minus(update.belief.state, prior.state)(Error::kMountTranslation), 0.0);
  update = update_with(scene, prior, {.max = 10, .estimate_extrinsic = true});
  EXPECT_NEAR(minus(update.belief.state, truth)(Error::kMountTranslation), 0.0, 1e-3);
}

}  // namespace
}  // namespace aims::fast_lio2
