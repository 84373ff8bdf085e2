// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/sobol_indices.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <vector>

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

namespace {

/// The points as levels: 0, 1, ... of each input.
struct Levels {
  Eigen::MatrixXi of;        ///< a row per point
  std::vector<int> numbers;  ///< of levels per input
};

std::optional<Levels> levels_of(const Eigen::MatrixXd& points) {
  Levels levels;
  levels.of.resize(points.rows(), points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    std::map<double, int> known;
    for (Eigen::Index row = 0; row < points.rows(); ++row) ++known[points(row, i)];
    int number = 0;
    for (auto& [value, count] : known) {
      if (count < 2) return std::nullopt;
      count = number++;
    }
    if (number < 2) return std::nullopt;
    for (Eigen::Index row = 0; row < points.rows(); ++row) {
      levels.of(row, i) = known.at(points(row, i));
    }
    levels.numbers.push_back(number);
  }
  return levels;
}

/// An effect coding: the level's column is 1, all are -1 for the last level, so that the effects of
/// an input add up to zero.
Eigen::VectorXd coded(int level, int number) {
  Eigen::VectorXd code = Eigen::VectorXd::Zero(number - 1);
  if (level == number - 1) return -Eigen::VectorXd::Ones(number - 1);
  code(level) = 1.0;
  return code;
}

/// The columns of some effects in the design.
struct Term {
  std::vector<Eigen::Index> inputs;  ///< one, or two for a pair
  Eigen::Index begin = 0;
  Eigen::Index size = 0;
};

Eigen::VectorXd columns_of(const Term& term, const Levels& levels, const Eigen::VectorXi& point) {
  const auto code = [&](std::size_t k) {
    const Eigen::Index input = term.inputs[k];
    return coded(point(input), levels.numbers[static_cast<std::size_t>(input)]);
  };
  if (term.inputs.size() == 1) return code(0);
  const Eigen::MatrixXd product = code(0) * code(1).transpose();
  return product.reshaped();
}

std::vector<Term> terms_of(const Levels& levels, bool with_pairs) {
  std::vector<Term> terms;
  Eigen::Index at = 1;
  const auto add = [&](std::vector<Eigen::Index> inputs) {
    Eigen::Index size = 1;
    for (const Eigen::Index i : inputs) size *= levels.numbers[static_cast<std::size_t>(i)] - 1;
    terms.push_back({std::move(inputs), at, size});
    at += size;
  };
  const Eigen::Index count = levels.of.cols();
  for (Eigen::Index i = 0; i < count; ++i) add({i});
  for (Eigen::Index i = 0; with_pairs && i < count; ++i) {
    for (Eigen::Index k = i + 1; k < count; ++k) add({i, k});
  }
  return terms;
}

/// Mean square of a term over all combinations of its inputs' levels: its part of the variance.
double variance_of(const Term& term, const Levels& levels, const Eigen::VectorXd& effects) {
  Eigen::VectorXi point = Eigen::VectorXi::Zero(levels.of.cols());
  double sum = 0.0;
  double count = 0.0;
  const auto numbers = [&](std::size_t k) {
    return k < term.inputs.size() ? levels.numbers[static_cast<std::size_t>(term.inputs[k])] : 1;
  };
  for (int a = 0; a < numbers(0); ++a) {
    for (int b = 0; b < numbers(1); ++b) {
      point(term.inputs.front()) = a;
      if (term.inputs.size() > 1) point(term.inputs.back()) = b;
      const double effect =
          columns_of(term, levels, point).dot(effects.segment(term.begin, term.size));
      sum += effect * effect;
      count += 1.0;
    }
  }
  return sum / count;
}

SobolIndices indices_of(const std::vector<Term>& terms, const Levels& levels,
                        const Eigen::VectorXd& effects) {
  const Eigen::Index count = levels.of.cols();
  SobolIndices indices;
  indices.first.assign(static_cast<std::size_t>(count), 0.0);
  indices.second = Eigen::MatrixXd::Zero(count, count);
  indices.total_interval.resize(static_cast<std::size_t>(count));
  double all = 0.0;
  for (const Term& term : terms) {
    const double variance = variance_of(term, levels, effects);
    all += variance;
    const Eigen::Index i = term.inputs.front();
    const Eigen::Index k = term.inputs.back();
    if (i == k) {
      indices.first[static_cast<std::size_t>(i)] = variance;
    } else {
      indices.second(i, k) = indices.second(k, i) = variance;
    }
  }
  if (all > 0.0) {
    for (double& each : indices.first) each /= all;
    indices.second /= all;
  }
  indices.total = indices.first;
  for (Eigen::Index i = 0; i < count; ++i) {
    indices.total[static_cast<std::size_t>(i)] += indices.second.row(i).sum();
  }
  return indices;
}

std::optional<FractionalIndices> fitted(const Levels& levels, const Eigen::VectorXd& values,
                                        bool with_pairs) {
  const std::vector<Term> terms = terms_of(levels, with_pairs);
  const Eigen::Index rows = values.size();
  const Eigen::Index columns = terms.back().begin + terms.back().size;
  if (columns >= rows) return std::nullopt;
  Eigen::MatrixXd design(rows, columns);
  design.col(0).setOnes();
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Eigen::VectorXi point = levels.of.row(row).transpose();
    for (const Term& term : terms) {
      design.row(row).segment(term.begin, term.size) = columns_of(term, levels, point).transpose();
    }
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design);
  if (qr.rank() < columns) return std::nullopt;
  const Eigen::VectorXd effects = qr.solve(values);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(rows, columns);
  const Eigen::VectorXd leverage = q.rowwise().squaredNorm();
  if (leverage.maxCoeff() > 1.0 - 1e-9) return std::nullopt;  // a point that no other predicts
  const Eigen::ArrayXd left_out = (values - design * effects).array() / (1.0 - leverage.array());
  const double scatter = (values.array() - values.mean()).square().sum();
  FractionalIndices result;
  result.explained = scatter > 0.0 ? 1.0 - left_out.square().sum() / scatter : 0.0;
  result.with_pairs = with_pairs;
  result.indices = indices_of(terms, levels, effects);
  return result;
}

}  // namespace

std::optional<FractionalIndices> fractional_indices(const Eigen::MatrixXd& points,
                                                    const Eigen::VectorXd& values) {
  if (points.cols() < 1 || points.rows() < 3 || points.rows() != values.size()) {
    return std::nullopt;
  }
  const auto levels = levels_of(points);
  if (!levels) return std::nullopt;
  auto alone = fitted(*levels, values, false);
  auto pairs = points.cols() > 1 ? fitted(*levels, values, true) : std::nullopt;
  if (!alone || !pairs) return alone ? alone : pairs;
  return pairs->explained > alone->explained ? pairs : alone;
}

}  // namespace aims
