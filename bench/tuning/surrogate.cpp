// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/surrogate.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "core/random.hpp"

namespace aims {
namespace {

using Degrees = std::vector<int>;

constexpr int kMaxDegree = 10;
constexpr int kMaxInputs = 3;
constexpr double kHyperbolic = 0.75;
constexpr std::size_t kMaxTerms = 1500;
constexpr int kFolds = 10;
constexpr Eigen::Index kLeastPoints = 8;
constexpr int kReplicates = 200;
constexpr double kBeyond = 0.05;

/// Legendre polynomials up to `kMaxDegree`, orthonormal over [0, 1], at u.
std::array<double, kMaxDegree + 1> legendre(double u) {
  std::array<double, kMaxDegree + 1> values{};
  const double x = 2.0 * u - 1.0;
  values[0] = 1.0;
  values[1] = x;
  for (int n = 1; n < kMaxDegree; ++n) {
    const auto i = static_cast<std::size_t>(n);
    values[i + 1] = ((2 * n + 1) * x * values[i] - n * values[i - 1]) / (n + 1);
  }
  for (int n = 0; n <= kMaxDegree; ++n) values[static_cast<std::size_t>(n)] *= std::sqrt(2 * n + 1);
  return values;
}

/// The term's degree, by which products count more than powers.
double norm_of(const Degrees& term) {
  double sum = 0.0;
  for (const int degree : term) sum += std::pow(degree, kHyperbolic);
  return std::pow(sum, 1.0 / kHyperbolic);
}

void add_terms(std::size_t input, int inputs_left, Degrees& term, int max_degree,
               std::vector<Degrees>& terms) {
  if (input == term.size()) {
    terms.push_back(term);
    return;
  }
  for (int degree = 0; degree <= (inputs_left > 0 ? max_degree : 0); ++degree) {
    term[input] = degree;
    if (norm_of(term) > max_degree + 1e-9) break;
    add_terms(input + 1, inputs_left - (degree > 0 ? 1 : 0), term, max_degree, terms);
  }
  term[input] = 0;
}

/// Highest degree that the points determine in each input: below the number of its levels.
Degrees degrees_in(const Eigen::MatrixXd& points) {
  Degrees most;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const std::set<double> levels(points.col(i).begin(), points.col(i).end());
    most.push_back(static_cast<int>(std::min<std::size_t>(kMaxDegree, levels.size() - 1)));
  }
  return most;
}

/// Every term that may enter, the constant first; a lower degree where there would be too many.
std::vector<Degrees> candidate_terms(const Eigen::MatrixXd& points) {
  const auto inputs = static_cast<std::size_t>(points.cols());
  const Degrees most = degrees_in(points);
  std::vector<Degrees> terms;
  for (int degree = kMaxDegree; degree >= 1; --degree) {
    terms.clear();
    Degrees term(inputs, 0);
    add_terms(0, kMaxInputs, term, degree, terms);
    std::erase_if(terms, [&](const Degrees& each) {
      return !std::equal(each.begin(), each.end(), most.begin(), std::less_equal<>());
    });
    if (terms.size() <= kMaxTerms) break;
  }
  return terms;
}

/// A column per term, a row per point.
Eigen::MatrixXd design_matrix(const std::vector<Degrees>& terms, const Eigen::MatrixXd& points) {
  Eigen::MatrixXd matrix(points.rows(), static_cast<Eigen::Index>(terms.size()));
  std::vector<std::array<double, kMaxDegree + 1>> basis(static_cast<std::size_t>(points.cols()));
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    for (std::size_t i = 0; i < basis.size(); ++i) {
      basis[i] = legendre(points(row, static_cast<Eigen::Index>(i)));
    }
    for (std::size_t k = 0; k < terms.size(); ++k) {
      double product = 1.0;
      for (std::size_t i = 0; i < basis.size(); ++i) {
        product *= basis[i][static_cast<std::size_t>(terms[k][i])];
      }
      matrix(row, static_cast<Eigen::Index>(k)) = product;
    }
  }
  return matrix;
}

/// The column of `left` (orthogonal to all chosen ones) that explains most of `residual`; -1: none.
Eigen::Index best_column(const Eigen::MatrixXd& left, const Eigen::VectorXd& size,
                         const Eigen::VectorXd& residual) {
  Eigen::Index best = -1;
  double most = 0.0;
  for (Eigen::Index k = 0; k < left.cols(); ++k) {
    const double squared = left.col(k).squaredNorm();
    if (squared < 1e-8 * size(k))
      continue;  // a linear combination of the chosen ones at the points
    const double part = left.col(k).dot(residual);
    if (part * part / squared > most) {
      most = part * part / squared;
      best = k;
    }
  }
  return best;
}

