# SPDX-License-Identifier: BSD-3-Clause
"""Estimators in Python for the tests: sound ones, and each kind of failure."""

import ctypes
import os
import subprocess
import time

import numpy as np


class Legs:
    """The robot's own odometry, relative to the first pose, `scale` times as long."""

    def __init__(self, rig, scale=1.0, only_first=0):
        self.T_base_body = np.linalg.inv(rig.T_body_base)
        self.scale = scale
        self.only_first = only_first
        self.T_start_odom = None
        self.count = 0

    def add_legs(self, stamp, pose, linear_velocity, angular_velocity, contact, joint_position,
                 joint_velocity):
        T_odom_body = pose @ self.T_base_body
        if self.T_start_odom is None:
            self.T_start_odom = np.linalg.inv(T_odom_body)
        self.count += 1
        if self.only_first and self.count > self.only_first:
            return None
        relative = self.T_start_odom @ T_odom_body
        relative[:3, 3] *= self.scale
        return relative


class Nested(Legs):
    """The poses as nested lists, every second one in a list of one."""

    def add_legs(self, *arguments):
        pose = super().add_legs(*arguments).tolist()
        return [pose] if self.count % 2 else pose


class Unrigid(Legs):
    """No pose is one."""

    def add_legs(self, *arguments):
        return 2.0 * super().add_legs(*arguments)


class NotFinite(Legs):
    """Every tenth pose is not finite."""

    def add_legs(self, *arguments):
        pose = super().add_legs(*arguments)
        return pose * np.nan if self.count % 10 == 0 else pose


class Keeps:
    """Keeps every scan, and raises at the end if one of them has changed since."""

    def __init__(self, rig):
        self.kept = []
        self.samples = []

    def add_imu(self, stamp, specific_force, angular_velocity, orientation):
        self.samples.append((specific_force, specific_force.sum()))

    def add_scan(self, stamp, xyz, offsets, rings, intensity, end):
        assert end > stamp and offsets.min() >= 0 and rings.max() < 16
        assert not xyz.flags.writeable
        if len(self.kept) % 3 != 2:  # some are given back
            self.kept.append((xyz, xyz.sum(), offsets[::2], offsets[::2].sum()))
        else:
            self.kept.append((xyz[:0], 0.0, offsets[:0], 0))
        return (end, np.eye(4))

    def finish(self):
        assert len(self.kept) > 20
        for xyz, total, offsets, sum_of_offsets in self.kept:
            assert xyz.sum() == total and offsets.sum() == sum_of_offsets, "a scan has changed"
        for force, total in self.samples:
            assert force.sum() == total, "a sample has changed"

    def map_points(self):
        return np.concatenate([each[0] for each in self.kept])[:500]


class Fails(Legs):
    """Fails in the way that `how` names, after some time."""

    def __init__(self, rig, how="raise"):
        super().__init__(rig)
        self.how = how
        if how == "constructor":
            raise RuntimeError("the constructor fails")

    def add_legs(self, stamp, pose, *rest):
        if self.count < 200 or self.how == "finish":
            return super().add_legs(stamp, pose, *rest)
        if self.how == "raise":
            return 1 / 0
        if self.how == "exit":
            os._exit(7)
        if self.how == "leave":
            raise SystemExit(3)
        if self.how == "crash":
            ctypes.string_at(0)
        if self.how == "shape":
            return np.eye(3)
        return None

    def finish(self):
        if self.how == "finish":
            raise ValueError("the end fails")


class Hangs(Legs):
    """A call that does not end, in the way that `how` names."""

    def __init__(self, rig, how="sleep"):
        super().__init__(rig)
        self.how = how
        if how == "constructor":
            self.hang()

    def hang(self):
        while self.how != "loop":
            try:
                time.sleep(1000)
            except BaseException:
                if self.how != "stubborn":
                    raise
        while True:
            pass

    def add_scan(self, stamp, *rest):
        if self.count > 200 and self.how != "finish":
            self.hang()

    def finish(self):
        self.hang()


class Slow(Legs):
    """Calls that end, each of them in time, though all that belong to a scan take longer."""

    def add_legs(self, *given):
        if 100 <= self.count < 120:
            time.sleep(0.2)
        return super().add_legs(*given)


class Poor(Legs):
    """Poses that are none, and stamps that go back."""

    def add_legs(self, stamp, pose, *rest):
        good = super().add_legs(stamp, pose, *rest)
        return [(stamp, good), (stamp - 1, good), (stamp + 1, np.full((4, 4), np.nan)),
                (stamp + 2, 2 * np.eye(4))]


class Future(Legs):
    """From its 100th pose on, stamps in another unit: near the last that there are."""

    def add_legs(self, stamp, pose, *rest):
        good = super().add_legs(stamp, pose, *rest)
        return (stamp, good) if self.count < 100 else (2**63 - 10**6 + self.count, good)


class Leaves(Legs):
    """Starts a process that lasts, notes its number, and shortens the shared points."""

    def __init__(self, rig, note="note"):
        super().__init__(rig)
        with open(note, "w") as file:
            file.write(str(subprocess.Popen(["sleep", "1000"]).pid))

    def add_scan(self, stamp, *rest):
        for each in os.listdir("/proc/self/fd"):
            if "memfd:aims_points" in os.path.realpath(f"/proc/self/fd/{each}"):
                os.truncate(f"/proc/self/fd/{each}", 0)


class Needs:
    """A keyword without default."""

    def __init__(self, rig, factor):
        assert factor == 2.5

    def add_scan(self, stamp, *rest):
        return np.eye(4)


class Taken(Legs):
    """A keyword with the name of another parameter."""

    def __init__(self, rig, call_timeout=1.0):
        super().__init__(rig)


class Typed(Legs):
    """A keyword of each type; the trajectory is as long as it should be only if the types are right."""

    def __init__(self, rig, factor: float, count: int = 2, gain: float = 1, on=True, text="2.5", other=None):
        assert isinstance(factor, float) and isinstance(count, int) and isinstance(gain, float)
        assert on in (True, False) and isinstance(text, str)
        super().__init__(rig, factor * count * gain * (2.0 if on else 1.0) * (1 if other is None else other[1]))


class Nothing:
    """None of the methods."""


NO_CLASS = 3
