// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <mutex>

#include "core/files/config_dump.hpp"
#include "core/series_style.hpp"
#include "estimator/estimator_spec.hpp"
#include "estimator/registry.hpp"
#include "python/src/measurements.hpp"

namespace aims::python {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

/// The configuration of the estimator `name` with settings on top; errors as of the program.
std::unique_ptr<EstimatorConfig> config_of(const std::string& name, const Settings& settings) {
  if (auto known = check_estimator_name(name); !known) raise(known.error().message);
  return value_or_raise(config_with({name, name, settings}, EstimatorConfigs()));
}

/// Colour "#rrggbb" and dash lengths [px] of a line for each label, as in all pictures.
std::vector<std::pair<std::string, std::vector<double>>> line_styles(
    const std::vector<std::string>& labels) {
  std::vector<std::pair<std::string, std::vector<double>>> styles;
  for (const std::size_t index : series_styles(labels)) {
    const SeriesStyle style = series_style(index);
    const auto dashes = dash_lengths(style.pattern);
    styles.emplace_back(fmt::format("#{:06x}", style.light),
                        std::vector<double>(dashes.begin(), dashes.end()));
  }
  return styles;
}

/// An estimator that threads may use one after the other.
class Guarded {
 public:
  Guarded(const std::string& name, const Settings& settings, const SensorRig& rig)
      : name_(name), rig_(rig) {
    const auto config = config_of(name, settings);
    text_ = dump_config(fields_of(*config));
    estimator_ = config->create(rig);
  }

  /// The newest pose, when the delivery has brought one.
  py::object consume(const Delivery& delivery) {
    if (finished_) raise("the estimator has finished: it takes no more measurements");
    std::optional<StampedPose> newest;
    without_lock([&] {
      const std::lock_guard guard(mutex_);
      const Trajectory& trajectory = estimator_->result().trajectory;
      const std::size_t before = trajectory.size();
      estimator_->consume(delivery);
      if (trajectory.size() > before) newest = trajectory.back();
    });
    return object_of(newest);
  }

  void finish() {
    without_lock([&] {
      const std::lock_guard guard(mutex_);
      if (!finished_) estimator_->finish();
      finished_ = true;
    });
  }

  /// Whatever `get` makes of the result so far.
  template <class Get>
  auto read(const Get& get) const {
    const std::lock_guard guard(mutex_);
    return get(estimator_->result());
  }

  std::vector<Eigen::Vector3f> map_points() const {
    const std::lock_guard guard(mutex_);
    return estimator_->map_points();
  }

  static py::object object_of(const std::optional<StampedPose>& pose) {
    if (!pose) return py::none();
    return py::make_tuple(pose->stamp, array_of(pose->pose));
  }

  const std::string& name() const { return name_; }
  const SensorRig& rig() const { return rig_; }
  const std::string& config_text() const { return text_; }

