# SPDX-License-Identifier: BSD-3-Clause
import gc
import threading

import aims
import numpy as np
import pytest

MS = 1_000_000
AT_REST = ((0.0, 0.0, 9.81), (0.0, 0.0, 0.0))


def room(rng, count=4000):
    """Points on the walls of a box of 8 by 6 by 3 m around the sensor."""
    half = np.array([4.0, 3.0, 1.5])
    points = rng.uniform(-half, half, (count, 3))
    axis = rng.integers(0, 3, count)
    points[np.arange(count), axis] = half[axis] * rng.choice([-1, 1], count)
    return points.astype("float32")


def straight_walk(estimator, speed=0.5, seconds=8.0):
    """Ten seconds of legs and IMU with empty scans: standing, then walking along x."""
    for now in range(0, int(seconds * 1e9), 5 * MS):
        velocity = speed if now > 4000 * MS else 0.0
        estimator.add_legs(now, None, (velocity, 0, 0), (0, 0, 0))
        if now % (20 * MS) == 0:
            estimator.add_imu(now, *AT_REST)
        if now % (100 * MS) == 0:
            estimator.add_scan(now - 100 * MS, np.empty((0, 3)), [], end=now)
    estimator.finish()


def test_legs_alone_walk_the_distance_that_they_report():
    estimator = aims.Estimator("aims")
    straight_walk(estimator)
    stamp, pose = estimator.pose()
    assert pose.shape == (4, 4)
    assert 1.9 < pose[0, 3] < 2.1
    assert stamp == estimator.trajectory.stamps[-1]


def test_a_still_room_gives_a_still_pose():
    estimator = aims.Estimator("aims_d")
    points = room(np.random.default_rng(1))
    offsets = np.linspace(0, 99 * MS, len(points)).astype(int)
    reported = []
    for now in range(0, 6000 * MS, 20 * MS):
        # A scan waits for the samples of its end, so that its pose may come with a later measurement.
        reported.append(estimator.add_imu(now, *AT_REST))
        if now % (100 * MS) == 0 and now > 0:
            reported.append(estimator.add_scan(now - 100 * MS, points, offsets, end=now))
    estimator.finish()
    stamps = [each[0] for each in reported if each is not None]
    assert stamps == list(estimator.trajectory.stamps[: len(stamps)]) and len(stamps) > 20
    stamp, pose = estimator.pose()
    assert stamp > 5000 * MS
    assert np.abs(pose[:3, 3]).max() < 0.02
    assert len(estimator.map_points()) > 100
    diagnostics = estimator.diagnostics
    assert diagnostics["stamp"].dtype == np.int64
    assert len(diagnostics["iterations"]) == len(diagnostics["stamp"]) > 20
    assert estimator.result()["position_covariances"].shape[1:] == (3, 3)


def test_settings_are_those_of_the_program():
    nested = aims.Estimator("aims", {"degeneracy": {"eta": 5, "alpha": 0.5}})
    dotted = aims.Estimator("aims", {"degeneracy.eta": 5.0, "degeneracy.alpha": 0.5})
    assert nested.config == dotted.config
    assert "eta: 5" in nested.config
    values = {each["key"]: each["value"] for each in aims.parameters("aims", {"degeneracy.eta": 5})}
    assert values["degeneracy.eta"] == "5"


