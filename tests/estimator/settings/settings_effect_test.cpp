// SPDX-License-Identifier: BSD-3-Clause
// Every setting that an estimator offers changes its result on some short sequence, and none that
// it calls idle does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "estimator/registry.hpp"
#include "tests/estimator/settings/eventful_sequence.hpp"

namespace aims {
namespace {

using testing::RecordedStream;

/// Deliveries between two comparisons: two scans, since most settings act at once.
constexpr std::size_t kPart = 50;

void append(std::vector<double>& numbers, const Eigen::MatrixXd& matrix) {
  numbers.insert(numbers.end(), matrix.data(), matrix.data() + matrix.size());
}

/// Everything that an estimator yields, from entry `first` of its trajectory and diagnostics on.
std::vector<double> numbers_of(const EstimatorResult& result, std::size_t first) {
  std::vector<double> numbers = {static_cast<double>(result.trajectory.size())};
  for (std::size_t i = first; i < result.trajectory.size(); ++i) {
    const StampedPose& each = result.trajectory[i];
    numbers.push_back(static_cast<double>(each.stamp));
    append(numbers, each.pose.translation);
    append(numbers, each.pose.rotation.coeffs());
  }
  const std::vector<ScanRow>& scans = result.diagnostics.scans;
  for (std::size_t i = std::min(first, scans.size()); i < scans.size(); ++i) {
    numbers.insert(numbers.end(), scans[i].values.begin(), scans[i].values.end());
    if (!scans[i].covariance) continue;
    append(numbers, scans[i].covariance->position);
    append(numbers, scans[i].covariance->rotation);
  }
  for (const auto& [name, count] : result.counts) numbers.push_back(count);
  return numbers;
}

std::vector<double> numbers_of(const std::vector<Eigen::Vector3f>& points) {
  std::vector<double> numbers;
  for (const Eigen::Vector3f& point : points) append(numbers, point.cast<double>());
  return numbers;
}

/// The result of a configuration on a stream, part by part, to be compared with.
class Reference {
 public:
  Reference(const RecordedStream& stream, const EstimatorConfig& config) : stream_(stream) {
    (void)follow(config, [this](std::vector<double> numbers) {
      parts_.push_back(std::move(numbers));
      return true;
    });
  }

  /// Whether another configuration yields anything else; ends at the first difference.
  bool differs(const EstimatorConfig& config) const {
    std::size_t next = 0;
    return !follow(config, [&](const std::vector<double>& numbers) {
      return next < parts_.size() && same(numbers, parts_[next++]);
    });
  }

 private:
  /// NaN equals NaN.
  static bool same(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
      return x == y || (std::isnan(x) && std::isnan(y));
    });
  }

  /// Runs the estimator and hands over what each part of the stream yields; false: not wanted.
  template <class Take>
  bool follow(const EstimatorConfig& config, const Take& take) const {
    const auto estimator = config.create(stream_.rig);
    std::size_t known = 0;
    for (std::size_t i = 0; i < stream_.deliveries.size(); ++i) {
      estimator->consume(stream_.deliveries[i]);
      if (i % kPart != 0) continue;
      if (!take(numbers_of(estimator->result(), known))) return false;
      known = estimator->result().trajectory.size();
    }
    estimator->finish();
    return take(numbers_of(estimator->result(), 0)) && take(numbers_of(estimator->map_points()));
  }

  const RecordedStream& stream_;
  std::vector<std::vector<double>> parts_;
};

/// "one of a, b": a and b.
std::vector<std::string> options_of(const std::string& expected) {
  std::vector<std::string> options;
  std::size_t begin = std::string("one of ").size();
  while (begin < expected.size()) {
    const std::size_t end = std::min(expected.find(", ", begin), expected.size());
    options.push_back(expected.substr(begin, end - begin));
    begin = end + 2;
  }
  return options;
}

std::string times(const std::string& text, double factor, bool whole) {
  const double value = factor * std::stod(text);
  return whole ? std::to_string(std::lround(value)) : std::to_string(value);
}

/// Other values to try, first those that most likely act: a value that does not costs a whole
/// sequence. Those that the parameter does not allow are refused later.
std::vector<std::string> other_values(const Parameter& parameter) {
  const std::string text = parameter.text();
  if (parameter.kind == ParameterKind::kFlag) return {text == "true" ? "false" : "true"};
  if (parameter.kind == ParameterKind::kChoice) return options_of(parameter.expected);
  if (parameter.kind == ParameterKind::kText) return {"another"};
  const bool whole = parameter.kind == ParameterKind::kInteger;
  std::vector<std::string> values;
  const auto multiply = [&](std::initializer_list<double> factors) {
    for (const double factor : factors) {
      if (!is_sequence(parameter)) {
        values.push_back(times(text, factor, whole));
        continue;
      }
      std::vector<std::string> entries = sequence_entries(text).value();
      for (std::string& entry : entries) entry = times(entry, factor, false);
      values.push_back(sequence_text(entries));
    }
  };
  multiply({0.01, 100.0});
  for (const double bound : {parameter.spec.range.min, parameter.spec.range.max}) {
    if (!is_sequence(parameter) && std::isfinite(bound)) values.push_back(times("1", bound, whole));
  }
  multiply({0.1, 10.0, 0.5, 2.0});
  return values;
}

