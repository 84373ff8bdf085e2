// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/robot_calibration.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "bench/metrics/statistics.hpp"
#include "core/files/text_file.hpp"
#include "estimator/aims/robot_prior.hpp"
#include "estimator/legs/joint_compliance.hpp"

namespace aims {
namespace {

/// Recordings disagree where chance alone makes their chi-square in 1 % of the cases.
constexpr double kAgreement = 0.99;
/// An entry is observable when the data halve its deviation at least.
constexpr double kHalved = 0.5;
/// A compliance so many deviations of its prior away from it is that of soft joints.
constexpr double kSoft = 2.0;
/// Keeps directions without information solvable: a part of the prior's.
constexpr double kRidge = 1e-9;

Eigen::VectorXd precision_of(const LearnedQuantity& quantity) {
  return quantity.prior_sigma.cwiseAbs2().cwiseInverse();
}

/// The information with a trace of the prior.
Eigen::MatrixXd solvable(const LearnedQuantity& quantity) {
  Eigen::MatrixXd information = quantity.information;
  information.diagonal() += kRidge * precision_of(quantity);
  return information;
}

/// The sum of their information; all else as the first has it.
LearnedQuantity sum_of(std::span<const LearnedQuantity> quantities) {
  LearnedQuantity sum = quantities.front();
  for (const LearnedQuantity& each : quantities.subspan(1)) {
    sum.information += each.information;
    sum.vector += each.vector;
  }
  return sum;
}

void judge(CalibratedQuantity& result, const Gaussian& found) {
  const std::vector<double> numbers = numbers_of(found);
  const auto size = found.mean.size();
  result.values.assign(numbers.begin(), numbers.begin() + size);
  result.covariance.assign(numbers.begin() + size, numbers.end());
  for (Eigen::Index i = 0; i < size; ++i) {
    const double sigma = std::sqrt(found.covariance(i, i));
    const bool observable = sigma <= kHalved * result.prior_sigma[static_cast<std::size_t>(i)];
    result.sigma.push_back(sigma);
    result.verdict.emplace_back(observable ? kObservable : kNotObservable);
  }
  const bool any = std::ranges::count(result.verdict, kObservable) > 0;
  const bool prior = std::ranges::find(kPriorQuantities, result.name, &PriorQuantity::name) !=
                     kPriorQuantities.end();
  const std::string odd = implausible(result.name, result.values);
  result.used = any && prior && odd.empty();
  if (!odd.empty()) result.note = "not used: " + odd;
  if (!prior) result.note = "stated only: estimators do not start from it";
}

/// How far the runs lie from their common mean, and what that does to their sum.
void weigh_disagreement(std::span<const LearnedQuantity> runs, LearnedQuantity& sum,
                        CalibratedQuantity& result) {
  const Eigen::VectorXd mean = solvable(sum).ldlt().solve(sum.vector);
  for (const LearnedQuantity& each : runs) {
    const Eigen::VectorXd apart = each.vector - each.information * mean;
    result.chi_square += apart.dot(solvable(each).ldlt().solve(apart));
  }
  const Eigen::VectorXd sigma = posterior_of(sum).covariance.diagonal().cwiseSqrt();
  const auto seen = (sigma.array() <= kHalved * sum.prior_sigma.array()).count();
  result.degrees_of_freedom = static_cast<int>((static_cast<long>(runs.size()) - 1) * seen);
  if (result.degrees_of_freedom == 0) return;
  const double limit = chi_square_quantile(kAgreement, result.degrees_of_freedom);
  if (result.chi_square <= limit) return;
  result.inflation = result.chi_square / result.degrees_of_freedom;
  result.note = fmt::format(
      "the recordings disagree: chi-square {:.1f} of {} degrees of freedom; "
      "the covariance is inflated {:.1f} times",
      result.chi_square, result.degrees_of_freedom, result.inflation);
  sum.information /= result.inflation;
  sum.vector /= result.inflation;
}

/// Mean over runs with the spread of a further one.
Gaussian spread_of(std::span<const LearnedQuantity> runs) {
  const auto size = runs.front().prior.size();
  const auto count = static_cast<double>(runs.size());
  Gaussian found{Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  for (const LearnedQuantity& each : runs) found.mean += posterior_of(each).mean / count;
  for (const LearnedQuantity& each : runs) {
    const Gaussian one = posterior_of(each);
    const Eigen::VectorXd apart = one.mean - found.mean;
    found.covariance += one.covariance / count;
    found.covariance.diagonal() += apart.cwiseAbs2() * (1.0 + 1.0 / count) / (count - 1.0);
  }
  return found;
}

CalibratedQuantity calibrated(std::span<const LearnedQuantity> runs) {
  const LearnedQuantity& first = runs.front();
  CalibratedQuantity result;
  result.name = first.name;
  result.entries = first.entries;
  result.prior_sigma.assign(first.prior_sigma.begin(), first.prior_sigma.end());
  LearnedQuantity sum = sum_of(runs);
  if (!first.varies_by_run) {
    weigh_disagreement(runs, sum, result);
    judge(result, posterior_of(sum));
    return result;
  }
  const bool enough = static_cast<int>(runs.size()) >= kRunsOfVarying;
  judge(result, runs.size() > 1 ? spread_of(runs) : posterior_of(first));
  if (enough) return result;
  result.used = false;
  result.note = fmt::format("varies from run to run: known from {} recordings on", kRunsOfVarying);
  return result;
}

/// On soft joints the scale of the legs is that of the place, however well the compliance is known.
void leave_out_soft_legs(std::vector<CalibratedQuantity>& quantities) {
  const auto joints = std::ranges::find(quantities, "joint_compliance", &CalibratedQuantity::name);
  const auto legs = std::ranges::find(quantities, "legs_by_feet", &CalibratedQuantity::name);
  if (joints == quantities.end() || legs == quantities.end() || !legs->used) return;
  const double beyond = joints->values.front() - JointCompliance::kPrior;
  if (beyond < kSoft * joints->prior_sigma.front()) return;
  legs->used = false;
  legs->note =
      fmt::format("not used: the joints are soft ({:.2f} rad/m), and how much depends on the place",
                  joints->values.front());
}

}  // namespace

RobotCalibration combined(std::span<const CalibrationRun> runs, const std::string& estimator) {
  RobotCalibration calibration;
  calibration.estimator = estimator;
  calibration.sensors = runs.front().sensors;
  for (const CalibrationRun& run : runs) calibration.recordings.push_back(run.name);
  std::vector<std::string> done;
  for (const CalibrationRun& run : runs) {
    for (const LearnedQuantity& quantity : run.learned) {
      if (std::ranges::find(done, quantity.name) != done.end()) continue;
      done.push_back(quantity.name);
      std::vector<LearnedQuantity> all;
      for (const CalibrationRun& each : runs) {
        const auto same = std::ranges::find(each.learned, quantity.name, &LearnedQuantity::name);
        if (same != each.learned.end()) all.push_back(*same);
      }
      calibration.quantities.push_back(calibrated(all));
    }
  }
  leave_out_soft_legs(calibration.quantities);
  return calibration;
}

Result<void> check_one_robot(std::span<const CalibrationRun> runs) {
  for (const CalibrationRun& run : runs) {
    const auto differences = body_misfits(runs.front().sensors, run.sensors);
    if (differences.empty()) continue;
    return failure(fmt::format("{} is not of the robot of {}: {}; expected recordings of one robot",
                               run.name, runs.front().name, fmt::join(differences, ", ")));
  }
  return {};
}

std::vector<std::string> warnings_of(const RobotCalibration& calibration,
                                     std::span<const CalibrationRun> runs) {
  std::vector<std::string> warnings;
  for (const CalibrationRun& run : runs.subspan(1)) {
    const auto differences = misfits(calibration.sensors, run.sensors);
    if (differences.empty()) continue;
    warnings.push_back(fmt::format("{} differs from {}: {}", run.name, runs.front().name,
                                   fmt::join(differences, ", ")));
  }
  for (const CalibratedQuantity& each : calibration.quantities) {
    const bool odd = !implausible(each.name, each.values).empty();
    if (odd || (each.used && each.inflation > 1.0)) {
      warnings.push_back(each.name + ": " + each.note);
    }
  }
  if (std::ranges::count(calibration.quantities, true, &CalibratedQuantity::used) == 0) {
    warnings.emplace_back(
        "nothing of the robot was learned: estimators do not start from this calibration. Record a "
        "walk in a place with features, with LiDAR, IMU and legs");
  }
  return warnings;
}

bool is_recorded_table(const std::filesystem::path& file) {
  constexpr std::size_t kMost = std::size_t{1} << 20;
  const auto text = read_text_file(file, kMost);
  return text && (text->starts_with("file:") || text->find("\nfile:") != std::string::npos);
}

}  // namespace aims
