#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""go1_walk.py AIMS FOLDER: legs and IMU of a real Go1 against stamped motion capture.

FOLDER/go1 holds walk.yaml, walk.csv and truth_first_half.tum, which are no part of this project.
Prints by how many percent each estimate is too long along the track, for contact thresholds that are
learned or set; fails beyond 3 % or when thresholds change it by more than 1 point. Without the
folder it is skipped (exit 77).
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ESTIMATORS = ("leg_inertial", "aims_d", "leg")
JUDGED = ("leg_inertial", "aims_d")
THRESHOLDS = (None, 30, 50, 100, 150, 200)  # None: learned
WINDOW = 0.5  # of the displacements that are compared [s]
WALKING = 0.15  # least true displacement of a window [m]


def along_track_error(estimate, truth):
    """Percent by which displacements along the true ones are too long, after alignment by heading."""
    inside = (truth[:, 0] >= estimate[0, 0]) & (truth[:, 0] <= estimate[-1, 0])
    time, path = truth[inside, 0], truth[inside, 1:3]
    at = np.column_stack([np.interp(time, estimate[:, 0], estimate[:, i]) for i in (1, 2)])
    cross = (at - at.mean(0)).T @ (path - path.mean(0))
    angle = np.arctan2(cross[0, 1] - cross[1, 0], cross[0, 0] + cross[1, 1])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    at = at @ turn.T
    step = max(1, round(WINDOW / np.median(np.diff(time))))
    true = path[step::step] - path[:-step:step][: len(path[step::step])]
    found = at[step::step] - at[:-step:step][: len(at[step::step])]
    length = np.linalg.norm(true, axis=1)
    walking = length > WALKING
    along = np.sum(found[walking] * true[walking], axis=1) / length[walking]
    return 100.0 * (along.sum() / length[walking].sum() - 1.0)


def errors_of(aims, recording, truth, threshold, out):
    """The error of each estimator with that contact threshold."""
    detection = ["learned"] if threshold is None else ["threshold"]
    settings = [f"recording.contact_detection={detection[0]}"]
    if threshold is not None:
        settings.append(f"recording.contact_threshold={threshold}")
    command = [aims, "estimate", recording, "--topics", "lidar=none", "--estimators",
               ",".join(ESTIMATORS), "--no-pictures", "--no-page", "--quiet", "--out", str(out)]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return {name: along_track_error(np.loadtxt(out / f"{name}.tum"), truth) for name in ESTIMATORS}


def main():
    aims, folder = sys.argv[1], pathlib.Path(sys.argv[2]) / "go1"
    if not (folder / "walk.yaml").exists():
        print(f"{folder}: not there, skipped")
        return 77
    truth = np.loadtxt(folder / "truth_first_half.tum")
    truth[:, 0] += np.loadtxt(folder / "walk.csv", delimiter=",", skiprows=1, max_rows=1)[0]
    table = {}
    with tempfile.TemporaryDirectory() as scratch:
        for threshold in THRESHOLDS:
            out = pathlib.Path(scratch) / str(threshold)
            table[threshold] = errors_of(aims, str(folder / "walk.yaml"), truth, threshold, out)
    print("along the track [%]; contact threshold [counts]:",
          *("learned" if t is None else t for t in THRESHOLDS))
    failed = False
    for name in ESTIMATORS:
        errors = [table[threshold][name] for threshold in THRESHOLDS]
        print(f"{name:14s}", *(f"{error:+7.2f}" for error in errors))
        if name in JUDGED:
            failed |= max(map(abs, errors)) > 3.0 or max(errors) - min(errors) > 1.0
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
