# SPDX-License-Identifier: BSD-3-Clause
"""Localization of legged robots, measured against known truth.

Estimators, recordings and scores need nothing but NumPy. Scenarios and the simulation are in an
extension module of their own, which is imported when they are first used.
"""

import os
import sys

from ._core import ImuSample, LegSample, LidarScan, Rig, __version__
from .errors import Error, MissingPackage
from .estimator import Estimator, estimators, parameters
from .interface import PythonEstimator, replay
from .plots import plot_series, plot_trajectories
from .recording import EstimateResult, Outcome, Recording, Scores, estimate, score
from .simulation import (
    RunResult,
    Scenario,
    Simulation,
    Truth,
    run,
    scenario_folder,
    scenarios,
    simulate,
)
from .trajectory import Trajectory, read_trajectory

# Estimators in Python run under the interpreter that imported this package.
os.environ.setdefault("AIMS_PYTHON", sys.executable)

__all__ = [
    "Error",
    "EstimateResult",
    "Estimator",
    "ImuSample",
    "LegSample",
    "LidarScan",
    "MissingPackage",
    "Outcome",
    "PythonEstimator",
    "Recording",
    "Rig",
    "RunResult",
    "Scenario",
    "Scores",
    "Simulation",
    "Trajectory",
    "Truth",
    "__version__",
    "estimate",
    "estimators",
    "parameters",
    "plot_series",
    "plot_trajectories",
    "read_trajectory",
    "replay",
    "run",
    "scenario_folder",
    "scenarios",
    "score",
    "simulate",
]
