#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Time per scan of two programs over one recording, as a ratio.

  lab/speed/compare.py OLD NEW RECORDING [--estimators aims_d,lio] [--rounds 5] [--core 1]

Runs `aims estimate` of both in turn, pinned to one core, so that what else the machine does meets
both alike. Prints the median over the rounds of each estimator's mean and 99th percentile of the
CPU time per scan [ms], and the median of the ratios of rounds.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile


def times(program, options):
    """Mean and 99th percentile per estimator of one run [ms]."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["taskset", "-c", str(options.core), program, "estimate", options.recording,
                   "--estimators", options.estimators, "--no-pictures", "--no-page", "--quiet",
                   "--jobs", "1", "--out", folder + "/out"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        results = json.loads(pathlib.Path(folder, "out", "estimate.json").read_text())
    return {name: (each["cpu_per_scan_ms"]["mean"], each["cpu_per_scan_ms"]["p99"])
            for name, each in results["estimators"].items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("recording")
    parser.add_argument("--estimators", default="aims_d,lio")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--core", type=int, default=1)
    options = parser.parse_args()
    rounds = [(times(options.old, options), times(options.new, options))
              for _ in range(options.rounds)]
    print(f"{'estimator':12} {'':5} {'old ms':>7} {'new ms':>7} {'ratio':>6}  over {options.rounds} rounds")
    for name in rounds[0][0]:
        for i, what in enumerate(["mean", "p99"]):
            old = [a[name][i] for a, _ in rounds]
            new = [b[name][i] for _, b in rounds]
            ratio = statistics.median(b / a for a, b in zip(old, new))
            print(f"{name:12} {what:5} {statistics.median(old):7.2f} {statistics.median(new):7.2f} "
                  f"{ratio:6.2f}")


if __name__ == "__main__":
    main()
