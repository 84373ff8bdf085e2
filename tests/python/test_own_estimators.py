# SPDX-License-Identifier: BSD-3-Clause
"""Estimators in Python inside the program."""

import csv
import json
import pathlib
import re
import shutil
import sys

import aims
import numpy as np
import pytest
from conftest import program
from own_estimators import Keeps, Legs

HERE = pathlib.Path(__file__).parent


@pytest.fixture(scope="module")
def own(folder):
    """A folder with walk.yaml, walk.bag and the module of estimators."""
    shutil.copy(HERE / "own_estimators.py", folder)
    return folder


def run(folder, command, *arguments, code=0):
    env = {"AIMS_PYTHON": sys.executable}
    extra = () if command == "suite" else ("--no-pictures",)
    return program(command, *arguments, "--quiet", "--no-page", *extra, cwd=folder, code=code, env=env)


def test_run_and_suite_score_it_like_any_other(own):
    out, _ = run(own, "run", "walk.yaml", "--seeds", "3", "--estimators",
                 "leg,mine=python:own_estimators.Legs,long=python:own_estimators.Legs+scale=1.5",
                 "-o", "run")
    assert "3 jobs done" in out
    scores = json.loads((own / "run" / "scores.json").read_text())["estimators"]
    assert set(scores) == {"leg", "mine", "long"}
    # Oracle: the same class in this process, and the length that it is told to err by.
    here = aims.run(own / "walk.yaml", {"mine": Legs, "leg": "leg"}, seed=3, cache=own / "cache")
    assert list(here.estimators) == ["mine", "leg"], "in the order given"
    for key in ("ate_m", "m_end_m", "coverage", "m_list_percent", "rpe_1m", "success"):
        assert scores["mine"][key] == here.scores["mine"][key], key
        assert scores["leg"][key] == here.scores["leg"][key], key
    mine = aims.read_trajectory(own / "run" / "mine.tum")
    long = aims.read_trajectory(own / "run" / "long.tum")
    np.testing.assert_allclose(long.positions, 1.5 * mine.positions, atol=1e-12)
    assert scores["mine"]["cpu_per_scan_ms"]["mean"] > 0
    out, _ = run(own, "suite", "walk.yaml", "--seeds", "3", "--estimators",
                 "mine=python:own_estimators.Legs", "-o", "suite")
    suite = json.loads((own / "suite" / "suite.json").read_text())
    assert "mine" in json.dumps(suite)


def test_poses_that_are_not_finite_are_counted_and_said(own):
    spec = ("--estimators", "mine=python:own_estimators.NotFinite,leg")
    out, _ = run(own, "run", "walk.yaml", *spec, "-o", "not-finite")
    scores = json.loads((own / "not-finite" / "scores.json").read_text())["estimators"]["mine"]
    assert scores["poses_invalid"] == scores["poses"] // 10 > 0
    assert not scores["success"] and scores["diverged_reason"] == "invalid_pose"
    warning = f"walk mine seed 1: {scores['poses_invalid']} of {scores['poses']} poses left out"
    assert warning in out
    out, _ = run(own, "suite", "walk.yaml", *spec, "-o", "not-finite-suite")
    assert warning in out
    out, _ = run(own, "estimate", "walk.bag", *spec, "-o", "not-finite-bag")
    assert re.search(r"note: mine: \d+ of \d+ poses are not finite or not rigid", out), out
    estimated = json.loads((own / "not-finite-bag" / "scores.json").read_text())["estimators"]
    assert estimated["mine"]["poses_invalid"] > 0 and estimated["leg"]["poses_invalid"] == 0


def test_a_study_of_settings_varies_those_of_the_class_alone(own):
    program("study", "sensitivity", "walk.yaml", "--estimators", "python:own_estimators.Legs",
            "--factors", "2", "--quiet", "-o", "settings", cwd=own,
            env={"AIMS_PYTHON": sys.executable})
    settings = json.loads((own / "settings" / "sensitivity.json").read_text())["settings"]
    assert "scale" in settings and "call_timeout" not in settings