 private:
  std::string name_;
  SensorRig rig_;
  std::string text_;
  std::unique_ptr<Estimator> estimator_;
  bool finished_ = false;
  mutable std::mutex mutex_;
};

Time arrival_of(const py::object& given, Time stamp) {
  return given.is_none() ? stamp : stamp_from(given, "arrival");
}

py::object add_imu(Guarded& self, const py::object& given, const py::object& force,
                   const py::object& turn, const py::object& orientation,
                   const py::object& arrival) {
  ImuSample sample;
  sample.stamp = stamp_from(given, "stamp");
  sample.specific_force = vector_from(force, "specific_force");
  sample.angular_velocity = vector_from(turn, "angular_velocity");
  if (!orientation.is_none()) {
    const auto q = py::array_t<double, py::array::forcecast>::ensure(orientation);
    if (!q || q.ndim() != 1 || q.shape(0) != 4) {
      PyErr_Clear();
      raise("orientation: expected a quaternion x y z w, shape (4,)");
    }
    sample.orientation = Eigen::Quaterniond(q.at(3), q.at(0), q.at(1), q.at(2));
  }
  return self.consume({arrival_of(arrival, sample.stamp), sample});
}

template <class Value, std::size_t kSize>
void fill(std::array<Value, kSize>& values, const py::object& given, const char* name) {
  if (given.is_none()) return;
  const auto array = py::array_t<Value, py::array::forcecast>::ensure(given);
  if (!array || array.ndim() != 1 || array.shape(0) != static_cast<py::ssize_t>(kSize)) {
    PyErr_Clear();
    raise(fmt::format("{}: expected {} numbers, shape ({},)", name, kSize, kSize));
  }
  for (std::size_t i = 0; i < kSize; ++i) values[i] = array.at(static_cast<py::ssize_t>(i));
}

py::object add_legs(Guarded& self, const py::object& stamp, const py::object& pose,
                    const py::object& linear, const py::object& angular, const py::object& contact,
                    const py::object& joint_position, const py::object& joint_velocity,
                    const py::object& arrival, const py::object& contact_force) {
  LegOdometrySample sample;
  sample.stamp = stamp_from(stamp, "stamp");
  if (!pose.is_none()) sample.T_odom_base = pose_from(pose, "pose");
  sample.linear_velocity = vector_from(linear, "linear_velocity");
  sample.angular_velocity = vector_from(angular, "angular_velocity");
  fill(sample.contact, contact, "contact");
  fill(sample.joint_position, joint_position, "joint_position");
  fill(sample.joint_velocity, joint_velocity, "joint_velocity");
  if (!contact_force.is_none())
    fill(sample.contact_force.emplace(), contact_force, "contact_force");
  return self.consume({arrival_of(arrival, sample.stamp), sample});
}

py::object add_scan(Guarded& self, const py::object& given, const py::object& xyz,
                    const py::object& offsets, const py::object& rings, const py::object& intensity,
                    const py::object& end, const py::object& arrival) {
  const Time stamp = stamp_from(given, "stamp");
  LidarScanPtr scan = scan_from(stamp, xyz, offsets, rings, intensity, end);
  const Time last = scan->end;
  return self.consume({arrival_of(arrival, last), std::move(scan)});
}

/// Every parameter of an estimator: a dict each.
py::list parameters_of(const std::string& name, const Settings& settings) {
  const auto config = config_of(name, settings);
  py::list list;
  for (const Parameter& each : fields_of(*config).parameters()) {
    py::dict dict;
    dict["key"] = each.key;
    dict["value"] = each.text();
    dict["unit"] = each.spec.unit;
    dict["expected"] = each.expected;
    dict["meaning"] = each.spec.meaning;
    dict["source"] = each.spec.source;
    dict["idle"] = each.idle;
    list.append(dict);
  }
  return list;
}

py::dict estimators() {
  py::dict dict;
  for (const EstimatorEntry& each : estimator_registry()) {
    dict[py::str(std::string(each.name))] = std::string(each.description);
  }
  return dict;
}

void bind_adders(py::class_<Guarded>& estimator) {
  const auto none = py::none();
  estimator
      .def("add",
           [](Guarded& self, const ArrivedImu& each) {
             return self.consume({each.arrival, each.value});
           })
      .def("add",
           [](Guarded& self, const ArrivedLegs& each) {
             return self.consume({each.arrival, each.value});
           })
      .def(
          "add",
          [](Guarded& self, const ArrivedScan& each) {
            return self.consume({each.arrival, each.value});
          },
          "Processes an ImuSample, LegSample or LidarScan, in order of arrival; returns as "
          "add_scan.")
      .def(
          "add_imu", add_imu, py::arg("stamp"), py::arg("specific_force"),
          py::arg("angular_velocity"), py::arg("orientation") = none, py::arg("arrival") = none,
          "Processes an inertial sample: stamp [ns], specific force (3,) [m/s^2], angular velocity "
          "(3,) [rad/s], both in body axes.")
      .def(
          "add_scan", add_scan, py::arg("stamp"), py::arg("xyz"), py::arg("offsets"),
          py::arg("rings") = none, py::arg("intensity") = none, py::arg("end") = none,
          py::arg("arrival") = none,
          "Processes a scan: stamp of the first firing [ns], points (N, 3) [m] in the LiDAR frame "
          "at their own firing, offsets (N,) of whole ns after the stamp. Returns (stamp [ns], "
          "T_odom_body (4, 4)) of the newest pose when the measurement has brought one, else None.")
      .def("add_legs", add_legs, py::arg("stamp"), py::arg("pose"), py::arg("linear_velocity"),
           py::arg("angular_velocity"), py::arg("contact") = none, py::arg("joint_position") = none,
           py::arg("joint_velocity") = none, py::arg("arrival") = none,
           py::arg("contact_force") = none,
           "Processes leg odometry: T_odom_base (4, 4) or None, twist (3,) [m/s] and (3,) [rad/s] "
           "in base axes, contacts (4,), joints (12,) [rad] and [rad/s], loads (4,) [N].")
      .def("finish", &Guarded::finish,
           "Processes what waits to be put in order, and re-optimizes where the estimator does.");
}

}  // namespace

void bind_estimator(py::module_& module) {
  module.def("estimators", estimators, "Names and descriptions of all estimators, as a dict.");
  module.def("line_styles", line_styles, py::arg("labels"));
  module.def("parameters", parameters_of, py::arg("name"), py::arg("settings"));
  py::class_<Guarded> estimator(module, "Estimator",
                                "An estimator of the registry, fed by the caller's own loop.");
  estimator.def(py::init<const std::string&, const Settings&, const SensorRig&>(), py::arg("name"),
                py::arg("settings"), py::arg("rig"));
  bind_adders(estimator);
  estimator.def_property_readonly("name", &Guarded::name, "In the registry, e.g. \"aims_d\".")
      .def_property_readonly("rig", &Guarded::rig, "`aims.Rig`, as given.")
      .def_property_readonly("config", &Guarded::config_text,
                             "Every parameter that has an effect, as YAML.")
      .def(
          "pose",
          [](const Guarded& self) {
            return Guarded::object_of(self.read([](const EstimatorResult& result) {
              return result.trajectory.empty()
                         ? std::nullopt
                         : std::optional<StampedPose>(result.trajectory.back());
            }));
          },
          "(stamp [ns], T_odom_body (4, 4)) of the newest pose, or None.")
      .def(
          "result",
          [](const Guarded& self) {
            return self.read([](const EstimatorResult& result) { return result_of(result); });
          },
          "All of the result so far, as a dict.")
      .def_property_readonly(
          "trajectory",
          [](const Guarded& self) {
            return self.read(
                [](const EstimatorResult& result) { return object_of(result.trajectory); });
          },
          "T_odom_body at each scan end so far: aims.Trajectory, a copy.")
      .def(
          "map_points", [](const Guarded& self) { return array_of(self.map_points()); },
          "(N, 3) float32: the local map in the odometry frame [m].");
}

}  // namespace aims::python
