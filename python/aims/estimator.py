# SPDX-License-Identifier: BSD-3-Clause
"""Estimators fed by the caller's own loop."""

from . import _core
from .errors import optional
from .settings import pairs


class Estimator(_core.Estimator):
    """An estimator of the registry (`aims.estimators()`).

    name      e.g. "aims_d"
    settings  its parameters, nested or dotted: {"degeneracy": {"eta": 3}}; see `aims.parameters`
    rig       `aims.Rig`: where LiDAR and leg odometry are

    Feed it with add_imu, add_scan and add_legs, or with add and the measurements of a recording or a
    simulation, in order of arrival; then call finish. Native work releases the interpreter's lock.
    """

    def __init__(self, name="aims_d", settings=None, rig=None):
        super().__init__(name, pairs(settings), rig if rig is not None else _core.Rig())

    def frame(self):
        """A pandas frame with a row per scan: the stamp [ns] and each series of the diagnostics."""
        return frame_of(self.result()["diagnostics"], "Estimator.frame()")

    @property
    def diagnostics(self):
        """{"stamp": (N,) int64 [ns], name of a series: (N,) float64}; NaN is not computed."""
        return self.result()["diagnostics"]


def frame_of(columns, what):
    """A pandas frame of a dict of columns; `what` is for the error where there is no pandas."""
    return optional("pandas", "python3-pandas", what).DataFrame(columns)


def estimators():
    """Names and descriptions of all estimators: {"aims": "...", ...}."""
    return _core.estimators()


def parameters(name, settings=None):
    """Every parameter of an estimator: dicts with key, value, unit, expected, meaning, source, idle."""
    return _core.parameters(name, pairs(settings))
