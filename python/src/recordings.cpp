// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <limits>
#include <optional>

#include "bench/estimate/estimate.hpp"
#include "bench/estimate/estimate_summary.hpp"
#include "bench/estimate/scoring_input.hpp"
#include "bench/estimate/stream.hpp"
#include "bench/scoring/trajectory_summary.hpp"
#include "core/files/tum.hpp"
#include "core/files/yaml_config.hpp"
#include "python/src/measurements.hpp"
#include "python/src/outcome.hpp"
#include "recordings/trajectories/trajectory_file.hpp"

namespace aims::python {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

/// A recording, read from its start to its end.
class RecordingStream {
 public:
  RecordingStream(const fs::path& file, const Texts& settings, bool recover)
      : reader_(value_or_raise(open(file, settings, recover))) {}

  py::object next() {
    return buffer_.next([&](std::vector<Delivery>& batch) {
      return value_or_raise(without_lock([&] { return reader_.advance(kStreamBatch, batch); }));
    });
  }

  /// Reads the rest without handing it out.
  void drain() {
    buffer_.end();
    value_or_raise(without_lock([&]() -> Result<void> {
      std::vector<Delivery> batch;
      for (bool more = true; more; batch.clear()) {
        const auto advanced = reader_.advance(kStreamBatch, batch);
        if (!advanced) return tl::unexpected(advanced.error());
        more = *advanced;
      }
      return {};
    }));
  }

  const RecordingReader& reader() const { return reader_; }

 private:
  static Result<RecordingReader> open(const fs::path& file, const Texts& settings, bool recover) {
    const auto config = load_estimate_config({}, settings);
    if (!config) return tl::unexpected(config.error());
    return without_lock([&] { return RecordingReader::open(file, config->recording, {recover}); });
  }

  RecordingReader reader_;
  DeliveryBuffer buffer_;
};

py::dict setup_of(const RecordingReader& reader) {
  const RecordingSetup& setup = reader.setup();
  py::dict topics;
  const TopicsConfig& used = setup.topics;
  for (const auto& [name, topic] :
       {std::pair("lidar", used.lidar), std::pair("imu", used.imu),
        std::pair("leg_odometry", used.leg_odometry), std::pair("joint_states", used.joint_states),
        std::pair("contacts", used.contacts), std::pair("truth", used.truth)}) {
    if (!topic.empty()) topics[name] = topic;
  }
  py::dict dict;
  dict["topics"] = topics;
  std::vector<std::string> notes = setup.notes;
  for (const ReadingWarning& each : setup.warnings) notes.push_back(each.text);
  dict["notes"] = notes;
  dict["rig"] = setup.rig;
  dict["has_legs"] = setup.has_legs;
  dict["has_joints"] = setup.has_joints;
  dict["has_point_times"] = setup.has_point_times;
  dict["has_rings"] = setup.rings.count > 0;
  dict["has_orientation"] = setup.has_orientation;
  dict["has_truth"] = setup.has_truth;
  dict["start"] = reader.summary().start;
  dict["end"] = reader.summary().end;
  return dict;
}

/// Ends native work when Python has a signal to handle, e.g. Ctrl-C.
Observer interruptible(bool& interrupted) {
  return [&interrupted](const Progress&) {
    const py::gil_scoped_acquire lock;
    interrupted = PyErr_CheckSignals() != 0;
    return !interrupted;
  };
}

py::dict estimate_recording(const fs::path& file, const Texts& settings, bool recover, int jobs) {
  const auto config = value_or_raise(load_estimate_config({}, settings));
  bool interrupted = false;
  auto result = without_lock([&] {
    return estimate(config, {file, recover, jobs}, interruptible(interrupted));
  });
  if (interrupted) throw py::error_already_set();
  const EstimateResult done = value_or_raise(std::move(result));
  py::dict estimators;
  for (const EstimatorOutcome& each : done.estimators) {
    estimators[py::str(each.name)] = outcome_of(each);
  }
  py::dict dict;
  dict["estimators"] = estimators;
  dict["truth"] = done.truth.empty() ? py::none() : object_of(done.truth);
  dict["scores"] = done.scores ? object_of(estimate_record(done).scores) : py::none();
  dict["summary"] = object_of(estimate_json(done));
  return dict;
}

/// The group `scoring` of a configuration.
ScoreConfig scoring_from(const Texts& settings) {
  ScoreConfig scoring;
  const auto fields = [&scoring] {
    Fields all;
    all.group("scoring", scoring);
    return all;
  };
  value_or_raise(apply_overrides(fields, settings));
  return scoring;
}

/// Error unless the poses can be a truth.
void check_truth(const std::string& name, const Trajectory& trajectory) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Pose& pose = trajectory[i].pose;
    if (!pose.translation.allFinite() || !(std::abs(pose.rotation.norm() - 1.0) < 1e-3)) {
      raise(fmt::format("{}: pose {}: expected finite numbers and a unit quaternion", name, i));
    }
    if (i > 0 && trajectory[i].stamp <= trajectory[i - 1].stamp) {
      raise(fmt::format("{}: pose {}: its stamp is not after the one before", name, i));
    }
  }
}