/// Which columns to use: as many as give the least leave-one-out error, where each more costs a
/// little, since the columns were chosen by the same data (Chapelle et al. 2002, its first factor).
std::vector<Eigen::Index> chosen_columns(const Eigen::MatrixXd& matrix,
                                         const Eigen::VectorXd& values) {
  const auto rows = matrix.rows();
  Eigen::MatrixXd left = matrix;
  const Eigen::VectorXd size = matrix.colwise().squaredNorm().transpose();
  Eigen::VectorXd residual = values;
  Eigen::VectorXd leverage = Eigen::VectorXd::Zero(rows);
  std::vector<Eigen::Index> order;
  std::size_t best_count = 1;
  double best_error = std::numeric_limits<double>::infinity();
  Eigen::Index next = 0;  // the constant
  while (next >= 0 && static_cast<Eigen::Index>(order.size()) < (rows * 2) / 3) {
    const Eigen::VectorXd direction = left.col(next).normalized();
    order.push_back(next);
    residual -= direction * direction.dot(residual);
    leverage += direction.cwiseAbs2();
    left -= direction * (direction.transpose() * left);
    const Eigen::ArrayXd open = (1.0 - leverage.array()).max(1e-6);
    const double count = static_cast<double>(order.size());
    const double factor = static_cast<double>(rows) / std::max(1.0, double(rows) - 2.0 * count);
    const double error = (residual.array() / open).square().mean() * factor;
    if (error < best_error) {
      best_error = error;
      best_count = order.size();
    }
    const bool hopeless = order.size() > best_count + 10 || residual.norm() < 1e-10 * values.norm();
    next = hopeless ? -1 : best_column(left, size, residual);
  }
  order.resize(best_count);
  return order;
}

Eigen::MatrixXd columns_of(const Eigen::MatrixXd& matrix, const std::vector<Eigen::Index>& chosen) {
  return matrix(Eigen::all, chosen);
}

Eigen::VectorXd solve(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values) {
  return matrix.colPivHouseholderQr().solve(values);
}

SobolIndices indices_of(const std::vector<Degrees>& terms, const Eigen::VectorXd& coefficients,
                        std::size_t inputs) {
  SobolIndices indices;
  indices.first.assign(inputs, 0.0);
  indices.total.assign(inputs, 0.0);
  indices.second = Eigen::MatrixXd::Zero(Eigen::Index(inputs), Eigen::Index(inputs));
  double variance = 0.0;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    std::vector<std::size_t> of;
    for (std::size_t i = 0; i < inputs; ++i) {
      if (terms[k][i] > 0) of.push_back(i);
    }
    if (of.empty()) continue;
    const double part = coefficients(Eigen::Index(k)) * coefficients(Eigen::Index(k));
    variance += part;
    for (const std::size_t i : of) indices.total[i] += part;
    if (of.size() == 1) indices.first[of[0]] += part;
    if (of.size() != 2) continue;
    indices.second(Eigen::Index(of[0]), Eigen::Index(of[1])) += part;
    indices.second(Eigen::Index(of[1]), Eigen::Index(of[0])) += part;
  }
  if (variance <= 0.0) return indices;
  for (double& index : indices.first) index /= variance;
  for (double& index : indices.total) index /= variance;
  indices.second /= variance;
  return indices;
}

/// Squared errors at points of folds that the fit did not see, term selection included.
double cross_validated(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values) {
  const Eigen::Index rows = matrix.rows();
  std::vector<Eigen::Index> order(static_cast<std::size_t>(rows));
  std::iota(order.begin(), order.end(), 0);
  RandomStream stream = rng(0, "sweep.folds");
  for (std::size_t k = order.size(); k > 1; --k) {
    std::swap(order[k - 1], order[static_cast<std::size_t>(stream.uniform() * double(k))]);
  }
  double sum = 0.0;
  for (int fold = 0; fold < kFolds; ++fold) {
    std::vector<Eigen::Index> in;
    std::vector<Eigen::Index> out;
    for (std::size_t k = 0; k < order.size(); ++k) {
      (static_cast<int>(k) % kFolds == fold ? out : in).push_back(order[k]);
    }
    if (out.empty()) continue;
    const Eigen::MatrixXd known = matrix(in, Eigen::all);
    const Eigen::VectorXd known_values = values(in);
    const auto chosen = chosen_columns(known, known_values);
    const Eigen::VectorXd coefficients = solve(columns_of(known, chosen), known_values);
    const Eigen::MatrixXd unknown = matrix(out, chosen);
    sum += (unknown * coefficients - values(out)).squaredNorm();
  }
  return sum / static_cast<double>(rows);
}

