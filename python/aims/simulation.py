# SPDX-License-Identifier: BSD-3-Clause
"""Scenarios and the simulation, whose extension module is imported when it is first used."""

import time

from .errors import MissingPackage
from .interface import drive
from .recording import Outcome, Scores, aligned_estimates, repr_of_result
from .settings import assignments, specs


def _sim():
    try:
        from . import _sim as module
    except ImportError as error:
        raise MissingPackage(
            f"the simulation cannot be imported ({error}); on Debian: the package python3-aims-sim"
        ) from error
    return module


def scenario_folder():
    """The shipped scenarios: ./scenarios, else those of the installation or of the sources."""
    return _sim().default_folder(_sim().__file__)


def scenarios(tags=(), folder=None):
    """Names and descriptions of the scenarios of a folder (the shipped ones), by tag."""
    return _sim().scenarios(folder or scenario_folder(), list(tags))


class Scenario:
    """An experiment: world, route, sensors and estimators.

    given      a name of `aims list` or the path of a YAML file
    seed       of every random stream; None: that of the file
    overrides  keys as of --set: {"lidar": {"range_max": 30}} or {"lidar.range_max": 30}
    folder     where names are looked up; None: the shipped scenarios
    """

    def __init__(self, given, seed=None, overrides=None, folder=None):
        self._loaded = _sim().Scenario(
            str(given), assignments(overrides), folder or scenario_folder()
        )
        self.seed = self._loaded.default_seed if seed is None else int(seed)

    @property
    def name(self):
        """Name of the scenario."""
        return self._loaded.name

    @property
    def description(self):
        """One line."""
        return self._loaded.description

    @property
    def estimators(self):
        """Specs of the estimators that its file names."""
        return self._loaded.estimators

    @property
    def config(self):
        """Every parameter that has an effect, as YAML that loads again."""
        return self._loaded.config

    def __repr__(self):
        return f"Scenario {self.name}, seed {self.seed}: {self.description}"


def _scenario(given, seed, overrides):
    if not isinstance(given, Scenario):
        return Scenario(given, seed, overrides)
    if seed is not None or overrides:
        from .errors import Error

        raise Error("seed and overrides belong to the Scenario that is given")
    return given


class Truth:
    """The ground truth of a simulated walk, which no estimator receives.

    trajectory          aims.Trajectory, T_world_body at the physics rate
    velocities          (N, 3) of the body in the world [m/s]
    angular_velocities  (N, 3) in body axes [rad/s]
    waypoint_times      [(point, stamp [ns]), ...]
    end                 "route_done" of a valid walk; "fell", "running", ...
    touched_wall        at any time
    """

    def __init__(self, values):
        self.__dict__.update(values)

    def __repr__(self):
        return f"Truth: {self.end} after {len(self.waypoint_times)} waypoints; {self.trajectory}"


class Simulation:
    """A simulated walk as an iterator of its measurements, in order of arrival; goes once."""

    def __init__(self, scenario):
        self.scenario = scenario
        self._stream = _sim().SimulationStream(scenario._loaded, scenario.seed)

    def __iter__(self):
        return self._stream

    @property
    def rig(self):
        """`aims.Rig`: the sensors as they are mounted by design."""
        return self._stream.rig

    @property
    def truth(self):
        """`aims.Truth` of what was simulated so far."""
        return Truth(self._stream.truth)


def simulate(scenario, seed=None, overrides=None):
    """The measurements of a scenario, as `aims.Simulation`; the same seed gives the same bytes."""
    return Simulation(_scenario(scenario, seed, overrides))


class RunResult:
    """What `aims.run` yields.

    estimators  {label: Outcome}
    scores      Scores: the same as scores.json of `aims run`
    truth       Truth
    """

    def __init__(self, estimators, record, truth):
        self.estimators = estimators
        self.truth = truth
        aligned = aligned_estimates(estimators, truth.trajectory)
        self.scores = Scores(record, truth.trajectory, aligned)

    def __getitem__(self, name):
        return self.estimators[name]

    def __repr__(self):
        return repr_of_result("RunResult", self.estimators, self.scores)


def run(scenario, estimators=None, seed=None, overrides=None, cache=""):
    """Simulates a scenario, runs estimators on it and scores them, as `aims run` does.

    estimators  as of `aims.estimate`; in a dict also an object with add_imu, add_scan and add_legs
                (`aims.PythonEstimator`), or a class, which gets the rig; None: those of the scenario
    cache       folder of simulated sequences; "": the one that all commands have in common
    """
    scenario = _scenario(scenario, seed, overrides)
    sequence = _sim().Sequence(scenario._loaded, scenario.seed, cache)
    own, native = {}, {}
    given = sequence.specs if estimators is None else estimators
    for label, each in given.items() if isinstance(given, dict) else ():
        is_own = hasattr(each, "add_scan") or hasattr(each, "add_legs") or isinstance(each, type)
        (own if is_own else native)[label] = each
    outcomes, record = {}, None
    for spec in specs(native if isinstance(given, dict) else given):
        record = _merged(record, *_labelled(outcomes, sequence.evaluate(spec)))
    for label, each in own.items():
        record = _merged(record, *_labelled(outcomes, _judged(sequence, label, each)))
    if own:  # in the order given
        outcomes = {label: outcomes[label] for label in given}
        record["estimators"] = {label: record["estimators"][label] for label in given}
    return RunResult(outcomes, record, Truth(sequence.truth))


def _judged(sequence, label, estimator):
    """Feeds the caller's own estimator and scores it."""
    if isinstance(estimator, type):
        estimator = estimator(sequence.rig)
    begin = time.perf_counter()
    trajectory = drive(estimator, sequence.replay)
    return sequence.judge(label, trajectory, time.perf_counter() - begin)


def _labelled(outcomes, evaluated):
    values, record = evaluated
    (label,) = record["estimators"]
    outcomes[label] = Outcome(values)
    return (record,)


def _merged(record, other):
    """Two records of one run as one."""
    if record is None:
        return other
    record["estimators"].update(other["estimators"])
    record["wall_s"].update(other["wall_s"])
    return record
