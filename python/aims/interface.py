# SPDX-License-Identifier: BSD-3-Clause
"""Estimators written in Python."""

import numpy as np

from .trajectory import Trajectory
from .worker import Feeder


def _stub(method):
    method.is_stub = True  # a class that does not write it is not given such measurements
    return method


class PythonEstimator:
    """Base class of estimators in Python; to derive from it is not required.

    `aims run`, `aims suite` and `aims estimate` take such a class as LABEL=python:module.Class+key=value.
    The constructor gets the rig of the sensors and the settings as keywords. Each method that a class
    writes is called with every such measurement, in order of arrival, and returns

    - None: no new pose,
    - a pose: T_odom_body, shape (4, 4), at the stamp of the measurement (of a scan: its end),
    - (stamp, pose): a pose at another stamp [ns],
    - a list of these.

    odom is any fixed frame; body is the frame of the IMU: x forward, y left, z up. Stamps of poses
    must increase: others are left out and counted, as are matrices that are no rigid transform. An
    exception ends the estimator with its traceback; other estimators go on. Arrays that are handed
    over are read-only and stay valid as long as they are referred to.
    """

    def __init__(self, rig):
        self.rig = rig

    @_stub
    def add_imu(self, stamp, specific_force, angular_velocity, orientation=None):
        """An inertial sample.

        stamp             end of the interval that it averages, or the instant sampled [ns], int
        specific_force    (3,) [m/s^2] in body axes: +9.81 upwards at rest
        angular_velocity  (3,) [rad/s] in body axes
        orientation       (4,) x y z w as the IMU reports it, or None
        """

    @_stub
    def add_scan(self, stamp, xyz, offsets, rings=None, intensity=None, end=None):
        """A scan in the order of firing, LiDAR frame, each point as measured (not deskewed).

        stamp      time of the first firing [ns], int
        xyz        (N, 3) float32 [m]
        offsets    (N,) int32: firing time after the stamp [ns]
        rings      (N,) uint16: 0 is the lowest elevation
        intensity  (N,) float32, in [0, 1]
        end        nominal end of the scan [ns], int
        """

    @_stub
    def add_legs(self, stamp, pose, linear_velocity, angular_velocity, contact=None,
                 joint_position=None, joint_velocity=None):
        """Leg odometry as the robot reports it.

        stamp             of the encoders [ns], int
        pose              (4, 4) T_odom_base, in the odometry frame of the robot
        linear_velocity   (3,) of the base, in base axes [m/s]
        angular_velocity  (3,) of the base, in base axes [rad/s]
        contact           (4,) bool: front left, front right, rear left, rear right
        joint_position    (12,) [rad], leg by leg: abduction, hip, knee
        joint_velocity    (12,) [rad/s]
        """

    def finish(self):
        """Called once, after the last measurement; may return poses."""

    def map_points(self):
        """(N, 3) points of the map in the odometry frame [m], for pictures."""
        return np.empty((0, 3), np.float32)


def drive(estimator, replay):
    """Feeds an estimator with what `replay(visit)` visits; the trajectory of its poses."""
    feeder = Feeder(estimator)

    def visit(each):
        kind = type(each).__name__
        if kind == "ImuSample":
            method = feeder.add_imu
            values = (each.stamp, each.specific_force, each.angular_velocity, each.orientation)
        elif kind == "LidarScan":
            method = feeder.add_scan
            values = (each.stamp, each.xyz, each.offsets, each.rings, each.intensity, each.end)
        else:
            method = feeder.add_legs
            values = (each.stamp, each.pose, each.linear_velocity, each.angular_velocity,
                      each.contact, each.joint_position, each.joint_velocity)
        if method is not None:
            feeder.keep(method(*values), each.end if kind == "LidarScan" else each.stamp)

    replay(visit)
    feeder.finish()
    return increasing(feeder.poses)


def increasing(poses):
    """The trajectory of (stamp, pose) whose stamps increase."""
    kept = []
    for stamp, pose in poses:
        if not kept or stamp > kept[-1][0]:
            kept.append((stamp, pose))
    stamps = [stamp for stamp, _ in kept]
    return Trajectory.from_matrices(stamps, [pose for _, pose in kept])


def replay(measurements, estimator):
    """Feeds an estimator with measurements (an `aims.Recording`, `aims.simulate(...)` or a list).

    estimator  an object with any of add_imu, add_scan and add_legs: a `PythonEstimator` or an
               `aims.Estimator`

    Returns the trajectory of its poses.
    """

    def visit_all(visit):
        for each in measurements:
            visit(each)

    return drive(estimator, visit_all)
