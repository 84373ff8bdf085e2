# SPDX-License-Identifier: BSD-3-Clause
"""Recordings, what estimators make of them, and scores."""

from . import _core
from .errors import Error
from .estimator import frame_of
from .settings import assignments, specs


class Recording:
    """A recording of a robot or of `aims simulate`, as an iterator of its measurements.

    path      file of the recording
    settings  keys of the group `recording`, e.g. {"topics": {"lidar": "/points"}}
    recover   read the intact part of a damaged file

    Each loop over it reads the file from its start: ImuSample, LidarScan and LegSample in order of
    record time, as `aims estimate` has them.
    """

    def __init__(self, path, settings=None, recover=False):
        self.path = path
        self._settings = assignments({"recording": settings or {}})
        self._recover = recover
        self._stream = _core.RecordingStream(path, self._settings, recover)
        self._setup = self._stream.setup
        self._truth = None

    def __iter__(self):
        # Later loops leave the counts and the truth of this one as they are.
        self._stream = _core.RecordingStream(self.path, self._settings, self._recover)
        return self._stream

    @property
    def rig(self):
        """`aims.Rig`: the sensors, as transforms and rates of the recording state them."""
        return self._setup["rig"]

    @property
    def topics(self):
        """{"lidar": "/points", ...}: the topics in use."""
        return self._setup["topics"]

    @property
    def notes(self):
        """Assumptions and conversions, a sentence each."""
        return self._setup["notes"]

    @property
    def has(self):
        """{"legs": True, "joints": ..., "point_times", "rings", "orientation", "truth"}."""
        return {key[4:]: value for key, value in self._setup.items() if key.startswith("has_")}

    @property
    def start(self):
        """First record time [ns since the epoch]."""
        return self._setup["start"]

    @property
    def duration(self):
        """Record time from the first to the last message [s]."""
        return 1e-9 * (self._setup["end"] - self._setup["start"])

    @property
    def counts(self):
        """Irregularities of the newest loop so far: {"cloud_points_not_finite": 3, ...}."""
        return self._stream.counts

    def truth(self):
        """True poses of the body, for scoring: `aims.Trajectory`; reads the whole file once.

        `aims.Error` where the recording has none (`has["truth"]`).
        """
        if not self._setup["has_truth"]:
            raise Error(
                f"{self.path}: holds no ground truth that is recognized; a topic of poses is named by "
                'settings={"topics": {"truth": "/topic"}}'
            )
        if self._truth is None:
            stream = _core.RecordingStream(self.path, self._settings, self._recover)
            stream.drain()
            self._truth = stream.truth
        return self._truth


    def __repr__(self):
        topics = ", ".join(f"{sensor} {topic}" for sensor, topic in self.topics.items() if topic)
        return f"Recording {self.path}: {self.duration:.1f} s; {topics}"


class Outcome:
    """What one estimator came to.

    trajectory            aims.Trajectory, T_odom_body at each scan end
    optimized             the same after loop closing or smoothing, or None
    diagnostics           {"stamp": (N,) int64 [ns], name: (N,) float64}, a row per scan
    series                a dict per name: name, unit, meaning
    position_covariances  (N, 3, 3) [m^2], body axes; NaN where none is stated
    rotation_covariances  (N, 3, 3) [rad^2]
    health                a dict per row: stamp, state, reasons, position_sigma
    counts                {"late": 2, ...}
    map                   (M, 3) float32: the local map in the odometry frame [m]
    wall_s                time that it took [s]; wall_ms, cpu_ms: (K,) per scan [ms]
    """

    def __init__(self, values):
        self.__dict__.update(values)

    def frame(self):
        """A pandas frame with a row per scan."""
        return frame_of(self.diagnostics, "Outcome.frame()")

    def __repr__(self):
        return (
            f"Outcome: {len(self.trajectory)} poses, {len(self.map)} points of the map, "
            f"{self.wall_s:.1f} s of work"
        )


class Scores:
    """Scores of trajectories against a truth, the same as those of `aims score`.

    record   what scores.json holds (schema aims.scores/2)
    truth    aims.Trajectory
    aligned  {name: aims.Trajectory}: the estimates, laid onto the truth at the start; `plot` draws them
    """

    def __init__(self, record, truth=None, aligned=None):
        self.record = record
        self.truth = truth
        self.aligned = aligned or {}

    def __getitem__(self, name):
        """The scores of one estimate: a dict."""
        return self.record["estimators"][name]

    @property
    def names(self):
        """Of the estimates."""
        return list(self.record["estimators"])

    @property
    def notes(self):
        """What a reader of the numbers must know, a sentence each."""
        return self.record.get("notes", [])

    def rows(self):
        """{name: {"ate_m": 0.1, "m_list_percent.all": 0.2, ...}}: dotted keys as in scores.csv."""
        return {name: flat(scores) for name, scores in self.record["estimators"].items()}

    def frame(self):
        """A pandas frame with a row per estimate and a column per score."""
        rows = self.rows()
        frame = frame_of(list(rows.values()), "Scores.frame()")
        frame.index = list(rows)
        return frame

    def plot(self, axes=None):
        """Truth and estimates seen from above, on matplotlib axes; returns these."""
        from .plots import plot_trajectories

        return plot_trajectories({"truth": self.truth, **self.aligned}, axes)

    def __repr__(self):
        if not self.names:
            return "Scores: of no estimate"
        width = max(len(name) for name in self.names)
        return "\n".join(["Scores:", *(f"  {name:{width}}  {line_of(self[name])}" for name in self.names)])


