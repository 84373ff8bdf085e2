#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""go1_walk.py AIMS FOLDER: legs and IMU of a real Go1 against stamped motion capture.

FOLDER/go1 holds walk.yaml, walk.csv and truth_first_half.tum, which are no part of this project.
Prints by how many percent each estimate is too long, for contact thresholds that are learned or
set: along the track of the first half, whose truth has stamps, and in the two spans of the whole
square. Markers beside the base take another way through a corner than the base; so the spans are
those of the point of the body whose path has the form of the true one over the first half.
Fails beyond 3 % or when thresholds change the first half by more than 1 point, and where zeros of
joints that are off by as much as the documentation says are not named, or others are. Without the
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
# Joints, offset of their zeros [rad], whether a warning names it.
ZEROS = (("_thigh", 0.0, False), ("_thigh", 0.1, False), ("_thigh", 0.3, True),
         ("_thigh", -0.3, True), ("FL_thigh", 0.3, True), ("_calf", 0.5, True))
WINDOW = 0.5  # of the displacements that are compared [s]
WALKING = 0.15  # least true displacement of a window [m]
WALK = 20.5  # after the first pose of an estimate [s]; then the robot lies down
SPANS = np.array([3.13, 3.39])  # smallest rectangle around the whole motion capture [m]


def turned(x, y, quaternions):
    """The point (x, y) of the body [m], turned to the world by quaternions (n, 4; x y z w)."""
    qx, qy, qz, qw = quaternions.T
    return np.column_stack([(1 - 2 * (qy**2 + qz**2)) * x + 2 * (qx * qy - qw * qz) * y,
                            2 * (qx * qy + qw * qz) * x + (1 - 2 * (qx**2 + qz**2)) * y])


def markers_in_body(estimate, truth):
    """Where in the body [m] the markers are, by the first half, and the deviation of the fit [m].

    Heading, translation and scale of the path are free, so that a path that is too short or too
    long gives the same place.
    """
    inside = (estimate[:, 0] >= truth[0, 0]) & (estimate[:, 0] <= truth[-1, 0])
    poses = estimate[inside]
    true = np.column_stack([np.interp(poses[:, 0], truth[:, 0], truth[:, i]) for i in (1, 2)])
    axes = [turned(1.0, 0.0, poses[:, 4:8]), turned(0.0, 1.0, poses[:, 4:8])]
    ones, zeros = np.ones(len(poses)), np.zeros(len(poses))
    columns = [*axes, np.column_stack([ones, zeros]), np.column_stack([zeros, ones]), poses[:, 1:3]]
    rows = np.stack(columns, axis=2).reshape(-1, 5)
    best = (np.inf, None)
    for heading in np.radians(np.arange(-10.0, 10.0, 0.1)):
        c, s = np.cos(heading), np.sin(heading)
        wanted = (true @ np.array([[c, -s], [s, c]])).reshape(-1)
        solution = np.linalg.lstsq(rows, wanted, rcond=None)[0]
        deviation = np.sqrt(np.sum((rows @ solution - wanted) ** 2) / len(poses))
        best = min(best, (deviation, tuple(solution[:2])))
    return best[1], best[0]


def spans_of(path):
    """Sorted sides [m] of the smallest rectangle around points (n, 2)."""
    angles = np.linspace(0.0, np.pi / 2, 181)
    sides = [np.ptp(path @ np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]), axis=0)
             for a in angles]
    return np.sort(min(sides, key=np.prod))


def span_errors(estimate, truth):
    """Percent by which the spans of the markers are too long, their place and its deviation [m]."""
    markers, deviation = markers_in_body(estimate, truth)
    walk = estimate[estimate[:, 0] - estimate[0, 0] < WALK]
    path = walk[:, 1:3] + turned(*markers, walk[:, 4:8])
    return 100.0 * (spans_of(path) / SPANS - 1.0), markers, deviation


def along_track_error(estimate, truth):
    """Percent by which displacements along the true ones are too long, aligned by heading."""
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
    """Along the first half and in the spans: the errors of each estimator with that threshold."""
    detection = ["learned"] if threshold is None else ["threshold"]
    settings = [f"recording.contact_detection={detection[0]}"]
    if threshold is not None:
        settings.append(f"recording.contact_threshold={threshold}")
    command = [aims, "estimate", recording, "--topics", "lidar=none", "--estimators",
               ",".join(ESTIMATORS), "--no-pictures", "--no-page", "--quiet", "--out", str(out)]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    errors = {}
    for name in ESTIMATORS:
        estimate = np.loadtxt(out / f"{name}.tum")
        errors[name] = along_track_error(estimate, truth), span_errors(estimate, truth)
    return errors


def zeros_named(aims, folder, out, joints, offset):
    """Whether a warning names the zeros with that offset [rad] on joints whose columns end so."""
    header, *rows = (folder / "walk.csv").read_text().splitlines()
    moved = [i for i, name in enumerate(header.split(",")) if name.endswith(joints)]
    lines = [header]
    for row in rows:
        cells = row.split(",")
        for i in moved:
            cells[i] = repr(float(cells[i]) + offset)
        lines.append(",".join(cells))
    (out / "walk.csv").write_text("\n".join(lines) + "\n")
    (out / "walk.yaml").write_text((folder / "walk.yaml").read_text())
    command = [aims, "estimate", str(out / "walk.yaml"), "--topics", "lidar=none", "--estimators",
               "leg", "--no-pictures", "--no-page", "--quiet", "--overwrite", "--out",
               str(out / "zeros")]
    done = subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    return "the zero of the hip is off" in done.stdout


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
        wrong = [(joints, offset) for joints, offset, named in ZEROS if named !=
                 zeros_named(aims, folder, pathlib.Path(scratch), joints, offset)]
    print("along the track [%]; contact threshold [counts]:",
          *("learned" if t is None else t for t in THRESHOLDS))
    print("zeros of joints named wrongly:", *wrong)
    failed = bool(wrong)
    for name in ESTIMATORS:
        errors = [table[threshold][name][0] for threshold in THRESHOLDS]
        spans = np.array([table[threshold][name][1][0] for threshold in THRESHOLDS])
        (x, y), deviation = table[None][name][1][1:]
        print(f"{name:14s} first half", *(f"{error:+7.2f}" for error in errors))
        for span in range(2):
            print(f"{'':14s} span {span + 1}    ", *(f"{error:+7.2f}" for error in spans[:, span]))
        print(f"{'':14s} markers at {x:.3f}, {y:.3f} m in the body, deviation {deviation:.3f} m")
        if name in JUDGED:
            failed |= max(map(abs, errors)) > 3.0 or max(errors) - min(errors) > 1.0
            failed |= np.abs(spans).max() > 3.0
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