/// Of the total indices, by fitting the chosen terms again to points drawn with replacement.
std::vector<Interval> total_intervals(const std::vector<Degrees>& terms,
                                      const Eigen::MatrixXd& matrix, const Eigen::VectorXd& values,
                                      std::size_t inputs) {
  std::map<std::vector<std::size_t>, std::vector<double>> known;
  std::vector<Interval> intervals;
  for (std::size_t i = 0; i < inputs; ++i) {
    const auto total = [&](std::span<const std::size_t> drawn) -> std::optional<double> {
      std::vector<std::size_t> rows(drawn.begin(), drawn.end());
      auto found = known.find(rows);
      if (found == known.end()) {
        const Eigen::MatrixXd some = matrix(rows, Eigen::all);
        const Eigen::VectorXd some_values = values(rows);
        const auto totals = indices_of(terms, solve(some, some_values), inputs).total;
        found = known.emplace(std::move(rows), totals).first;
      }
      return found->second[i];
    };
    intervals.push_back(
        bootstrap_interval(static_cast<std::size_t>(matrix.rows()), total, 1, kReplicates));
  }
  return intervals;
}

}  // namespace

Result<Surrogate> Surrogate::fit(const Eigen::MatrixXd& points, const Eigen::VectorXd& values) {
  if (points.rows() < kLeastPoints || points.cols() < 1) {
    return failure(
        fmt::format("{} points of {} parameters are too few for a surrogate; expected "
                    "at least {}",
                    points.rows(), points.cols(), kLeastPoints));
  }
  if (points.rows() != values.size()) {
    return failure(fmt::format("{} points and {} values; expected as many of both", points.rows(),
                               values.size()));
  }
  if (!points.allFinite() || !values.allFinite()) {
    return failure("a surrogate needs points and values that are finite");
  }
  const auto inputs = static_cast<std::size_t>(points.cols());
  const auto candidates = candidate_terms(points);
  const Eigen::MatrixXd matrix = design_matrix(candidates, points);
  const auto chosen = chosen_columns(matrix, values);
  const Eigen::MatrixXd used = columns_of(matrix, chosen);
  const Eigen::VectorXd coefficients = solve(used, values);
  Surrogate surrogate;
  for (const Eigen::Index k : chosen) {
    surrogate.degrees_.push_back(candidates[static_cast<std::size_t>(k)]);
  }
  surrogate.coefficients_.assign(coefficients.data(), coefficients.data() + coefficients.size());
  const Eigen::MatrixXd inverse = used.completeOrthogonalDecomposition().pseudoInverse();
  surrogate.covariance_ = inverse * inverse.transpose();
  const double squared = cross_validated(matrix, values);
  const double variance = (values.array() - values.mean()).square().mean();
  surrogate.error_ = std::sqrt(squared);
  surrogate.deviation_ = std::sqrt(variance);
  surrogate.least_ = points.colwise().minCoeff().transpose();
  surrogate.most_ = points.colwise().maxCoeff().transpose();
  const bool varies = variance > 1e-20 * values.squaredNorm();
  surrogate.explained_ = varies ? 1.0 - squared / variance : 1.0;
  surrogate.indices_ = indices_of(surrogate.degrees_, coefficients, inputs);
  surrogate.indices_.total_interval = total_intervals(surrogate.degrees_, used, values, inputs);
  return surrogate;
}

double Surrogate::at(const Eigen::VectorXd& point) const {
  const Eigen::Map<const Eigen::VectorXd> coefficients(
      coefficients_.data(), static_cast<Eigen::Index>(coefficients_.size()));
  return design_matrix(degrees_, point.transpose()).row(0).dot(coefficients);
}

double Surrogate::error_at(const Eigen::VectorXd& point) const {
  const Eigen::RowVectorXd row = design_matrix(degrees_, point.transpose());
  const double leverage = row * covariance_ * row.transpose();
  return error_ * std::sqrt(std::max(1.0, leverage));
}

bool Surrogate::extrapolates(const Eigen::VectorXd& point) const {
  const bool beyond =
      ((point - most_).array() > kBeyond).any() || ((least_ - point).array() > kBeyond).any();
  return beyond || error_at(point) > deviation_;
}

}  // namespace aims
