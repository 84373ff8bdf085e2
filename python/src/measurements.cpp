// SPDX-License-Identifier: BSD-3-Clause
#include "python/src/measurements.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <optional>

namespace aims::python {
namespace {

/// A view of one member of each point of the scan, which it keeps alive; read-only.
py::array view(const py::object& owner, const LidarScan& scan, py::dtype type, std::size_t offset,
               bool triple = false) {
  const auto size = static_cast<py::ssize_t>(scan.points.size());
  const auto stride = static_cast<py::ssize_t>(sizeof(LidarPoint));
  std::vector<py::ssize_t> shape = {size};
  std::vector<py::ssize_t> strides = {stride};
  if (triple) {
    shape.push_back(3);
    strides.push_back(sizeof(float));
  }
  const auto* data = reinterpret_cast<const std::byte*>(scan.points.data()) + offset;
  // No points, no memory: NumPy would take some of its own for a null pointer.
  const void* start = scan.points.empty() ? static_cast<const void*>(&scan) : data;
  py::array array(std::move(type), std::move(shape), std::move(strides), start, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::dtype point_dtype() {
  py::list names;
  py::list formats;
  py::list offsets;
  const auto field = [&](const char* name, const char* format, std::size_t offset) {
    names.append(name);
    formats.append(format);
    offsets.append(offset);
  };
  field("x", "<f4", offsetof(LidarPoint, position));
  field("y", "<f4", offsetof(LidarPoint, position) + sizeof(float));
  field("z", "<f4", offsetof(LidarPoint, position) + 2 * sizeof(float));
  field("intensity", "<f4", offsetof(LidarPoint, intensity));
  field("time_offset_ns", "<i4", offsetof(LidarPoint, time_offset_ns));
  field("ring", "<u2", offsetof(LidarPoint, ring));
  return py::dtype(std::move(names), std::move(formats), std::move(offsets), sizeof(LidarPoint));
}

const LidarScan& scan_of(const py::object& self) { return *self.cast<const ArrivedScan&>().value; }

std::string type_name(const py::handle& given) {
  return py::str(given.get_type().attr("__name__")).cast<std::string>();
}

/// One number per point of whole numbers; `name` is for the error.
template <class Value>
py::array_t<Value> whole_numbers(const py::object& given, const char* name, py::ssize_t size,
                                 const char* advice) {
  const py::array array = py::array::ensure(given);
  if (!array) {
    PyErr_Clear();
    raise(fmt::format("{}: expected an array, got {}", name, type_name(given)));
  }
  const char kind = array.dtype().kind();
  if (kind != 'i' && kind != 'u' && array.size() > 0) {
    raise(fmt::format("{}: expected whole numbers, got {}{}", name,
                      py::str(array.dtype()).cast<std::string>(), advice));
  }
  if (array.ndim() != 1 || array.shape(0) != size) {
    raise(fmt::format("{}: expected one per point, shape ({},), got {} dimensions and {} entries",
                      name, size, array.ndim(), array.size()));
  }
  const auto wide = py::array_t<std::int64_t, py::array::forcecast>::ensure(array);
  const auto values = wide.template unchecked<1>();
  for (py::ssize_t i = 0; i < size; ++i) {
    if (std::in_range<Value>(values(i))) continue;
    raise(fmt::format("{}: entry {} is {}, outside of its range", name, i, values(i)));
  }
  return py::array_t<Value, py::array::forcecast>::ensure(array);
}

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

Floats floats(const py::object& given, const char* name) {
  Floats array = Floats::ensure(given);
  if (array) return array;
  PyErr_Clear();
  raise(fmt::format("{}: expected an array of numbers, got {}", name, type_name(given)));
}

Floats coordinates(const py::object& given) {
  Floats array = floats(given, "xyz");
  if (array.ndim() == 2 && array.shape(1) == 3) return array;
  if (array.size() == 0) return Floats(std::vector<py::ssize_t>{0, 3});
  raise(fmt::format("xyz: expected shape (N, 3), got {} dimensions{}", array.ndim(),
                    array.ndim() == 2 ? fmt::format(" and {} columns", array.shape(1)) : ""));
}

void bind_imu(py::module_& module) {
  py::class_<ArrivedImu>(module, "ImuSample",
                         "One inertial sample, body axes (x forward, y left, z up).")
      .def_readonly("arrival", &ArrivedImu::arrival, "When it reached the estimator [ns].")
      .def_property_readonly(
          "stamp", [](const ArrivedImu& self) { return self.value.stamp; },
          "End of the interval that the sample averages, or the instant sampled [ns].")
      .def_property_readonly(
          "specific_force",
          [](const ArrivedImu& self) { return array_of(self.value.specific_force); },
          "(3,) [m/s^2]: +9.81 upwards at rest.")
      .def_property_readonly(
          "angular_velocity",
          [](const ArrivedImu& self) { return array_of(self.value.angular_velocity); },
          "(3,) [rad/s].")
      .def_property_readonly(
          "orientation",
          [](const ArrivedImu& self) -> py::object {
            if (!self.value.orientation) return py::none();
            return py::array_t<double>(4, self.value.orientation->coeffs().data());
          },
          "(4,) quaternion x y z w of R_world_body as the IMU reports it, or None.");
}

template <class Value, std::size_t kSize>
py::array_t<Value> array_from(const std::array<Value, kSize>& values) {
  return py::array_t<Value>(static_cast<py::ssize_t>(kSize), values.data());
}

void bind_legs(py::module_& module) {
  py::class_<ArrivedLegs>(
      module, "LegSample",
      "Leg odometry as the robot reports it; legs in the order front left, front right, rear left, "
      "rear right.")
      .def_readonly("arrival", &ArrivedLegs::arrival, "When it reached the estimator [ns].")
      .def_property_readonly(
          "stamp", [](const ArrivedLegs& self) { return self.value.stamp; },
          "Of the encoders [ns].")
      .def_property_readonly(
          "pose", [](const ArrivedLegs& self) { return array_of(self.value.T_odom_base); },
          "(4, 4) T_odom_base: the base in the odometry frame of the robot.")
      .def_property_readonly(
          "linear_velocity",
          [](const ArrivedLegs& self) { return array_of(self.value.linear_velocity); },
          "(3,) of the base, in base axes [m/s].")
      .def_property_readonly(
          "angular_velocity",
          [](const ArrivedLegs& self) { return array_of(self.value.angular_velocity); },
          "(3,) of the base, in base axes [rad/s].")
      .def_property_readonly(
          "contact", [](const ArrivedLegs& self) { return array_from(self.value.contact); },
          "(4,) bool: which feet touch the ground.")
      .def_property_readonly(
          "contact_force",
          [](const ArrivedLegs& self) -> py::object {
            if (!self.value.contact_force) return py::none();
            return array_from(*self.value.contact_force);
          },
          "(4,) normal force on each foot [N], or None where it is not reported.")
      .def_property_readonly(
          "joint_position",
          [](const ArrivedLegs& self) { return array_from(self.value.joint_position); },
          "(12,) [rad], leg by leg: abduction, hip, knee.")
      .def_property_readonly(
          "joint_velocity",
          [](const ArrivedLegs& self) { return array_from(self.value.joint_velocity); },
          "(12,) [rad/s].");
}

void bind_scan(py::module_& module) {
  py::class_<ArrivedScan>(
      module, "LidarScan",
      "One scan in the order of firing, LiDAR frame, without misses and not deskewed. The arrays "
      "are "
      "views of the scan, which stays alive as long as one of them does; they are read-only.")
      .def(py::init([](const py::object& stamp, const py::object& xyz, const py::object& offsets,
                       const py::object& rings, const py::object& intensity, const py::object& end,
                       const py::object& arrival) {
             auto scan = scan_from(stamp_from(stamp, "stamp"), xyz, offsets, rings, intensity, end);
             const Time last = scan->end;
             return ArrivedScan{arrival.is_none() ? last : stamp_from(arrival, "arrival"),
                                std::move(scan)};
           }),
           py::arg("stamp"), py::arg("xyz"), py::arg("offsets"), py::arg("rings") = py::none(),
           py::arg("intensity") = py::none(), py::arg("end") = py::none(),
           py::arg("arrival") = py::none(),
           "A scan of arrays, which are copied; as `Estimator.add_scan`.")
      .def("__len__", [](const ArrivedScan& self) { return self.value->points.size(); })
      .def_readonly("arrival", &ArrivedScan::arrival, "When it reached the estimator [ns].")
      .def_property_readonly(
          "stamp", [](const ArrivedScan& self) { return self.value->stamp; },
          "Of the first firing [ns].")
      .def_property_readonly(
          "end", [](const ArrivedScan& self) { return self.value->end; },
          "Nominal end of the scan [ns].")
      .def_property_readonly(
          "points",
          [](const py::object& self) { return view(self, scan_of(self), point_dtype(), 0); },
          "(N,) structured: x, y, z [m], intensity [0, 1], time_offset_ns [ns after stamp], ring.")
      .def_property_readonly(
          "xyz",
          [](const py::object& self) {
            return view(self, scan_of(self), py::dtype("f4"), offsetof(LidarPoint, position), true);
          },
          "(N, 3) float32 [m].")
      .def_property_readonly(
          "offsets",
          [](const py::object& self) {
            return view(self, scan_of(self), py::dtype("i4"), offsetof(LidarPoint, time_offset_ns));
          },
          "(N,) int32: firing time after the stamp [ns].")
      .def_property_readonly(
          "rings",
          [](const py::object& self) {
            return view(self, scan_of(self), py::dtype("u2"), offsetof(LidarPoint, ring));
          },
          "(N,) uint16: 0 is the lowest elevation.")
      .def_property_readonly(
          "intensity",
          [](const py::object& self) {
            return view(self, scan_of(self), py::dtype("f4"), offsetof(LidarPoint, intensity));
          },
          "(N,) float32, in [0, 1].");
}

void bind_rig(py::module_& module) {
  py::class_<SensorRig>(
      module, "Rig",
      "What an estimator needs of the robot and its sensors. The body frame is that of the IMU.")
      .def(py::init([](const py::object& T_body_lidar, const py::object& T_body_base,
                       double imu_rate, double leg_rate) {
             SensorRig rig;
             if (!T_body_lidar.is_none())
               rig.T_body_lidar = pose_from(T_body_lidar, "T_body_lidar");
             if (!T_body_base.is_none()) rig.T_body_base = pose_from(T_body_base, "T_body_base");
             if (!(imu_rate > 0.0) || !(leg_rate > 0.0)) {
               raise(fmt::format("expected rates above 0 Hz, got imu_rate {}, leg_rate {}",
                                 imu_rate, leg_rate));
             }
             rig.imu_rate_hz = imu_rate;
             rig.leg_rate_hz = leg_rate;
             return rig;
           }),
           py::arg("T_body_lidar") = py::none(), py::arg("T_body_base") = py::none(),
           py::arg("imu_rate") = 50.0, py::arg("leg_rate") = 200.0,
           "Poses are (4, 4) matrices, identity when left out; rates in Hz.")
      .def_property_readonly(
          "T_body_lidar", [](const SensorRig& self) { return array_of(self.T_body_lidar); },
          "(4, 4): the LiDAR frame in the body frame.")
      .def_property_readonly(
          "T_body_base", [](const SensorRig& self) { return array_of(self.T_body_base); },
          "(4, 4): the frame of the leg odometry in the body frame.")
      .def_readonly("imu_rate", &SensorRig::imu_rate_hz, "Nominal rate of samples [Hz].")
      .def_readonly("leg_rate", &SensorRig::leg_rate_hz, "Nominal rate of leg packets [Hz].");
}

}  // namespace

LidarScanPtr scan_from(Time stamp, const py::object& xyz, const py::object& offsets,
                       const py::object& rings, const py::object& intensity,
                       const py::object& end) {
  const Floats position = coordinates(xyz);
  const py::ssize_t size = position.shape(0);
  const auto offset = whole_numbers<std::int32_t>(
      offsets, "offsets", size, " of nanoseconds; of seconds: (1e9 * offsets).astype('int32')");
  std::optional<py::array_t<std::uint16_t>> ring;
  if (!rings.is_none()) ring = whole_numbers<std::uint16_t>(rings, "rings", size, "");
  std::optional<Floats> bright;
  if (!intensity.is_none()) {
    bright = floats(intensity, "intensity");
    if (bright->ndim() != 1 || bright->shape(0) != size) {
      raise(fmt::format("intensity: expected one per point, {}, got {}", size, bright->size()));
    }
  }
  auto scan = std::make_shared<LidarScan>();
  scan->stamp = scan->end = stamp;
  scan->points.resize(static_cast<std::size_t>(size));
  const float* at = position.data();
  const auto offset_at = offset.unchecked<1>();
  for (py::ssize_t i = 0; i < size; ++i, at += 3) {
    LidarPoint& point = scan->points[static_cast<std::size_t>(i)];
    point.position = {at[0], at[1], at[2]};
    point.time_offset_ns = offset_at(i);
    if (ring) point.ring = ring->at(i);
    if (bright) point.intensity = bright->data()[i];
    scan->end = std::max(scan->end, stamp + point.time_offset_ns);
  }
  if (!end.is_none()) scan->end = stamp_from(end, "end");
  if (scan->end < stamp) {
    raise(fmt::format("end: expected {} ns, the stamp, or later, got {}", stamp, scan->end));
  }
  return scan;
}

void bind_measurements(py::module_& module) {
  bind_imu(module);
  bind_legs(module);
  bind_scan(module);
  bind_rig(module);
}

}  // namespace aims::python
