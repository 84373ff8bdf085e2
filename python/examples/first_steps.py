# SPDX-License-Identifier: BSD-3-Clause
"""Simulates a walk, runs estimators on it and scores them: `python3 first_steps.py [FOLDER]`.

The cells, which begin with `# %%`, are those of a notebook.
"""

import pathlib
import sys

import aims
import numpy as np

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
folder.mkdir(parents=True, exist_ok=True)

# %% A scenario: one of the shipped ones with other values, which are checked as by the program.
scenario = aims.Scenario(
    "severity_5",
    seed=1,
    overrides={
        "route": {
            "stand_before": 2.5,
            "points": [{"name": "a", "x": 0, "y": 0}, {"name": "b", "x": 4, "y": 0}],
        },
        "lidar": {"columns": 450, "range_max": 30},
    },
)
print(f"{scenario.name}: {scenario.description}")

# %% The measurements, in order of arrival, into an estimator of the project.
simulation = aims.simulate(scenario)
estimator = aims.Estimator("aims_d", rig=simulation.rig)
points = []
for measurement in simulation:
    estimator.add(measurement)
    if isinstance(measurement, aims.LidarScan):
        points.append(len(measurement.xyz))  # a view: nothing is copied
estimator.finish()
truth = simulation.truth
print(f"{len(points)} scans of {np.mean(points):.0f} points; end: {truth.end}")
print(f"estimated {estimator.trajectory}")


# %% An estimator of one's own: here the odometry of the legs, moved from the base to the IMU.
class LegOdometry(aims.PythonEstimator):
    """The pose that the robot reports, relative to the first."""

    def __init__(self, rig):
        super().__init__(rig)
        self.T_start_odom = None

    def add_legs(self, stamp, pose, linear_velocity, angular_velocity, contact=None,
                 joint_position=None, joint_velocity=None):
        T_odom_body = pose @ np.linalg.inv(self.rig.T_body_base)
        if self.T_start_odom is None:
            self.T_start_odom = np.linalg.inv(T_odom_body)
        return self.T_start_odom @ T_odom_body


own = aims.replay(aims.simulate(scenario), LegOdometry(simulation.rig))

# %% Scores, the same as those of `aims score`.
a, b = (1e-9 * stamp for _, stamp in truth.waypoint_times[:2])
scores = aims.score(
    truth.trajectory, {"aims_d": estimator.trajectory, "own": own}, segments=f"a-b={a}:{b}"
)
for name in scores.names:
    found = scores[name]
    print(f"{name:8} ATE {found['ate_yaw_m']:.3f} m, M_list {found['m_list_percent']['all']:.2f} %")

# %% Simulated, estimated and scored in one call.
result = aims.run(scenario, {"lio": "lio", "own": LegOdometry})
for name, outcome in result.estimators.items():
    print(f"{name:8} {len(outcome.trajectory)} poses, ATE {result.scores[name]['ate_yaw_m']:.3f} m")

# %% A frame of pandas and a picture of matplotlib, where these are installed.
try:
    print(scores.frame()[["ate_yaw_m", "m_end_m", "coverage", "success"]])
    import matplotlib

    matplotlib.use("Agg")
    axes = aims.plot_trajectories({"truth": truth.trajectory, **scores.aligned})
    axes.set_aspect("auto")  # the lateral deviations are of centimetres
    axes.figure.set_size_inches(7, 3)
    axes.figure.savefig(folder / "first_steps.png", dpi=110)
except ImportError as missing:
    print(missing)