@pytest.mark.parametrize(
    "name, settings, message",
    [
        ("aims_dd", {}, "no estimator 'aims_dd'.*did you mean 'aims_d'"),
        ("aims", {"degeneracy.etta": 1}, "did you mean 'degeneracy.eta'"),
        ("aims", {"degeneracy.eta": -1}, "degeneracy.eta: .-1. is not a number in"),
        ("aims", {"degeneracy": {"eta": None}}, "degeneracy.eta: expected a number"),
        ("aims_d", {"degeneracy.eta": 3}, "has no effect: degeneracy.enabled is false"),
    ],
)
def test_a_wrong_setting_gets_the_error_of_the_program(name, settings, message):
    with pytest.raises(aims.Error, match=message):
        aims.Estimator(name, settings)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ((1.5, np.zeros((1, 3)), [0]), "stamp: expected whole nanoseconds"),
        ((0, np.zeros((2, 2)), [0, 0]), r"xyz: expected shape \(N, 3\)"),
        ((0, np.zeros((2, 3)), [0]), "offsets: expected one per point"),
        ((0, np.zeros((2, 3)), [0.0, 0.1]), "offsets: expected whole numbers"),
        ((0, np.zeros((2, 3)), [0, 2**40]), "offsets: entry 1 is 1099511627776"),
        ((0, np.zeros((2, 3)), [0, 0], [0, -1]), "rings: entry 1 is -1"),
        ((0, np.zeros((2, 3)), [0, 0], None, [0.5]), "intensity: expected one per point"),
        ((0, "points", [0, 0]), "xyz: expected an array"),
        ((5, np.zeros((0, 3)), [], None, None, 4), "end: expected 5 ns"),
    ],
)
def test_a_malformed_scan_is_named(arguments, message):
    with pytest.raises(aims.Error, match=message):
        aims.Estimator("lio").add_scan(*arguments)


def test_malformed_samples_and_rigs_are_named():
    estimator = aims.Estimator("aims")
    with pytest.raises(aims.Error, match=r"specific_force: expected three numbers"):
        estimator.add_imu(0, (0, 0), (0, 0, 0))
    with pytest.raises(aims.Error, match="orientation: expected a quaternion"):
        estimator.add_imu(0, (0, 0, 9.81), (0, 0, 0), (1, 0, 0))
    with pytest.raises(aims.Error, match="joint_position: expected 12 numbers"):
        estimator.add_legs(0, None, (0, 0, 0), (0, 0, 0), joint_position=[0.0])
    with pytest.raises(aims.Error, match="pose: expected a rigid transform"):
        estimator.add_legs(0, 2 * np.eye(4), (0, 0, 0), (0, 0, 0))
    with pytest.raises(aims.Error, match="T_body_lidar: expected a pose as a matrix"):
        aims.Rig(T_body_lidar=np.eye(3))
    estimator.finish()
    with pytest.raises(aims.Error, match="has finished"):
        estimator.add_imu(0, *AT_REST)


def test_poor_data_are_counted_and_raise_nothing():
    estimator = aims.Estimator("aims")
    straight_walk(estimator, seconds=5.0)
    before = dict(estimator.result()["counts"])
    again = aims.Estimator("aims")
    again.add_imu(10 * MS, (np.nan, 0, 9.81), (0, 0, 0))
    straight_walk(again, seconds=5.0)
    assert again.result()["counts"] != before


def test_views_of_a_scan_outlive_it_and_copy_nothing():
    points = room(np.random.default_rng(2), 1000)
    scan = aims.LidarScan(7, points, np.arange(1000), rings=np.arange(1000) % 16)
    xyz, structured, rings = scan.xyz, scan.points, scan.rings
    assert np.shares_memory(xyz, structured)
    assert not xyz.flags.writeable and not structured.flags.owndata
    del scan
    gc.collect()
    np.testing.assert_array_equal(xyz, points)
    np.testing.assert_array_equal(structured["z"], points[:, 2])
    np.testing.assert_array_equal(structured["time_offset_ns"], np.arange(1000))
    np.testing.assert_array_equal(rings, np.arange(1000) % 16)
    with pytest.raises(ValueError):
        xyz[0, 0] = 1.0
    assert len(aims.LidarScan(0, np.empty((0, 3)), []).points) == 0


def test_threads_may_use_estimators_at_the_same_time():
    expected = aims.Estimator("aims")
    straight_walk(expected)
    estimators = [aims.Estimator("aims") for _ in range(4)]
    threads = [threading.Thread(target=straight_walk, args=(each,)) for each in estimators]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    for each in estimators:
        np.testing.assert_array_equal(each.trajectory.positions, expected.trajectory.positions)
