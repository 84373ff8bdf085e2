// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <limits>
#include <memory>
#include <optional>

#include "bench/estimate/stream.hpp"
#include "bench/jobs/sequence_cache.hpp"
#include "bench/jobs/stored_results.hpp"
#include "bench/run/evaluate.hpp"
#include "bench/scenario/catalogue.hpp"
#include "core/stopwatch.hpp"
#include "python/src/measurements.hpp"
#include "python/src/outcome.hpp"
#include "sim/simulation.hpp"

namespace aims::python {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;
using ScenarioPtr = std::shared_ptr<const Scenario>;

/// A scenario with settings on top; errors as of the program.
struct LoadedScenario {
  ScenarioPtr scenario;

  LoadedScenario(const std::string& given, const Texts& settings, const fs::path& folder) {
    const fs::path file = value_or_raise(find_scenario(given, folder));
    scenario =
        std::make_shared<const Scenario>(value_or_raise(load_scenario(file, settings, folder)));
  }
};

/// (N, 3) of one member of each true sample.
py::array_t<double> samples_of(const Truth& truth, Eigen::Vector3d TruthSample::*member) {
  const auto size = static_cast<py::ssize_t>(truth.samples.size());
  py::array_t<double> array(std::vector<py::ssize_t>{size, 3});
  auto values = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < size; ++i) {
    const Eigen::Vector3d& vector = truth.samples[static_cast<std::size_t>(i)].*member;
    for (int axis = 0; axis < 3; ++axis) values(i, axis) = vector[axis];
  }
  return array;
}

py::dict truth_of(const Truth& truth) {
  py::dict dict;
  dict["trajectory"] = object_of(body_trajectory(truth));
  dict["velocities"] = samples_of(truth, &TruthSample::velocity);
  dict["angular_velocities"] = samples_of(truth, &TruthSample::angular_velocity);
  py::list passed;
  for (const WaypointTime& each : truth.waypoint_times) {
    passed.append(py::make_tuple(each.point, each.stamp));
  }
  dict["waypoint_times"] = passed;
  dict["end"] = std::string(name_of(truth.walk.end));
  dict["touched_wall"] = truth.walk.touched_wall;
  return dict;
}

/// A simulated walk, from its start to its end.
class SimulationStream {
 public:
  SimulationStream(const LoadedScenario& loaded, std::uint64_t seed)
      : simulation_(value_or_raise(without_lock([&] { return create(*loaded.scenario, seed); }))) {}

  py::object next() {
    return buffer_.next([&](std::vector<Delivery>& batch) {
      return without_lock([&] { return simulation_.advance(kStreamBatch, batch); });
    });
  }

  const Simulation& simulation() const { return simulation_; }

 private:
  static Result<Simulation> create(const Scenario& scenario, std::uint64_t seed) {
    auto simulation = Simulation::create(scenario_of_seed(scenario, seed).simulation, seed);
    if (!simulation) return tl::unexpected(located(scenario, simulation.error()));
    return simulation;
  }

  Simulation simulation_;
  DeliveryBuffer buffer_;
};