def test_an_unchanged_class_is_not_run_again_and_a_changed_one_is(own):
    (own / "part.py").write_text("FACTOR = 1.0\n")
    (own / "changing.py").write_text(
        "import own_estimators, part\n"
        "class Mine(own_estimators.Legs):\n"
        "    def __init__(self, rig):\n"
        "        super().__init__(rig, part.FACTOR)\n"
    )
    arguments = ("walk.yaml", "--estimators", "python:changing.Mine", "-o", "changing")
    assert "1 jobs done" in run(own, "run", *arguments)[0]
    assert "0 jobs done, 1 found finished" in run(own, "run", *arguments)[0]
    (own / "part.py").write_text("FACTOR = 2.00\n")
    assert "1 jobs done, 0 found finished" in run(own, "run", *arguments)[0]


def test_estimate_gives_the_same_bytes_each_time(own):
    for name in ("first", "second"):
        run(own, "estimate", "walk.bag", "--estimators",
            "keeps=python:own_estimators.Keeps,mine=python:own_estimators.Legs,leg", "-o", name)
    for file in ("keeps.tum", "mine.tum", "leg.tum", "keeps.map.ply"):
        assert (own / "first" / file).read_bytes() == (own / "second" / file).read_bytes()
    recording = aims.Recording(own / "walk.bag")
    here = aims.replay(recording, Legs(recording.rig))
    written = aims.read_trajectory(own / "first" / "mine.tum")
    np.testing.assert_array_equal(here.stamps, written.stamps)
    np.testing.assert_array_equal(here.positions, written.positions)
    assert len(aims.replay(recording, Keeps(recording.rig))) == len(
        aims.read_trajectory(own / "first" / "keeps.tum"))


@pytest.mark.parametrize(
    "how, message",
    [
        ("raise", "add_legs: ZeroDivisionError: division by zero"),
        ("exit", "ended by itself with status 7"),
        ("leave", "add_legs: SystemExit: 3"),
        ("crash", "ended by signal 11"),
        ("shape", r"got shape \(3, 3\)"),
        ("finish", "finish: ValueError: the end fails"),
    ],
)
def test_one_that_fails_is_named_and_the_others_are_kept(own, how, message):
    spec = f"bad=python:own_estimators.Fails+how={how}"
    out = f"failed-{how}"
    _, error = run(own, "estimate", "walk.bag", "--estimators", f"leg,{spec}", "-o", out, code=1)
    assert "bad: FAILED: python:own_estimators.Fails: " in error
    summary = json.loads((own / out / "estimate.json").read_text())
    (failure,) = summary["failures"].values()
    assert pytest.importorskip("re").search(message, failure), failure
    assert len(aims.read_trajectory(own / out / "leg.tum")) > 20
    scores = json.loads((own / out / "scores.json").read_text())["estimators"]
    assert scores["leg"]["success"] and not scores["bad"]["success"]
    if how == "raise":
        assert "Traceback" in error and "own_estimators.py" in error and "1 / 0" in error
    # What came before is kept: all of it, unless the process ended.
    poses = len(aims.read_trajectory(own / out / "bad.tum"))
    assert poses >= 100 if how in ("exit", "crash") else poses >= 200


@pytest.mark.parametrize(
    "how, message, trace",
    [
        ("sleep", "add_scan: the call of the measurement at ", "time.sleep(1000)"),
        ("loop", "add_scan: the call of the measurement at ", "in hang"),
        ("stubborn", "add_scan: the call of the measurement at ", ""),
        ("finish", "finish: the call has not ended", "time.sleep(1000)"),
    ],
)
def test_one_that_hangs_is_ended_and_all_before_is_kept(own, how, message, trace):
    out = f"hangs-{how}"
    _, error = run(own, "estimate", "walk.bag", "--estimators",
                   f"leg,bad=python:own_estimators.Hangs+how={how}+call_timeout=3", "-o", out, code=1)
    assert f"bad: FAILED: python:own_estimators.Hangs: {message}" in error
    assert "has not ended within 3 s (call_timeout)" in error
    assert trace in error and ("Traceback" in error) == bool(trace)
    assert "worker" not in error and "<string>" not in error and "Overdue" not in error
    summary = json.loads((own / out / "estimate.json").read_text())
    assert message in summary["failures"]["bad"]
    assert len(aims.read_trajectory(own / out / "leg.tum")) > 20
    # Oracle: the class whose calls end. The scan that hangs comes after 200 leg packets.
    whole = aims.replay(aims.Recording(own / "walk.bag"), Legs(aims.Recording(own / "walk.bag").rig))
    kept = aims.read_trajectory(own / out / "bad.tum")
    np.testing.assert_array_equal(kept.positions, whole.positions[: len(kept)])
    if how == "finish":
        assert len(kept) == len(whole)
    elif how != "stubborn":  # those of the batch with the scan that hangs, too
        assert 200 < len(kept) < len(whole)
        stamp = float(error.split("measurement at ")[1].split(" s ")[0])
        assert abs(stamp - 1e-9 * kept.stamps[-1]) < 0.2


