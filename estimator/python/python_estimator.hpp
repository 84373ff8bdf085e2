// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "estimator/interface/estimator_config.hpp"

namespace aims {

/// Beginning of the name of an estimator that is a class of a Python module: "python:module.Class".
inline constexpr std::string_view kPythonPrefix = "python:";

/// Whether `name` is that of a class in Python.
inline bool is_python_name(std::string_view name) { return name.starts_with(kPythonPrefix); }

/// Error for such a name that names no module and class.
Result<void> check_python_name(std::string_view name);

/// A value of the type that the constructor states by its default or annotation; of another type as
/// text: a Python literal, true, false, null, or the text itself.
using PythonValue = std::variant<std::string, bool, int, double>;

/// One keyword of the class's constructor.
struct PythonSetting {
  std::string key;
  std::optional<PythonValue> standard;  ///< its default
  PythonValue value;                    ///< while it has none: empty, kNoInteger or NaN
};

/// Key of the parameter that stands for the code of a class.
inline constexpr std::string_view kPythonCodeHash = "code_hash";
/// Whether a parameter of a class in Python is about how it is run, not about its estimate: the
/// limit of its calls, the hash of its code. Studies of settings leave it out.
bool is_operational(std::string_view key);

/// Wall time that one call of the class is given, unless it is set [s].
inline constexpr double kCallTimeout = 120.0;

/// An estimator that runs in a process of Python (estimator/python/worker.py). Its parameters are
/// the keywords of its constructor, the limit of its calls, and `code_hash`, which stands for its
/// code in the identity of results.
class PythonConfig final : public EstimatorConfig {
 public:
  /// Imports the class in a process of its own, within `limit_s`. Error, with Python's traceback,
  /// when that fails, for a class without any of the methods add_imu, add_legs and add_scan, and
  /// for a keyword with the name of another parameter.
  static Result<PythonConfig> load(std::string_view name, double limit_s = kCallTimeout);

  void describe(Fields& fields) override;
  Requirements requirements() const override { return {}; }
  std::unique_ptr<Estimator> create(const SensorRig& rig) const override;
  std::unique_ptr<EstimatorConfig> clone() const override;

  const std::string& name() const { return name_; }
  const std::vector<PythonSetting>& settings() const { return settings_; }
  double call_timeout() const { return call_timeout_; }
  bool has(std::string_view method) const;
  /// Error when a keyword without default has no value, or `code_hash` was set to another.
  Result<void> check() const override;

 private:
  std::string name_;
  std::vector<std::string> methods_;
  std::vector<PythonSetting> settings_;
  double call_timeout_ = kCallTimeout;
  std::string found_hash_;
  std::string code_hash_;
};

}  // namespace aims
