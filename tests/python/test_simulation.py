# SPDX-License-Identifier: BSD-3-Clause
import json
import pathlib
import subprocess
import sys

import aims
import numpy as np
import pytest
from conftest import program


def test_simulated_measurements_are_those_that_the_program_records(folder, bag):
    simulation = aims.simulate(folder / "walk.yaml")
    made = list(simulation)
    recorded = list(aims.Recording(bag))
    scans = [[each for each in of if isinstance(each, aims.LidarScan)] for of in (made, recorded)]
    assert abs(len(scans[0]) - len(scans[1])) <= 1 and len(scans[0]) > 20
    for one, other in zip(*scans):
        np.testing.assert_array_equal(one.xyz, other.xyz)
        np.testing.assert_array_equal(one.rings, other.rings)
    truth = simulation.truth
    assert truth.end == "route_done" and [name for name, _ in truth.waypoint_times] == ["a", "b"]
    assert len(truth.velocities) == len(truth.trajectory)
    # The truth's velocity is the derivative of its positions.
    seconds = truth.trajectory.seconds
    moved = np.gradient(truth.trajectory.positions[:, 0], seconds)
    assert np.abs(moved - truth.velocities[:, 0])[5:-5].mean() < 0.01


def test_the_same_seed_gives_the_same_bytes_and_another_one_does_not():
    def first(seed):
        return next(each for each in aims.simulate("corridor", seed=seed)
                    if isinstance(each, aims.LidarScan))

    np.testing.assert_array_equal(first(3).points, first(3).points)
    assert first(3).points.tobytes() != first(4).points.tobytes()


def test_overrides_act_and_their_errors_are_those_of_the_program():
    near = aims.Scenario("corridor", overrides={"lidar": {"range_max": 5}})
    scan = next(each for each in aims.simulate(near) if isinstance(each, aims.LidarScan))
    assert 4.0 < np.linalg.norm(scan.xyz, axis=1).max() < 5.2
    assert "range_max: 5" in near.config
    for overrides, message in (
        ({"lidar.rang_max": 5}, "did you mean 'lidar.range_max'"),
        ({"lidar.range_max": -5}, "lidar.range_max: .-5. is not a number in"),
        ({"route": {"points": [{"z": 1}]}}, "route.points.0.z"),
    ):
        with pytest.raises(aims.Error, match=message):
            aims.Scenario("corridor", overrides=overrides)
    with pytest.raises(aims.Error, match="did you mean 'corridor'"):
        aims.Scenario("coridor")
    with pytest.raises(aims.Error, match="belong to the Scenario"):
        aims.run(near, seed=2)


def test_run_gives_the_scores_of_the_program(folder):
    program("run", "walk.yaml", "--quiet", "--no-pictures", "--no-page", "-o", "native", cwd=folder)
    expected = json.loads((folder / "native" / "scores.json").read_text())
    result = aims.run(folder / "walk.yaml", cache=folder / "cache")
    record = json.loads(json.dumps(result.scores.record))
    times = ("time_per_scan_ms", "cpu_per_scan_ms")
    for of in (expected, record):
        del of["wall_s"]
        of.pop("expectations", None)
        for scores in of["estimators"].values():
            for key in times:
                del scores[key]
    assert record == expected
    for name in ("aims_d", "leg"):
        written = aims.read_trajectory(folder / "native" / f"{name}.tum")
        np.testing.assert_array_equal(result[name].trajectory.positions, written.positions)


def test_results_show_their_scores_and_draw_every_estimate(folder):
    result = aims.run(folder / "walk.yaml", ["aims_d", "leg"], cache=folder / "cache")
    shown = repr(result)
    assert shown.startswith("RunResult: aims_d, leg") and "ATE" in shown and "success" in shown
    assert repr(result["leg"]).startswith("Outcome: ") and "route_done" in repr(result.truth)
    assert set(result.scores.aligned) == {"aims_d", "leg"}
    for name, aligned in result.scores.aligned.items():
        own = result[name].trajectory
        # Laid on at the start, so that both begin where the robot stands, and of the same shape.
        start = result.truth.trajectory.positions[0]
        np.testing.assert_allclose(aligned.positions[0], start, atol=0.01)
        lengths = [np.linalg.norm(np.diff(each.positions, axis=0), axis=1) for each in (own, aligned)]
        np.testing.assert_allclose(*lengths, atol=1e-9)
    pyplot = pytest.importorskip("matplotlib.pyplot")
    pyplot.switch_backend("Agg")
    axes = result.scores.plot()
    assert [line.get_label() for line in axes.lines] == ["truth", "aims_d", "leg"]


def test_the_scenarios_of_a_folder_are_listed_by_tag(tmp_path):
    (tmp_path / "one.yaml").write_text("description: first\ntags: [short]\n")
    (tmp_path / "two.yaml").write_text("base: one\ntags: [long]\n")
    assert aims.scenarios(folder=tmp_path) == {"one": "first", "two": "first"}
    assert list(aims.scenarios(tags=["long"], folder=tmp_path)) == ["two"]
    assert (pathlib.Path(aims.scenario_folder()) / "paper" / "corridor.yaml").exists()


def test_without_the_simulation_its_package_is_named():
    code = (
        "import sys; sys.modules['aims._sim'] = None; import aims\n"
        "try: aims.simulate('corridor')\n"
        "except aims.MissingPackage as error: print(error)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "python3-aims-sim" in done.stdout
