#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Time per scan against the returns of a scan, the rate of the IMU and the rate of the legs.

  lab/speed/scaling.py AIMS [--estimators aims_d,lio] [--seed 1] [--core 1] [--rounds 3]

Simulates the paper's corridor cut to 8 m with each size, estimates it pinned to one core, and prints
the mean and 99th percentile of the CPU time per scan [ms], medians over the rounds, and the
exponent p of time ~ size^p: least squares of logarithms over all sizes, and between neighbours.
"""

import argparse
import json
import math
import pathlib
import statistics
import subprocess
import tempfile

ROUTE = "route.points=[{name: a, x: 0, y: 0}, {name: b, x: 8, y: 0}, {name: a, x: 0, y: 0}]"
CORRIDOR = ["scene.corridor.length=8", ROUTE, "expect=[]"]

# Title, unit of the size, and per point the size with its settings.
STUDIES = [
    ("firings of a scan", "-", [
        (16 * columns, [f"lidar.columns={columns}"]) for columns in (188, 450, 900, 1800)
    ] + [
        (128 * columns, ["lidar.model=os1_128", f"lidar.columns={columns}"]) for columns in (512, 1024, 2048)
    ]),
    ("rate of the IMU", "Hz", [(rate, [f"imu.rate={rate}"]) for rate in (50, 100, 200, 400)]),
    ("rate of the legs", "Hz", [(rate, [f"leg_odometry.rate={rate}"]) for rate in (50, 100, 200, 400)]),
]


def run(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 3):  # 3: invalid at some time, which is no matter of speed
        raise SystemExit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")


def times(options, recording, folder):
    """Mean and 99th percentile of the CPU time per scan by estimator [ms]."""
    run(["taskset", "-c", str(options.core), options.aims, "estimate", recording, "--estimators", options.estimators,
         "--no-pictures", "--no-page", "--quiet", "--jobs", "1", "--overwrite", "--out", folder + "/out"])
    results = json.loads(pathlib.Path(folder, "out", "estimate.json").read_text())
    return {name: (each["cpu_per_scan_ms"]["mean"], each["cpu_per_scan_ms"]["p99"])
            for name, each in results["estimators"].items()}


def measured(options, settings):
    """Medians over the rounds of `times`."""
    with tempfile.TemporaryDirectory(dir=options.temporary) as folder:
        recording = folder + "/walk.bag"
        command = [options.aims, "simulate", "corridor", "--seed", str(options.seed), "--quiet", "--out", recording]
        for setting in CORRIDOR + settings:
            command += ["--set", setting]
        run(command)
        rounds = [times(options, recording, folder) for _ in range(options.rounds)]
    return {name: tuple(statistics.median(each[name][i] for each in rounds) for i in (0, 1)) for name in rounds[0]}


def exponent(sizes, values):
    """Slope of the logarithms by least squares."""
    x = [math.log(each) for each in sizes]
    y = [math.log(each) for each in values]
    x_mean, y_mean = statistics.mean(x), statistics.mean(y)
    return sum((a - x_mean) * (b - y_mean) for a, b in zip(x, y)) / sum((a - x_mean) ** 2 for a in x)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("aims")
    parser.add_argument("--estimators", default="aims_d,lio")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--core", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--temporary", help="folder for recordings of up to 5 GB (that of the system)")
    options = parser.parse_args()
    for title, unit, points in STUDIES:
        sizes = [size for size, _ in points]
        results = [measured(options, settings) for _, settings in points]
        print(f"\n{title + f' [{unit}]':26}{'':11}" + "".join(f"{size:>9}" for size in sizes) + "  exponent")
        for name in results[0]:
            for i, what in enumerate(["mean ms", "p99 ms"]):
                values = [each[name][i] for each in results]
                print(f"{'':26}{name:11}"[:37] + "".join(f"{value:9.2f}" for value in values)
                      + f"{exponent(sizes, values):10.2f}  {what}", flush=True)
            local = [exponent(sizes[k:k + 2], [results[k][name][0], results[k + 1][name][0]])
                     for k in range(len(sizes) - 1)]
            print(f"{'':26}{name:11}{'':9}" + "".join(f"{value:9.2f}" for value in local) + "  between neighbours")


if __name__ == "__main__":
    main()
