# SPDX-License-Identifier: BSD-3-Clause
import json

import aims
import numpy as np
import pytest
from conftest import program


def test_a_loop_over_a_recording_estimates_what_the_program_does(bag, estimated):
    recording = aims.Recording(bag)
    assert recording.has["legs"] and recording.topics["lidar"] == "/lidar/points"
    estimator = aims.Estimator("aims_d", rig=recording.rig)
    kinds = set()
    arrival = 0
    for measurement in recording:
        assert measurement.arrival >= arrival
        arrival = measurement.arrival
        kinds.add(type(measurement).__name__)
        estimator.add(measurement)
    estimator.finish()
    assert kinds == {"ImuSample", "LegSample", "LidarScan"}
    estimator.trajectory.write(estimated.parent / "mine.tum")
    assert (estimated.parent / "mine.tum").read_bytes() == (estimated / "aims_d.tum").read_bytes()


def test_arrays_of_the_measurements_give_the_same_estimate(bag, estimated):
    recording = aims.Recording(bag)
    estimator = aims.Estimator("aims_d", rig=recording.rig)
    for each in recording:
        if isinstance(each, aims.ImuSample):
            estimator.add_imu(each.stamp, each.specific_force, each.angular_velocity,
                              each.orientation, arrival=each.arrival)
        elif isinstance(each, aims.LidarScan):
            estimator.add_scan(each.stamp, each.xyz, each.offsets, each.rings, each.intensity,
                               end=each.end, arrival=each.arrival)
        else:
            estimator.add_legs(each.stamp, each.pose, each.linear_velocity, each.angular_velocity,
                               each.contact, each.joint_position, each.joint_velocity,
                               arrival=each.arrival, contact_force=each.contact_force)
    estimator.finish()
    program_made = aims.read_trajectory(estimated / "aims_d.tum")
    np.testing.assert_array_equal(estimator.trajectory.stamps, program_made.stamps)
    # A pose of the legs goes through a matrix, which rounds it.
    np.testing.assert_allclose(estimator.trajectory.positions, program_made.positions, atol=1e-9)


def test_measurements_outlive_their_recording(bag):
    scans = [each for each in aims.Recording(bag) if isinstance(each, aims.LidarScan)][:3]
    again = [each for each in aims.Recording(bag) if isinstance(each, aims.LidarScan)][:3]
    for one, other in zip(scans, again):
        np.testing.assert_array_equal(one.points, other.points)
        assert np.isfinite(one.xyz).all() and one.end > one.stamp


def test_estimate_gives_the_trajectories_and_scores_of_the_program(bag, estimated):
    result = aims.estimate(bag, {"aims_d": "aims_d", "odometry": "leg"})
    written = aims.read_trajectory(estimated / "aims_d.tum")
    np.testing.assert_array_equal(result["aims_d"].trajectory.positions, written.positions)
    scores = json.loads((estimated / "scores.json").read_text())
    for key in ("ate_m", "m_end_m", "coverage", "success", "rpe_1m"):
        assert result.scores["aims_d"][key] == scores["estimators"]["aims_d"][key]
        assert result.scores["odometry"][key] == scores["estimators"]["leg"][key]
    assert result.summary["schema"] == "aims.estimate/1"
    assert len(result["aims_d"].map) > 100 and len(result["aims_d"].cpu_ms) > 10


def test_score_is_that_of_the_program(folder, bag, estimated):
    program("score", "--truth", "estimated/truth.tum", "--estimate", "estimated/aims_d.tum",
            "--estimate", "estimated/leg.tum", "--quiet", "--no-pictures", "--no-page", "-o",
            "scored", cwd=folder)
    expected = json.loads((folder / "scored" / "scores.json").read_text())["estimators"]
    truth = aims.read_trajectory(estimated / "truth.tum")
    scores = aims.score(truth, {"aims_d": estimated / "aims_d.tum",
                                "leg": aims.read_trajectory(estimated / "leg.tum")})
    for name in ("aims_d", "leg"):
        for key, value in expected[name].items():
            if key not in ("source", "kind"):
                assert scores[name][key] == value, key
    assert len(scores.aligned["leg"]) == len(aims.read_trajectory(estimated / "leg.tum"))


def test_the_truth_is_of_the_recording_and_exact(bag, estimated):
    truth = aims.Recording(bag).truth()
    np.testing.assert_array_equal(truth.positions,
                                  aims.read_trajectory(estimated / "truth.tum").positions)
    perfect = aims.score(truth, {"truth itself": truth})
    assert perfect["truth itself"]["ate_m"] == 0.0


def test_errors_are_those_of_the_program(tmp_path, bag):
    with pytest.raises(aims.Error, match="none.bag"):
        aims.Recording(tmp_path / "none.bag")
    with pytest.raises(aims.Error, match="recording.topics.lidr"):
        aims.Recording(bag, {"topics": {"lidr": "/x"}})
    with pytest.raises(aims.Error, match="/x"):
        aims.Recording(bag, {"topics": {"lidar": "/x"}})
    with pytest.raises(aims.Error, match="did you mean 'leg'"):
        aims.estimate(bag, ["legs"])
    with pytest.raises(aims.Error, match="scoring.max_gab"):
        aims.score("a", {"b": "c"}, settings={"max_gab": 1})
    broken = tmp_path / "broken.bag"
    broken.write_bytes(bag.read_bytes()[: bag.stat().st_size // 2])
    with pytest.raises(aims.Error, match="broken.bag"):
        aims.Recording(broken)
    assert len([each for each in aims.Recording(broken, recover=True)]) > 10


def test_a_recording_without_truth_says_so(bag, tmp_path):
    content = bag.read_bytes()
    topic = aims.Recording(bag).topics["truth"].encode()
    other = tmp_path / "other.bag"
    other.write_bytes(content.replace(topic, b"/" + b"x" * (len(topic) - 1)))
    recording = aims.Recording(other)
    assert not recording.has["truth"] and repr(recording).startswith("Recording ")
    with pytest.raises(aims.Error, match="other.bag: holds no ground truth .* settings="):
        recording.truth()
    assert aims.estimate(other, "leg").scores is None