/// Legs that report a velocity and no joints.
RecordedStream without_joints(RecordedStream stream) {
  for (Delivery& each : stream.deliveries) {
    if (auto* legs = std::get_if<LegOdometrySample>(&each.measurement)) {
      legs->joint_position = {};
      legs->joint_velocity = {};
    }
  }
  return stream;
}

std::vector<RecordedStream> streams_with(int columns) {
  const RecordedStream stream = testing::eventful_sequence(columns);
  return {stream, testing::started_in_motion(stream), without_joints(stream)};
}

/// Returns per ring that an estimator needs: the curvature along a ring and a range image need them
/// close together.
int columns_for(EstimatorConfig& config) {
  const Fields fields = fields_of(config);
  if (const Parameter* columns = fields.find("image.columns")) return std::stoi(columns->text());
  return config.requirements().rings ? 600 : 150;
}

/// The streams for an estimator, simulated once per process.
const std::vector<RecordedStream>& streams_for(EstimatorConfig& config) {
  static std::map<int, std::vector<RecordedStream>> all;
  const int columns = columns_for(config);
  const auto [streams, is_new] = all.try_emplace(columns);
  if (is_new) streams->second = streams_with(columns);
  return streams->second;
}

/// A setting at whose default others would not act on a short sequence, and a value at which they
/// do.
struct Preparation {
  std::string estimator;
  std::string key;
  std::string value;
};

const std::vector<Preparation>& preparations() {
  static const std::vector<Preparation> all = {{"lio_sam", "mapping.loop.min_age", "4"},
                                               {"lego_loam", "mapping.loop.enabled", "true"},
                                               {"lego_loam", "mapping.loop.min_age", "4"}};
  return all;
}

std::unique_ptr<EstimatorConfig> config_of(const std::string& name) {
  auto config = EstimatorConfigs().find(name)->clone();
  const Fields fields = fields_of(*config);
  for (const Preparation& each : preparations()) {
    if (each.estimator == name) (void)fields.find(each.key)->assign(each.value);
  }
  return config;
}

/// Sets the other parameters of a group that a switch has turned on, which may need a long sequence
/// to act at their defaults, to their least values.
void shorten_group_of(const std::string& key, const Fields& fields) {
  const std::size_t dot = key.rfind('.');
  for (const Parameter& parameter : fields.parameters()) {
    if (!key.ends_with(".enabled") || parameter.key == key) continue;
    if (!parameter.key.starts_with(key.substr(0, dot + 1))) continue;
    const double least = parameter.spec.range.min;
    if (std::isfinite(least)) (void)parameter.assign(std::to_string(std::lround(least)));
  }
}

bool has_effect(const std::string& key, const std::string& name,
                const std::vector<Reference>& references) {
  const auto original = config_of(name);
  const std::string text = fields_of(*original).find(key)->text();
  for (const Reference& reference : references) {
    for (const std::string& value : other_values(*fields_of(*original).find(key))) {
      const auto changed = original->clone();
      const Fields fields = fields_of(*changed);
      const Parameter* parameter = fields.find(key);
      if (!parameter->assign(value) || parameter->text() == text) continue;
      if (reference.differs(*changed)) return true;
      if (value != "true") continue;
      shorten_group_of(key, fields);
      if (reference.differs(*changed)) return true;
    }
  }
  return false;
}

class Settings : public ::testing::TestWithParam<std::string> {};

TEST_P(Settings, ThatAreOfferedHaveAnEffect) {
  const auto config = config_of(GetParam());
  std::vector<Reference> references;
  for (const RecordedStream& stream : streams_for(*config))
    references.emplace_back(stream, *config);
  for (const Parameter& parameter : fields_of(*config).parameters()) {
    if (!parameter.idle.empty()) continue;
    EXPECT_TRUE(has_effect(parameter.key, GetParam(), references))
        << GetParam() << ": " << parameter.key << " = " << parameter.text();
  }
}

TEST_P(Settings, ThatAreIdleHaveNone) {
  const auto config = config_of(GetParam());
  for (const RecordedStream& stream : streams_for(*config)) {
    const Reference reference(stream, *config);
    for (const std::size_t attempt : {0, 1}) {
      const auto changed = config->clone();
      const Fields fields = fields_of(*changed);
      for (const Parameter& parameter : fields.parameters()) {
        if (parameter.idle.empty()) continue;
        const std::vector<std::string> values = other_values(parameter);
        (void)parameter.assign(values[std::min(attempt, values.size() - 1)]);
      }
      EXPECT_FALSE(reference.differs(*changed)) << GetParam() << ", attempt " << attempt;
    }
  }
}

/// Every system, and the one preset with another solver: the others differ in numbers alone.
std::vector<std::string> judged_estimators() {
  std::vector<std::string> names = system_names();
  names.emplace_back("a_loam");
  return names;
}

INSTANTIATE_TEST_SUITE_P(Estimators, Settings, ::testing::ValuesIn(judged_estimators()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace aims
