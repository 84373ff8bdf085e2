# SPDX-License-Identifier: BSD-3-Clause
"""What Python adds to a scan: `python3 -m aims.overhead RECORDING`.

Prints the wall time per scan, with all samples since the scan before, of three parts:
native   `leg` as the program runs it, which hardly works itself
loop     the same measurements through a loop in Python into `leg`
process  an estimator in Python that does nothing, in the process that `aims run` gives it
"""

import sys
import time

import aims

from .interface import PythonEstimator


class Idle(PythonEstimator):
    """Takes all measurements and returns a pose per scan, always the same."""

    def __init__(self, rig):
        super().__init__(rig)
        import numpy

        self.pose = numpy.eye(4)

    def add_imu(self, stamp, specific_force, angular_velocity, orientation=None):
        """Nothing."""

    def add_legs(self, stamp, pose, linear_velocity, angular_velocity, contact=None,
                 joint_position=None, joint_velocity=None):
        """Nothing."""

    def add_scan(self, stamp, xyz, offsets, rings=None, intensity=None, end=None):
        """The pose."""
        return self.pose


def loop_ms(measurements, rig):
    """Wall time per scan of a loop in Python into `leg` [ms]."""
    estimator = aims.Estimator("leg", rig=rig)
    begin = time.perf_counter()
    for each in measurements:
        estimator.add(each)
        if isinstance(each, aims.LidarScan):
            each.xyz  # a view, as an estimator in Python takes it
    scans = sum(isinstance(each, aims.LidarScan) for each in measurements)
    return 1e3 * (time.perf_counter() - begin) / scans


def main(path):
    """Measures and prints."""
    recording = aims.Recording(path)
    measurements = list(recording)
    points = [len(each) for each in measurements if isinstance(each, aims.LidarScan)]
    print(f"{len(points)} scans, {sum(points) / len(points):.0f} points each; ms per scan:")
    result = aims.estimate(path, {"native": "leg", "idle": "python:aims.overhead.Idle"})
    native = result["native"].wall_s * 1e3 / len(points)
    print(f"native   {native:.3f}")
    print(f"loop     {loop_ms(measurements, recording.rig):.3f}")
    times = sorted(result["idle"].wall_ms)
    print(f"process  {sum(times) / len(times):.3f} mean, {times[len(times) // 2]:.3f} median")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python3 -m aims.overhead RECORDING")
    main(sys.argv[1])