/// The text that names a trajectory: the path of its file, or, of one in memory, `name`.
std::string source_of(const py::object& given, const std::string& name, ScoringRequest& request) {
  const py::object kind = py::module_::import("aims.trajectory").attr("Trajectory");
  if (!py::isinstance(given, kind)) return py::str(given).cast<std::string>();
  const std::string source = name + " (in memory)";
  request.in_memory[source] = trajectory_from(given);
  return source;
}

py::object score_estimates(const py::object& truth, const py::dict& estimates,
                           const std::optional<fs::path>& waypoint_times,
                           const std::string& segments, const std::string& extrinsic,
                           double time_offset, const Texts& settings) {
  ScoringRequest request;
  request.scoring = scoring_from(settings);
  request.truth = source_of(truth, "truth", request);
  if (request.in_memory.contains(request.truth)) {
    check_truth("truth", request.in_memory[request.truth]);
  }
  for (const auto& [name, estimate] : estimates) {
    request.names.push_back(name.cast<std::string>());
    request.estimates.push_back(
        source_of(py::reinterpret_borrow<py::object>(estimate), request.names.back(), request));
  }
  if (waypoint_times) request.waypoint_times = *waypoint_times;
  request.segments = segments;
  request.extrinsic = extrinsic;
  request.time_offset_s = time_offset;
  const TrajectoryScores scores = value_or_raise(without_lock([&]() -> Result<TrajectoryScores> {
    auto input = read_scoring_input(request);
    if (!input) return tl::unexpected(input.error());
    auto scored = score_trajectories(std::move(*input));
    if (!scored) return scored;
    if (auto compared = check_compared(*scored); !compared) {
      return tl::unexpected(compared.error());
    }
    return scored;
  }));
  py::dict aligned;
  for (const ScoredEstimate& each : scores.estimates) {
    aligned[py::str(each.given.name)] = object_of(each.in_truth_frame);
  }
  return py::make_tuple(object_of(record_of(scores).scores), object_of(scores.truth.trajectory),
                        aligned);
}

void bind_stream(py::module_& module) {
  py::class_<RecordingStream>(module, "RecordingStream",
                              "The measurements of a recording, in order of record time.")
      .def(py::init<const fs::path&, const Texts&, bool>(), py::arg("path"), py::arg("settings"),
           py::arg("recover"))
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &RecordingStream::next)
      .def("drain", &RecordingStream::drain)
      .def_property_readonly("setup",
                             [](const RecordingStream& self) { return setup_of(self.reader()); })
      .def_property_readonly("counts",
                             [](const RecordingStream& self) { return self.reader().counts(); })
      .def_property_readonly(
          "truth", [](const RecordingStream& self) { return object_of(self.reader().truth()); });
}

}  // namespace

void bind_recordings(py::module_& module) {
  bind_stream(module);
  module.def("estimate", estimate_recording, py::arg("path"), py::arg("settings"),
             py::arg("recover"), py::arg("jobs"));
  module.def("score", score_estimates, py::arg("truth"), py::arg("estimates"),
             py::arg("waypoint_times"), py::arg("segments"), py::arg("extrinsic"),
             py::arg("time_offset"), py::arg("settings"));
  module.def(
      "read_trajectory",
      [](const std::string& source) {
        return object_of(value_or_raise(read_trajectory(source, {PoseRules::kAsGiven})).trajectory);
      },
      py::arg("source"));
  module.def(
      "write_trajectory",
      [](const fs::path& file, const py::object& trajectory) {
        value_or_raise(write_tum(file, trajectory_from(trajectory)));
      },
      py::arg("path"), py::arg("trajectory"));
}

}  // namespace aims::python