def line_of(scores):
    """The main scores of one estimate in words; what is not known is left out."""
    parts = []
    if scores.get("ate_yaw_m") is not None:
        parts.append(f"ATE {scores['ate_yaw_m']:.3f} m")
    m_list = scores.get("m_list_percent", {}).get("all")
    if m_list is not None:
        parts.append(f"M_list {m_list:.2f} %")
    parts.append("success" if scores.get("success") else "no success")
    return ", ".join(parts)


def aligned_estimates(outcomes, truth):
    """{name: its trajectory, laid onto the truth at the start} of those with poses in its time."""
    aligned = {}
    for name, outcome in outcomes.items():
        try:
            aligned[name] = outcome.trajectory.aligned_to(truth)
        except Error:
            continue  # no poses: nothing to draw
    return aligned


def flat(scores, prefix=""):
    """Nested dicts as one, with dotted keys."""
    found = {}
    for key, value in scores.items():
        if isinstance(value, dict):
            found.update(flat(value, f"{prefix}{key}."))
        else:
            found[prefix + key] = value
    return found


class EstimateResult:
    """What `aims.estimate` yields.

    estimators  {label: Outcome}
    truth       aims.Trajectory, or None where the recording has none
    scores      Scores, or None
    summary     what estimate.json holds
    failures    {label: message}: estimators that broke, e.g. in Python
    """

    def __init__(self, values):
        self.estimators = {name: Outcome(each) for name, each in values["estimators"].items()}
        self.truth = values["truth"]
        self.scores = None
        if values["scores"]:
            aligned = aligned_estimates(self.estimators, self.truth)
            self.scores = Scores(values["scores"], self.truth, aligned)
        self.summary = values["summary"]
        self.failures = self.summary["failures"]

    def __getitem__(self, name):
        return self.estimators[name]

    def __repr__(self):
        return repr_of_result("EstimateResult", self.estimators, self.scores, self.failures)


def repr_of_result(name, estimators, scores, failures=()):
    """Scores, or without them each estimator's outcome, and what failed."""
    lines = [f"{name}: {', '.join(estimators) or 'no estimator'}"]
    if scores is not None:
        lines += repr(scores).splitlines()[1:]
    else:
        lines += [f"  {label}  {outcome!r}" for label, outcome in estimators.items()]
    lines += [f"  {label}  FAILED" for label in failures]
    return "\n".join(lines)


def estimate(path, estimators="aims_d", settings=None, recover=False, jobs=1):
    """Runs estimators over a recording as `aims estimate` does.

    estimators  a name, a list of NAME or LABEL=NAME+key=value, or {label: (name, settings)}
    settings    keys as of --set: {"recording": {...}, "scoring": {...}, "estimators": {...}}
    jobs        threads; the trajectories do not depend on it
    """
    given = assignments(settings) + ["run=" + quoted(specs(estimators))]
    return EstimateResult(_core.estimate(path, given, recover, jobs))


def quoted(texts):
    """The setting of a list of texts."""
    import json

    return json.dumps(list(texts))


def score(
    truth,
    estimates,
    waypoint_times=None,
    segments="",
    extrinsic="",
    time_offset=0.0,
    settings=None,
):
    """Scores trajectories of any system as `aims score` does.

    truth, estimates  an aims.Trajectory, or the path of a file or topic ("run.bag:/odom"); the
                      estimates as a dict {name: trajectory}
    waypoint_times    waypoint_times.csv of a run: the reference points of M_list
    segments          "a-b=12.5:110.2" in seconds of the truth, or "a-d" between waypoints
    extrinsic         "x y z qx qy qz qw": pose of the frame of the estimates in the body frame
    time_offset       added to the stamps of the estimates [s]
    settings          keys of the group `scoring`, e.g. {"max_gap": 5}
    """
    given = estimates if isinstance(estimates, dict) else {"estimate": estimates}
    return Scores(
        *_core.score(
            truth,
            given,
            waypoint_times,
            segments,
            extrinsic,
            time_offset,
            assignments({"scoring": settings or {}}),
        )
    )
