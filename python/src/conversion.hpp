// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <utility>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "core/error.hpp"
#include "core/measurements.hpp"
#include "core/trajectory.hpp"
#include "estimator/interface/diagnostics.hpp"
#include "estimator/interface/estimator.hpp"

namespace aims::python {

namespace py = pybind11;

/// Raises `aims.Error` with that message.
[[noreturn]] void raise(const std::string& message);

/// The value, or `aims.Error` raised.
template <class Value>
Value value_or_raise(Result<Value> result) {
  if (!result) raise(result.error().message);
  if constexpr (!std::is_void_v<Value>) return std::move(*result);
}

/// The result of native work that takes long: without the interpreter's lock.
template <class Work>
auto without_lock(const Work& work) {
  const py::gil_scoped_release released;
  return work();
}

/// A vector of three numbers from anything that NumPy takes as such. `name` is for the error.
Eigen::Vector3d vector_from(const py::handle& given, const char* name);
/// A pose from a (4, 4) matrix. Error unless it is a rigid transform.
Pose pose_from(const py::handle& given, const char* name);
/// A stamp [ns]. Error for what is no whole number: seconds are not taken for nanoseconds.
Time stamp_from(const py::handle& given, const char* name);

py::array_t<double> array_of(const Eigen::Vector3d& vector);
/// (N, 3) float32, a copy.
py::array_t<float> array_of(const std::vector<Eigen::Vector3f>& points);
/// (4, 4)
py::array_t<double> array_of(const Pose& pose);
/// `aims.Trajectory`: a copy.
py::object object_of(const Trajectory& trajectory);
/// dict, list, str, float, int, bool, None.
py::object object_of(const Json& json);
/// The poses of an `aims.Trajectory`, as they are.
Trajectory trajectory_from(const py::object& given);

/// {"stamp": (N,) int64 [ns], name of a series: (N,) float64, ...}: NaN is not computed.
py::dict series_of(const Diagnostics& diagnostics);
/// A dict per row: stamp, state, reasons, position_sigma.
py::list health_of(const std::vector<HealthRow>& rows);
/// Attributes trajectory, optimized, diagnostics, series, health and counts, as a dict.
py::dict result_of(const EstimatorResult& result);

}  // namespace aims::python
