// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <functional>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "core/lie.hpp"

namespace aims::pose_graph {

/// Biases of the IMU.
struct ImuBias {
  Eigen::Vector3d accelerometer = Eigen::Vector3d::Zero();  ///< [m/s^2]
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();           ///< [rad/s]
};

/// What a variable of a graph stands for: a pose, a velocity or the biases.
using Value = std::variant<Pose, Eigen::Vector3d, ImuBias>;

/// Entries of a step of the value.
int dimension_of(const Value& value);

/// The value after a step. Pose: R Exp(first three), p + R (last three). Biases: accelerometer
/// first.
Value moved(const Value& value, const Eigen::VectorXd& step);

/// A residual and its derivative in a step of each variable.
struct Linearization {
  Eigen::VectorXd residual;
  std::vector<Eigen::MatrixXd> jacobians;
};

/// A residual of some variables, linearized at their values. It counts as |W r|^2.
struct Factor {
  std::vector<int> variables;
  Eigen::MatrixXd sqrt_information;  ///< W
  std::function<Linearization(std::span<const Value>)> model;
};

/// Nonlinear least squares over variables and factors that arrive one after the other, solved as
/// iSAM2 does (Kaess, Johannsson, Roberts, Ila, Leonard and Dellaert, IJRR 2012): each update
/// solves the linearized problem once, and a variable gets a new linearization point only when its
/// step has grown to a threshold. Here every update solves all of it, by sparse Cholesky
/// factorization.
class FactorGraph {
 public:
  /// `relinearize_threshold`: greatest entry of a step [rad, m, m/s, ...].
  explicit FactorGraph(double relinearize_threshold) : threshold_(relinearize_threshold) {}

  /// Adds a variable at its linearization point; returns its index.
  int add_variable(Value initial);
  void add_factor(Factor factor);

  /// Relinearizes variables that have moved far, then solves with everything added. False when the
  /// problem has no unique finite solution; the graph is of no use then.
  bool update();

  /// Linearization point and step of a variable together.
  Value estimate(int variable) const;

  /// Covariance of a variable's step at the last update; empty when there is none.
  std::optional<Eigen::MatrixXd> marginal_covariance(int variable) const;

  int variables() const { return static_cast<int>(variables_.size()); }

 private:
  struct Variable {
    Value point;           ///< of linearization
    Eigen::VectorXd step;  ///< solution relative to it
    int offset = 0;        ///< of its first entry among all
    bool changed = true;   ///< the point is new since the last update
  };
  struct LinearizedFactor {
    Factor factor;
    Linearization whitened;
    bool valid = false;
  };

  bool move_points();
  bool linearize();
  bool solve();

  double threshold_;
  int dimension_ = 0;
  std::vector<Variable> variables_;
  std::vector<LinearizedFactor> factors_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky_;
};

/// W of independent entries with these standard deviations.
Eigen::MatrixXd sqrt_information_of_sigmas(const Eigen::VectorXd& sigmas);

/// W with W^T W = covariance^-1; empty when the covariance is not positive definite.
std::optional<Eigen::MatrixXd> sqrt_information_of(const Eigen::MatrixXd& covariance);

}  // namespace aims::pose_graph