/// Ends native work by an exception when Python has a signal to handle, e.g. Ctrl-C.
void check_signals(double /*part*/) {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// A simulated sequence of the cache that all commands have in common, for any number of
/// estimators.
class CachedSequence {
 public:
  CachedSequence(const LoadedScenario& loaded, std::uint64_t seed, const fs::path& folder)
      : scenario_(scenario_of_seed(loaded.scenario, seed)), seed_(seed) {
    const SequenceCache cache(folder.empty() ? SequenceCache::default_folder() : folder);
    const std::string id = SequenceCache::id_of(*scenario_, seed);
    const auto made =
        value_or_raise(without_lock([&] { return cache.make(*scenario_, seed, check_signals); }));
    if (made.refusal) raise("the sequence could not be simulated: " + *made.refusal);
    if (auto in_use = cache.use(id)) in_use_.emplace(std::move(*in_use));
    sequence_ = std::make_unique<const Sequence>(value_or_raise(
        without_lock([&] { return open_sequence(cache.file_of(id), *scenario_, seed); })));
  }

  /// The outcome of the estimator of that spec, and what its job's file holds.
  py::tuple evaluate(const std::string& spec) const {
    const Stopwatch stopwatch;
    const EstimatorOutcome outcome = value_or_raise(
        without_lock([&] { return aims::evaluate(*sequence_, *scenario_, spec, check_signals); }));
    return py::make_tuple(outcome_of(outcome), record(outcome, stopwatch.seconds()));
  }

  /// The same of a trajectory that was estimated elsewhere.
  py::tuple judge(const std::string& name, const py::object& trajectory, double wall_s) const {
    EstimatorOutcome outcome;
    outcome.name = name;
    outcome.result.trajectory = trajectory_from(trajectory);
    outcome.wall_s = wall_s;
    without_lock([&] { add_scores(*sequence_, *scenario_, outcome); });
    return py::make_tuple(outcome_of(outcome), record(outcome, wall_s));
  }

  /// Calls `visit` with every measurement, in order of arrival.
  void replay(const py::function& visit) const {
    value_or_raise(
        sequence_->reader.replay([&](const Delivery& delivery) { visit(object_of(delivery)); }));
  }

  py::dict truth() const { return truth_of(sequence_->reader.truth()); }
  const SensorRig& rig() const { return sequence_->reader.rig(); }
  Texts specs() const { return scenario_->run; }

 private:
  py::object record(const EstimatorOutcome& outcome, double wall_s) const {
    JobResult result;
    result.scores = estimator_json(outcome);
    result.sequence = sequence_json(*sequence_, *scenario_, outcome.scores);
    result.wall_s = wall_s;
    const LabelledResult labelled = {outcome.name, std::move(result)};
    return object_of(record_of(scenario_->name, seed_, {&labelled, 1}).scores);
  }

  ScenarioPtr scenario_;
  std::uint64_t seed_;
  std::optional<FolderLock> in_use_;
  std::unique_ptr<const Sequence> sequence_;
};

py::dict scenarios(const fs::path& folder, const Texts& tags) {
  py::dict dict;
  for (const CatalogueEntry& each :
       scenario_catalogue(value_or_raise(scenario_heads(folder, tags)))) {
    dict[py::str(each.name)] = each.description;
  }
  return dict;
}

void bind_scenario(py::module_& module) {
  py::class_<LoadedScenario>(module, "Scenario",
                             "An experiment: world, route, sensors, estimators.")
      .def(py::init<const std::string&, const Texts&, const fs::path&>(), py::arg("given"),
           py::arg("settings"), py::arg("folder"))
      .def_property_readonly(
          "name", [](const LoadedScenario& self) { return self.scenario->name; },
          "Name of the scenario.")
      .def_property_readonly(
          "description", [](const LoadedScenario& self) { return self.scenario->description; },
          "One line.")
      .def_property_readonly(
          "default_seed", [](const LoadedScenario& self) { return self.scenario->seed; },
          "Seed of its file.")
      .def_property_readonly(
          "estimators", [](const LoadedScenario& self) { return self.scenario->run; },
          "Specs of the estimators that its file names.")
      .def_property_readonly(
          "config", [](const LoadedScenario& self) { return config_text(*self.scenario); },
          "Every parameter that has an effect, as YAML that loads again.");
}

void bind_streams(py::module_& module) {
  py::class_<SimulationStream>(module, "SimulationStream", "The measurements of a simulated walk.")
      .def(py::init<const LoadedScenario&, std::uint64_t>(), py::arg("scenario"), py::arg("seed"))
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &SimulationStream::next)
      .def_property_readonly(
          "rig", [](const SimulationStream& self) { return self.simulation().rig(); },
          "`aims.Rig`: the sensors as they are mounted by design.")
      .def_property_readonly("truth", [](const SimulationStream& self) {
        return truth_of(self.simulation().truth());
      });
  py::class_<CachedSequence>(module, "Sequence", "A simulated sequence of the cache.")
      .def(py::init<const LoadedScenario&, std::uint64_t, const fs::path&>(), py::arg("scenario"),
           py::arg("seed"), py::arg("cache"))
      .def("evaluate", &CachedSequence::evaluate, py::arg("spec"))
      .def("judge", &CachedSequence::judge, py::arg("name"), py::arg("trajectory"),
           py::arg("wall_s"))
      .def("replay", &CachedSequence::replay, py::arg("visit"))
      .def_property_readonly("rig", &CachedSequence::rig)
      .def_property_readonly("specs", &CachedSequence::specs)
      .def_property_readonly("truth", &CachedSequence::truth);
}

}  // namespace

}  // namespace aims::python

PYBIND11_MODULE(_sim, module) {
  namespace py = pybind11;
  module.doc() = "Scenarios and the simulation.";
  py::module_::import("aims._core");  // declares the measurements
  aims::python::bind_scenario(module);
  aims::python::bind_streams(module);
  module.def("scenarios", aims::python::scenarios, py::arg("folder"), py::arg("tags"));
  module.def("default_folder",
             [](const std::filesystem::path& file) { return aims::default_scenario_folder(file); });
}