def test_a_limit_is_that_of_one_call_and_zero_is_none(own):
    for name, limit in (("limited", 2), ("unlimited", 0)):
        run(own, "estimate", "walk.bag", "--estimators",
            f"slow=python:own_estimators.Slow+call_timeout={limit},mine=python:own_estimators.Legs",
            "-o", name)
        assert (own / name / "slow.tum").read_bytes() == (own / name / "mine.tum").read_bytes()


def test_a_hanging_job_fails_and_the_others_are_done(own):
    out, _ = run(own, "run", "walk.yaml", "--estimators",
                 "leg,bad=python:own_estimators.Hangs+call_timeout=3", "-o", "hanging-job", code=1)
    assert "FAILED: walk seed 1 bad: python:own_estimators.Hangs: add_scan: the call of the" in out
    scores = json.loads((own / "hanging-job" / "scores.json").read_text())
    assert list(scores["estimators"]) == ["leg"] and scores["complete"]
    assert [each["estimator"] for each in scores["failures"]] == ["bad"]


def test_a_failed_job_is_recorded_and_the_others_are_done(own):
    out, _ = run(own, "run", "walk.yaml", "--estimators",
                 "leg,bad=python:own_estimators.Fails", "-o", "failed-job", code=1)
    assert "FAILED: walk seed 1 bad: python:own_estimators.Fails: add_legs: ZeroDivisionError" in out
    assert 'own_estimators.py", line' in out
    scores = json.loads((own / "failed-job" / "scores.json").read_text())
    assert list(scores["estimators"]) == ["leg"] and scores["complete"]
    assert [each["estimator"] for each in scores["failures"]] == ["bad"]


@pytest.mark.parametrize(
    "spec, message",
    [
        ("python:own_estimators", "expected python:module.Class"),
        ("python:no_such_module.Mine", "import: ModuleNotFoundError: No module named"),
        ("python:own_estimators.NoSuch", "AttributeError: module 'own_estimators' has no attribute"),
        ("python:own_estimators.Nothing", "has none of the methods add_imu, add_legs, add_scan"),
        ("python:own_estimators.NO_CLASS", "is no class"),
        ("python:own_estimators.Fails+how=constructor", "constructor: RuntimeError: the constructor"),
        ("python:own_estimators.Legs+scal=2", "unknown key 'scal'; did you mean 'scale'"),
        ("python:own_estimators.Needs", "factor: expected a value"),
        ("python:own_estimators.Typed", "factor: expected a value"),
        ("python:own_estimators.Legs+scale=far", "scale: 'far' is not a number"),
        ("python:own_estimators.Typed+factor=1+on=yes", "on: 'yes' is not true or false"),
        ("python:own_estimators.Hangs+how=constructor+call_timeout=3",
         "constructor: the call has not ended within 3 s (call_timeout)"),
        ("python:own_estimators.Taken", "'call_timeout' of the constructor is the name of another"),
        ("python:own_estimators.Legs+call_timeout=-1", "call_timeout: '-1' is not a number in [0,"),
        ("python:own_estimators.Legs+code_hash=0", "code_hash: expected 0, as set; the files have"),
        ("leg=python:own_estimators.Legs", "the label 'leg' is the name of another estimator"),
    ],
)
def test_a_wrong_class_is_an_error_before_the_work(own, spec, message):
    for command, given in (("estimate", "walk.bag"), ("run", "walk.yaml")):
        if command == "run" and "constructor" in spec:
            continue  # a job of its own
        out, error = run(own, command, given, "--estimators", spec, "-o", "wrong", code=2)
        assert message in error, (out, error)
        assert not (own / "wrong").exists()


def test_settings_are_values_of_python(own):
    run(own, "estimate", "walk.bag", "--estimators", "n=python:own_estimators.Needs+factor=2.5",
        "-o", "needs")
    assert len(aims.read_trajectory(own / "needs" / "n.tum")) > 20


