# SPDX-License-Identifier: BSD-3-Clause
from os import PathLike
from typing import (
    Any, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union,
)

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._core import ImuSample as ImuSample
from ._core import LegSample as LegSample
from ._core import LidarScan as LidarScan
from ._core import Rig as Rig
from ._core import __version__ as __version__

Path = Union[str, PathLike[str]]
Measurement = Union[ImuSample, LegSample, LidarScan]
Settings = Mapping[str, Any]
StampedPose = Tuple[int, NDArray[np.float64]]
Poses = Union[None, NDArray[np.float64], StampedPose, List[Any]]
Floats = NDArray[np.float64]

class Error(ValueError): ...
class MissingPackage(ImportError): ...

class Trajectory:
    stamps: NDArray[np.int64]
    positions: Floats
    quaternions: Floats
    def __init__(self, stamps: ArrayLike, positions: ArrayLike, quaternions: ArrayLike) -> None: ...
    @classmethod
    def from_matrices(cls, stamps: ArrayLike, matrices: ArrayLike) -> Trajectory: ...
    def __len__(self) -> int: ...
    @property
    def seconds(self) -> Floats: ...
    @property
    def matrices(self) -> Floats: ...
    def aligned_to(self, truth: Trajectory) -> Trajectory: ...
    def write(self, path: Path) -> None: ...
    def frame(self) -> Any: ...

def read_trajectory(source: Path) -> Trajectory: ...

class Estimator(_core.Estimator):
    def __init__(
        self, name: str = "aims_d", settings: Optional[Settings] = None, rig: Optional[Rig] = None
    ) -> None: ...
    def frame(self) -> Any: ...
    @property
    def diagnostics(self) -> Dict[str, NDArray[Any]]: ...

def estimators() -> Dict[str, str]: ...
def parameters(name: str, settings: Optional[Settings] = None) -> List[Dict[str, str]]: ...

class PythonEstimator:
    rig: Rig
    def __init__(self, rig: Rig) -> None: ...
    def add_imu(
        self,
        stamp: int,
        specific_force: Floats,
        angular_velocity: Floats,
        orientation: Optional[Floats] = None,
    ) -> Poses: ...
    def add_scan(
        self,
        stamp: int,
        xyz: NDArray[np.float32],
        offsets: NDArray[np.int32],
        rings: Optional[NDArray[np.uint16]] = None,
        intensity: Optional[NDArray[np.float32]] = None,
        end: Optional[int] = None,
    ) -> Poses: ...
    def add_legs(
        self,
        stamp: int,
        pose: Floats,
        linear_velocity: Floats,
        angular_velocity: Floats,
        contact: Optional[NDArray[np.bool_]] = None,
        joint_position: Optional[Floats] = None,
        joint_velocity: Optional[Floats] = None,
    ) -> Poses: ...
    def finish(self) -> Poses: ...
    def map_points(self) -> NDArray[np.float32]: ...

def replay(measurements: Iterable[Measurement], estimator: Any) -> Trajectory: ...

class Recording:
    path: Path
    def __init__(
        self, path: Path, settings: Optional[Settings] = None, recover: bool = False
    ) -> None: ...
    def __iter__(self) -> Iterator[Measurement]: ...
    @property
    def rig(self) -> Rig: ...
    @property
    def topics(self) -> Dict[str, str]: ...
    @property
    def notes(self) -> List[str]: ...
    @property
    def has(self) -> Dict[str, bool]: ...
    @property
    def start(self) -> int: ...
    @property
    def duration(self) -> float: ...
    @property
    def counts(self) -> Dict[str, int]: ...
    def truth(self) -> Trajectory: ...

class Outcome:
    trajectory: Trajectory
    optimized: Optional[Trajectory]
    diagnostics: Dict[str, NDArray[Any]]
    series: List[Dict[str, str]]
    position_covariances: Floats
    rotation_covariances: Floats
    health: List[Dict[str, Any]]
    counts: Dict[str, int]
    map: NDArray[np.float32]
    wall_s: float
    wall_ms: Floats
    cpu_ms: Floats
    def __init__(self, values: Mapping[str, Any]) -> None: ...
    def frame(self) -> Any: ...

class Scores:
    record: Dict[str, Any]
    truth: Optional[Trajectory]
    aligned: Dict[str, Trajectory]
    def __init__(
        self,
        record: Dict[str, Any],
        truth: Optional[Trajectory] = None,
        aligned: Optional[Dict[str, Trajectory]] = None,
    ) -> None: ...
    def __getitem__(self, name: str) -> Dict[str, Any]: ...
    @property
    def names(self) -> List[str]: ...
    @property
    def notes(self) -> List[str]: ...
    def rows(self) -> Dict[str, Dict[str, Any]]: ...
    def frame(self) -> Any: ...
    def plot(self, axes: Any = None) -> Any: ...

class EstimateResult:
    estimators: Dict[str, Outcome]
    truth: Optional[Trajectory]
    scores: Optional[Scores]
    summary: Dict[str, Any]
    failures: Dict[str, str]
    def __init__(self, values: Mapping[str, Any]) -> None: ...
    def __getitem__(self, name: str) -> Outcome: ...

Estimators = Union[str, Sequence[str], Mapping[str, Any]]

def estimate(
    path: Path,
    estimators: Estimators = "aims_d",
    settings: Optional[Settings] = None,
    recover: bool = False,
    jobs: int = 1,
) -> EstimateResult: ...
def score(
    truth: Union[Trajectory, Path],
    estimates: Union[Trajectory, Path, Mapping[str, Union[Trajectory, Path]]],
    waypoint_times: Optional[Path] = None,
    segments: str = "",
    extrinsic: str = "",
    time_offset: float = 0.0,
    settings: Optional[Settings] = None,
) -> Scores: ...

class Scenario:
    seed: int
    def __init__(
        self,
        given: Path,
        seed: Optional[int] = None,
        overrides: Optional[Settings] = None,
        folder: Optional[Path] = None,
    ) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def estimators(self) -> List[str]: ...
    @property
    def config(self) -> str: ...

class Truth:
    trajectory: Trajectory
    velocities: Floats
    angular_velocities: Floats
    waypoint_times: List[Tuple[str, int]]
    end: str
    touched_wall: bool
    def __init__(self, values: Mapping[str, Any]) -> None: ...

class Simulation:
    scenario: Scenario
    def __init__(self, scenario: Scenario) -> None: ...
    def __iter__(self) -> Iterator[Measurement]: ...
    @property
    def rig(self) -> Rig: ...
    @property
    def truth(self) -> Truth: ...

class RunResult:
    estimators: Dict[str, Outcome]
    scores: Scores
    truth: Truth
    def __init__(
        self, estimators: Dict[str, Outcome], record: Dict[str, Any], truth: Truth
    ) -> None: ...
    def __getitem__(self, name: str) -> Outcome: ...

def simulate(
    scenario: Union[Scenario, Path],
    seed: Optional[int] = None,
    overrides: Optional[Settings] = None,
) -> Simulation: ...
def run(
    scenario: Union[Scenario, Path],
    estimators: Optional[Estimators] = None,
    seed: Optional[int] = None,
    overrides: Optional[Settings] = None,
    cache: Path = "",
) -> RunResult: ...
def scenario_folder() -> str: ...
def scenarios(tags: Sequence[str] = (), folder: Optional[Path] = None) -> Dict[str, str]: ...
def plot_trajectories(trajectories: Mapping[str, Trajectory], axes: Any = None) -> Any: ...
def plot_series(
    result: Union[Outcome, Estimator], names: Union[str, Sequence[str]], axes: Any = None
) -> Any: ...
