// SPDX-License-Identifier: BSD-3-Clause
#include "python/src/conversion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace aims::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The numbers of `given`, or an empty handle where they are none.
Numbers numbers_from(const py::handle& given, const char* name, const char* expected) {
  Numbers numbers = Numbers::ensure(given);
  if (!numbers) {
    PyErr_Clear();
    raise(fmt::format("{}: expected {}, got {}", name, expected,
                      py::str(given.get_type().attr("__name__")).cast<std::string>()));
  }
  return numbers;
}

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += fmt::format("{}, ", array.shape(i));
  return text + ")";
}

/// Python's trajectory class, which is written in Python.
py::object trajectory_class() { return py::module_::import("aims.trajectory").attr("Trajectory"); }

template <class Value, class Get>
py::array_t<Value> column(std::size_t size, const Get& get) {
  py::array_t<Value> array(static_cast<py::ssize_t>(size));
  auto values = array.template mutable_unchecked<1>();
  for (std::size_t i = 0; i < size; ++i) values(static_cast<py::ssize_t>(i)) = get(i);
  return array;
}

/// (N, 3, 3): NaN where a scan has none.
template <class Member>
py::array_t<double> covariances(const Diagnostics& diagnostics, Member member) {
  const auto size = static_cast<py::ssize_t>(diagnostics.scans.size());
  py::array_t<double> array(std::vector<py::ssize_t>{size, 3, 3});
  auto values = array.mutable_unchecked<3>();
  for (py::ssize_t i = 0; i < size; ++i) {
    const auto& covariance = diagnostics.scans[static_cast<std::size_t>(i)].covariance;
    for (py::ssize_t row = 0; row < 3; ++row) {
      for (py::ssize_t at = 0; at < 3; ++at) {
        values(i, row, at) = covariance ? ((*covariance).*member)(row, at)
                                        : std::numeric_limits<double>::quiet_NaN();
      }
    }
  }
  return array;
}

}  // namespace

void raise(const std::string& message) {
  PyErr_SetString(py::module_::import("aims.errors").attr("Error").ptr(), message.c_str());
  throw py::error_already_set();
}

Eigen::Vector3d vector_from(const py::handle& given, const char* name) {
  const Numbers numbers = numbers_from(given, name, "three numbers");
  if (numbers.ndim() != 1 || numbers.shape(0) != 3) {
    raise(fmt::format("{}: expected three numbers, shape (3,), got shape {}", name,
                      shape_text(numbers)));
  }
  return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

Pose pose_from(const py::handle& given, const char* name) {
  const Numbers numbers = numbers_from(given, name, "a (4, 4) matrix");
  if (numbers.ndim() != 2 || numbers.shape(0) != 4 || numbers.shape(1) != 4) {
    raise(fmt::format("{}: expected a pose as a matrix of shape (4, 4), got shape {}", name,
                      shape_text(numbers)));
  }
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int at = 0; at < 4; ++at) matrix(row, at) = numbers.at(row, at);
  }
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  const bool rigid = matrix.allFinite() && (R * R.transpose()).isIdentity(1e-3) &&
                     R.determinant() > 0.0 &&
                     matrix.row(3).isApprox(Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0), 1e-6);
  if (!rigid) {
    raise(
        fmt::format("{}: expected a rigid transform: a rotation, a translation and the last row "
                    "0, 0, 0, 1",
                    name));
  }
  return {Eigen::Quaterniond(R).normalized(), matrix.topRightCorner<3, 1>()};
}

Time stamp_from(const py::handle& given, const char* name) {
  const py::object whole = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
  if (!whole) {
    PyErr_Clear();
    raise(
        fmt::format("{}: expected whole nanoseconds (int), got {} {}; of seconds: "
                    "round(1e9 * seconds)",
                    name, py::str(given.get_type().attr("__name__")).cast<std::string>(),
                    py::str(given).cast<std::string>()));
  }
  const Time stamp = PyLong_AsLongLong(whole.ptr());
  if (stamp == -1 && PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    raise(fmt::format("{}: {} ns does not fit into 64 bit", name,
                      py::str(given).cast<std::string>()));
  }
  return stamp;
}

py::array_t<double> array_of(const Eigen::Vector3d& vector) {
  return py::array_t<double>(3, vector.data());
}

py::array_t<float> array_of(const std::vector<Eigen::Vector3f>& points) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  return py::array_t<float>(std::vector<py::ssize_t>{static_cast<py::ssize_t>(points.size()), 3},
                            reinterpret_cast<const float*>(points.data()));
}

py::array_t<double> array_of(const Pose& pose) {
  py::array_t<double> array(std::vector<py::ssize_t>{4, 4});
  auto values = array.mutable_unchecked<2>();
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.R();
  matrix.topRightCorner<3, 1>() = pose.translation;
  for (int row = 0; row < 4; ++row) {
    for (int at = 0; at < 4; ++at) values(row, at) = matrix(row, at);
  }
  return array;
}