def test_settings_have_the_types_of_the_constructor(own):
    settings = "+factor=3+count=3+gain=2+on=false+text=7+other=[0, 0.5]"
    run(own, "estimate", "walk.bag", "--estimators",
        f"mine=python:own_estimators.Legs,n=python:own_estimators.Typed{settings}", "-o", "typed")
    mine = aims.read_trajectory(own / "typed" / "mine.tum")
    typed = aims.read_trajectory(own / "typed" / "n.tum")
    np.testing.assert_allclose(typed.positions, 3 * 3 * 2 * 0.5 * mine.positions, atol=1e-12)


def test_settings_have_keys_below_the_label(own):
    out = ("--estimators", "mine=python:own_estimators.Legs,leg", "-o")
    run(own, "run", "walk.yaml", *out, "keyed", "--set", "estimators.mine.scale=1.5")
    run(own, "run", "walk.yaml", *out, "plain")
    long = aims.read_trajectory(own / "keyed" / "mine.tum")
    plain = aims.read_trajectory(own / "plain" / "mine.tum")
    np.testing.assert_allclose(long.positions, 1.5 * plain.positions, atol=1e-12)
    # The written configuration repeats it, and holds for others too.
    out, _ = run(own, "run", "keyed/config.yaml", "-o", "again")
    assert (own / "again" / "mine.tum").read_bytes() == (own / "keyed" / "mine.tum").read_bytes()
    run(own, "run", "keyed/config.yaml", "--estimators", "leg", "-o", "other")
    run(own, "estimate", "walk.bag", "--estimators", "mine=python:own_estimators.Legs", "-o",
        "estimate-keyed", "--set", "estimators.mine.scale=1.5")
    estimated = aims.read_trajectory(own / "estimate-keyed" / "mine.tum")
    np.testing.assert_allclose(estimated.positions[-1], long.positions[-1], atol=1e-6)


@pytest.mark.parametrize(
    "setting, message",
    [
        ("mine.scal=2", "unknown key 'estimators.mine.scal'; did you mean 'estimators.mine.scale'"),
        ("mine.scale=far", "estimators.mine.scale: 'far' is not a number"),
        ("mine.only_first=1.5", "estimators.mine.only_first: '1.5' is not an integer"),
        ("mine.code_hash=0", "estimators.mine.code_hash: has no effect: it follows from the files"),
        ("other.scale=1", "unknown key 'estimators.other.scale'"),
    ],
)
def test_a_wrong_setting_is_an_error(own, setting, message):
    command = ("estimate", "walk.bag") if "scal" in setting else ("run", "walk.yaml")
    _, error = run(own, *command, "--estimators", "mine=python:own_estimators.Legs", "-o", "wrong",
                   "--set", f"estimators.{setting}", code=2)
    assert message in error, error


def test_a_class_with_two_labels_has_settings_in_its_specs_alone(own):
    _, error = run(own, "run", "walk.yaml", "--estimators",
                   "a=python:own_estimators.Legs,b=python:own_estimators.Legs+scale=2", "-o", "wrong",
                   "--set", "estimators.a.scale=3", code=2)
    assert "python:own_estimators.Legs has several labels; expected LABEL=NAME+key=value" in error


def sweep(own, *arguments, code=0):
    return program("sweep", "--scenarios", "walk.yaml", "--seeds", "3", "--estimators",
                   "mine=python:own_estimators.Legs", "--quiet", "--jobs", "1", *arguments, cwd=own,
                   code=code, env={"AIMS_PYTHON": sys.executable})


def test_settings_are_swept(own):
    sweep(own, "--param", "scale=0.5:2:4", "--param", "estimators.mine.only_first=600:700.4:2",
          "--set", "estimators.mine.call_timeout=30", "-o", "swept")
    program("merge", "swept", cwd=own, env={"AIMS_PYTHON": sys.executable})
    rows = list(csv.DictReader((own / "swept" / "sweep.csv").open()))
    # The class's own defaults are a point too; its values stand in the class.
    assert len([row for row in rows if not row["only_first"]]) == 1
    rows = [row for row in rows if row["only_first"]]
    points = {(float(row["scale"]), float(row["only_first"])) for row in rows}
    assert points == {(scale, first) for scale in (0.5, 1, 1.5, 2) for first in (600, 700)}
    assert len({row["ate_m"] for row in rows if row["scale"] != "1"}) == 6, "they have no effect"


PLAN = """estimator: mine=python:own_estimators.Legs
params: ["scale=0.5:1.5", "estimators.mine.only_first=100000:100009"]
scenarios: [walk.yaml]
seeds: 3
objectives: [{score: ate_m, statistic: mean, relative: false}]
optimizer: {generations: 1, population: 5, seed: 1}
"""


