// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/pose_graph/factor_graph.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace aims::pose_graph {

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Adds the lower triangle of a block of J^T J.
void add_block(const Eigen::MatrixXd& block, int row, int column, Triplets& triplets) {
  for (Eigen::Index j = 0; j < block.cols(); ++j) {
    for (Eigen::Index i = 0; i < block.rows(); ++i) {
      const int r = row + static_cast<int>(i);
      const int c = column + static_cast<int>(j);
      if (r >= c) triplets.emplace_back(r, c, block(i, j));
    }
  }
}

}  // namespace

int dimension_of(const Value& value) {
  return std::holds_alternative<Eigen::Vector3d>(value) ? 3 : 6;
}

Value moved(const Value& value, const Eigen::VectorXd& step) {
  if (const auto* pose = std::get_if<Pose>(&value)) {
    return Pose{(pose->rotation * so3_exp(step.head<3>())).normalized(),
                pose->translation + pose->rotation * step.tail<3>()};
  }
  if (const auto* bias = std::get_if<ImuBias>(&value)) {
    return ImuBias{bias->accelerometer + step.head<3>(), bias->gyro + step.tail<3>()};
  }
  return Eigen::Vector3d(std::get<Eigen::Vector3d>(value) + step);
}

int FactorGraph::add_variable(Value initial) {
  const int size = dimension_of(initial);
  variables_.push_back({std::move(initial), Eigen::VectorXd::Zero(size), dimension_});
  dimension_ += size;
  return variables() - 1;
}

void FactorGraph::add_factor(Factor factor) { factors_.push_back({std::move(factor), {}}); }

/// Whether any linearization point is new.
bool FactorGraph::move_points() {
  bool any = false;
  for (Variable& variable : variables_) {
    if (variable.step.lpNorm<Eigen::Infinity>() >= threshold_) {
      variable.point = moved(variable.point, variable.step);
      variable.step.setZero();
      variable.changed = true;
    }
    any = any || variable.changed;
  }
  return any;
}

/// Linearizes the factors that are new or have a variable with a new point; whether there are any.
bool FactorGraph::linearize() {
  bool any = false;
  std::vector<Value> values;
  for (LinearizedFactor& each : factors_) {
    const std::vector<int>& keys = each.factor.variables;
    const bool stale =
        std::any_of(keys.begin(), keys.end(), [this](int key) { return variables_[key].changed; });
    if (each.valid && !stale) continue;
    values.clear();
    for (const int key : keys) values.push_back(variables_[key].point);
    each.whitened = each.factor.model(values);
    each.whitened.residual = (each.factor.sqrt_information * each.whitened.residual).eval();
    for (Eigen::MatrixXd& jacobian : each.whitened.jacobians) {
      jacobian = (each.factor.sqrt_information * jacobian).eval();
    }
    each.valid = true;
    any = true;
  }
  for (Variable& variable : variables_) variable.changed = false;
  return any;
}

/// Normal equations of all steps.
bool FactorGraph::solve() {
  Triplets triplets;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(dimension_);
  for (const LinearizedFactor& each : factors_) {
    const std::vector<int>& keys = each.factor.variables;
    for (std::size_t a = 0; a < keys.size(); ++a) {
      const Eigen::MatrixXd& A = each.whitened.jacobians[a];
      const int row = variables_[keys[a]].offset;
      right.segment(row, A.cols()) -= A.transpose() * each.whitened.residual;
      for (std::size_t b = 0; b < keys.size(); ++b) {
        const int column = variables_[keys[b]].offset;
        if (row < column) continue;
        add_block(A.transpose() * each.whitened.jacobians[b], row, column, triplets);
      }
    }
  }
  Eigen::SparseMatrix<double> information(dimension_, dimension_);
  information.setFromTriplets(triplets.begin(), triplets.end());
  cholesky_.compute(information);
  if (cholesky_.info() != Eigen::Success || !(cholesky_.vectorD().array() > 0.0).all())
    return false;
  const Eigen::VectorXd steps = cholesky_.solve(right);
  if (!steps.allFinite()) return false;
  for (Variable& variable : variables_) {
    variable.step = steps.segment(variable.offset, variable.step.size());
  }
  return true;
}

bool FactorGraph::update() {
  const bool moved = move_points();
  const bool linearized = linearize();
  return !(moved || linearized) || solve();
}

Value FactorGraph::estimate(int variable) const {
  return moved(variables_[variable].point, variables_[variable].step);
}

std::optional<Eigen::MatrixXd> FactorGraph::marginal_covariance(int variable) const {
  const Variable& wanted = variables_[variable];
  const auto size = static_cast<int>(wanted.step.size());
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(dimension_, size);
  unit.middleRows(wanted.offset, size).setIdentity();
  const Eigen::MatrixXd columns = cholesky_.solve(unit);
  const Eigen::MatrixXd block = columns.middleRows(wanted.offset, size);
  if (!block.allFinite()) return std::nullopt;
  return Eigen::MatrixXd(0.5 * (block + block.transpose()));
}

Eigen::MatrixXd sqrt_information_of_sigmas(const Eigen::VectorXd& sigmas) {
  return sigmas.cwiseInverse().asDiagonal();
}

std::optional<Eigen::MatrixXd> sqrt_information_of(const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd W =
      cholesky.matrixL().solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
  if (!W.allFinite()) return std::nullopt;
  return W;
}

}  // namespace aims::pose_graph