py::object object_of(const Trajectory& trajectory) {
  const auto size = static_cast<py::ssize_t>(trajectory.size());
  py::array_t<Time> stamps(size);
  py::array_t<double> positions(std::vector<py::ssize_t>{size, 3});
  py::array_t<double> quaternions(std::vector<py::ssize_t>{size, 4});
  auto stamp = stamps.mutable_unchecked<1>();
  auto position = positions.mutable_unchecked<2>();
  auto quaternion = quaternions.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < size; ++i) {
    const StampedPose& each = trajectory[static_cast<std::size_t>(i)];
    stamp(i) = each.stamp;
    for (int axis = 0; axis < 3; ++axis) position(i, axis) = each.pose.translation[axis];
    for (int axis = 0; axis < 4; ++axis) quaternion(i, axis) = each.pose.rotation.coeffs()[axis];
  }
  return trajectory_class()(stamps, positions, quaternions);
}

Trajectory trajectory_from(const py::object& given) {
  const auto stamps = given.attr("stamps").cast<py::array_t<Time>>();
  const auto positions = given.attr("positions").cast<py::array_t<double>>();
  const auto quaternions = given.attr("quaternions").cast<py::array_t<double>>();
  Trajectory trajectory(static_cast<std::size_t>(stamps.size()));
  const auto stamp = stamps.unchecked<1>();
  const auto position = positions.unchecked<2>();
  const auto quaternion = quaternions.unchecked<2>();
  for (py::ssize_t i = 0; i < stamp.shape(0); ++i) {
    StampedPose& each = trajectory[static_cast<std::size_t>(i)];
    each.stamp = stamp(i);
    for (int axis = 0; axis < 3; ++axis) each.pose.translation[axis] = position(i, axis);
    for (int axis = 0; axis < 4; ++axis) each.pose.rotation.coeffs()[axis] = quaternion(i, axis);
  }
  return trajectory;
}

py::object object_of(const Json& json) {
  if (json.is_object()) {
    py::dict dict;
    for (const auto& [key, value] : json.items()) dict[py::str(key)] = object_of(value);
    return dict;
  }
  if (json.is_array()) {
    py::list list;
    for (const Json& each : json) list.append(object_of(each));
    return list;
  }
  if (json.is_string()) return py::str(json.get<std::string>());
  if (json.is_boolean()) return py::bool_(json.get<bool>());
  if (json.is_number_unsigned()) return py::int_(json.get<std::uint64_t>());
  if (json.is_number_integer()) return py::int_(json.get<std::int64_t>());
  if (json.is_number()) return py::float_(json.get<double>());
  return py::none();
}

py::dict series_of(const Diagnostics& diagnostics) {
  const std::vector<ScanRow>& scans = diagnostics.scans;
  py::dict series;
  series["stamp"] = column<Time>(scans.size(), [&](std::size_t i) { return scans[i].stamp; });
  for (std::size_t k = 0; k < diagnostics.series.size(); ++k) {
    series[py::str(diagnostics.series[k].name)] =
        column<double>(scans.size(), [&](std::size_t i) { return scans[i].values[k]; });
  }
  return series;
}

py::list health_of(const std::vector<HealthRow>& rows) {
  py::list list;
  for (const HealthRow& row : rows) {
    py::dict dict;
    dict["stamp"] = row.stamp;
    dict["state"] = py::str(std::string(name_of(row.state)));
    py::list reasons;
    for (const std::string& reason : row.reasons) reasons.append(reason);
    dict["reasons"] = reasons;
    dict["position_sigma"] = row.position_sigma;
    list.append(dict);
  }
  return list;
}

py::dict result_of(const EstimatorResult& result) {
  py::dict dict;
  dict["trajectory"] = object_of(result.trajectory);
  dict["optimized"] = result.optimized ? object_of(*result.optimized) : py::none();
  dict["diagnostics"] = series_of(result.diagnostics);
  py::list series;
  for (const SeriesInfo& info : result.diagnostics.series) {
    py::dict each;
    each["name"] = info.name;
    each["unit"] = info.unit;
    each["meaning"] = info.meaning;
    series.append(each);
  }
  dict["series"] = series;
  dict["position_covariances"] = covariances(result.diagnostics, &PoseCovariance::position);
  dict["rotation_covariances"] = covariances(result.diagnostics, &PoseCovariance::rotation);
  dict["health"] = health_of(result.health);
  py::dict counts;
  for (const auto& [name, count] : result.counts) counts[py::str(name)] = count;
  dict["counts"] = counts;
  return dict;
}

}  // namespace aims::python
