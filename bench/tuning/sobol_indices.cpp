// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/sobol_indices.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>

namespace aims {
namespace {

using Inputs = std::vector<Eigen::Index>;

/// What a point has in these inputs.
std::vector<double> cell_of(const Eigen::MatrixXd& points, Eigen::Index row, const Inputs& inputs) {
  std::vector<double> cell;
  for (const Eigen::Index i : inputs) cell.push_back(points(row, i));
  return cell;
}

/// Whether every combination of the inputs' levels occurs, each as often as the others.
bool is_complete_grid(const Eigen::MatrixXd& points, const Inputs& inputs) {
  double combinations = 1.0;
  for (const Eigen::Index i : inputs) {
    const std::set<double> levels(points.col(i).begin(), points.col(i).end());
    combinations *= static_cast<double>(levels.size());
  }
  std::map<std::vector<double>, std::size_t> counts;
  for (Eigen::Index row = 0; row < points.rows(); ++row) ++counts[cell_of(points, row, inputs)];
  const std::size_t count = counts.begin()->second;
  return static_cast<double>(counts.size()) == combinations && counts.size() > 1 &&
         std::all_of(counts.begin(), counts.end(),
                     [count](const auto& each) { return each.second == count; });
}

/// Variance of the means over all points that agree in these inputs.
double explained_variance(const Eigen::MatrixXd& points, const Eigen::VectorXd& values,
                          const Inputs& inputs) {
  struct Sum {
    double value = 0.0;
    double count = 0.0;
  };
  std::map<std::vector<double>, Sum> cells;
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    Sum& sum = cells[cell_of(points, row, inputs)];
    sum.value += values(row);
    sum.count += 1.0;
  }
  const double mean = values.mean();
  double variance = 0.0;
  for (const auto& [cell, sum] : cells) {
    const double difference = sum.value / sum.count - mean;
    variance += sum.count * difference * difference;
  }
  return variance / static_cast<double>(points.rows());
}

}  // namespace

std::optional<SobolIndices> grid_indices(const Eigen::MatrixXd& points,
                                         const Eigen::VectorXd& values) {
  const Eigen::Index count = points.cols();
  if (count < 1 || points.rows() < 2 || points.rows() != values.size()) return std::nullopt;
  Inputs all;
  for (Eigen::Index i = 0; i < count; ++i) all.push_back(i);
  if (!is_complete_grid(points, all)) return std::nullopt;
  SobolIndices indices;
  indices.first.assign(all.size(), 0.0);
  indices.total.assign(all.size(), 0.0);
  indices.second = Eigen::MatrixXd::Zero(count, count);
  indices.total_interval.resize(all.size());
  const double variance = explained_variance(points, values, all);
  if (!(variance > 1e-20 * values.squaredNorm())) return indices;
  for (Eigen::Index i = 0; i < count; ++i) {
    Inputs others = all;
    std::erase(others, i);
    const auto at = static_cast<std::size_t>(i);
    indices.first[at] = explained_variance(points, values, {i}) / variance;
    indices.total[at] = std::max(0.0, 1.0 - explained_variance(points, values, others) / variance);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index k = i + 1; k < count; ++k) {
      const double both = explained_variance(points, values, {i, k}) / variance;
      const double part = both - indices.first[static_cast<std::size_t>(i)] -
                          indices.first[static_cast<std::size_t>(k)];
      indices.second(i, k) = indices.second(k, i) = std::max(0.0, part);
    }
  }
  return indices;
}

}  // namespace aims