def test_settings_are_tuned_and_the_result_is_a_setting(own):
    (own / "tune.yaml").write_text(PLAN)
    environment = {"AIMS_PYTHON": sys.executable}
    program("tune", "tune.yaml", "-o", "tuned", "--apply", "best.yaml", "--quiet", cwd=own, env=environment)
    rows = list(csv.DictReader((own / "tuned" / "tune.csv").open()))
    best = min(float(row["objective.0"]) for row in rows)
    run(own, "run", "walk.yaml", "--estimators", "mine=python:own_estimators.Legs", "--seeds", "3",
        "--set", "@best.yaml", "-o", "best")
    scores = json.loads((own / "best" / "scores.json").read_text())
    assert scores["estimators"]["mine"]["ate_m"] == pytest.approx(best, rel=1e-6)


@pytest.mark.parametrize(
    "param, message",
    [
        ("scal=1:2:2", "unknown key 'scal'; did you mean 'scale'?; python:own_estimators.Legs has "
                       "scale, only_first, call_timeout, code_hash"),
        ("code_hash=1:2:2", "'code_hash' is a text, and only numbers have ranges"),
        ("estimators.aims.scale=1:2:2", "a key of aims, but mine is varied"),
    ],
)
def test_a_wrong_range_is_an_error(own, param, message):
    _, error = sweep(own, "--param", param, "-o", "wrong", code=2)
    assert message in error


def test_poses_are_nested_lists_too(own):
    run(own, "estimate", "walk.bag", "--estimators",
        "mine=python:own_estimators.Legs,nested=python:own_estimators.Nested", "-o", "nested")
    assert (own / "nested" / "nested.tum").read_bytes() == (own / "nested" / "mine.tum").read_bytes()


def test_what_an_estimator_without_poses_counts_is_printed(own):
    out, error = run(own, "estimate", "walk.bag", "--estimators",
                     "bad=python:own_estimators.Unrigid", "-o", "unrigid", code=4)
    assert "note: bad: pose_not_rigid: " in out and "bad: no poses" in error


def test_poses_that_are_none_are_left_out_and_counted(own):
    run(own, "estimate", "walk.bag", "--estimators",
        "mine=python:own_estimators.Legs,poor=python:own_estimators.Poor", "-o", "poor")
    assert (own / "poor" / "poor.tum").read_bytes() == (own / "poor" / "mine.tum").read_bytes()
    counts = json.loads((own / "poor" / "estimate.json").read_text())["estimators"]["poor"]["counts"]
    assert counts["pose_not_rigid"] == 2 * counts["pose_stamp_not_increasing"] > 200


def test_stamps_of_another_time_are_left_out_and_spoil_nothing(own):
    run(own, "estimate", "walk.bag", "--estimators",
        "leg,mine=python:own_estimators.Legs,odd=python:own_estimators.Future", "-o", "odd")
    counts = json.loads((own / "odd" / "estimate.json").read_text())["estimators"]["odd"]["counts"]
    odd, mine = ((own / "odd" / f"{each}.tum").read_text().splitlines() for each in ("odd", "mine"))
    assert odd == mine[: len(odd)] and counts["pose_stamp_not_measured"] == len(mine) - len(odd) > 100
    assert len(aims.read_trajectory(own / "odd" / "leg.tum")) > 20


def test_shared_points_cannot_be_shortened_and_no_process_is_left(own):
    _, error = run(own, "estimate", "walk.bag", "--estimators",
                   "leg,bad=python:own_estimators.Leaves", "-o", "leaves", code=1)
    assert "bad: FAILED: python:own_estimators.Leaves: add_scan: PermissionError" in error
    assert len(aims.read_trajectory(own / "leaves" / "leg.tum")) > 20
    child = pathlib.Path("/proc") / (own / "note").read_text() / "stat"
    assert not child.exists() or child.read_text().rpartition(")")[2].split()[0] == "Z"


def test_an_interpreter_that_is_none_is_named(own):
    _, error = program("estimate", "walk.bag", "--estimators", "python:own_estimators.Legs", "-o",
                       "none", cwd=own, code=2, env={"AIMS_PYTHON": "/no/python"})
    assert "no Python interpreter '/no/python'; AIMS_PYTHON names another" in error
