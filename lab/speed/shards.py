#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Jobs a minute of a sweep, what a second process at a time gains, and a cluster of 64 shards on paper.

  lab/speed/shards.py AIMS [--estimator aims_d] [--jobs 16] [--small-jobs 256] [--shards 1,2,8,64]

Sweeps a limit of the scoring over `corridor`, seed 1, whose sequence is cached first: with one
process at a time, then with two. The overheads are measured too: starting a shard that has nothing
to do, and merging, by a sweep of `leg`, whose jobs are short. On paper each shard then does its part
of 1,920 jobs with the measured times in turn; their sequences are taken as simulated before. The
speed-up includes the start of each shard and the merge at the end.
"""

import argparse
import itertools
import json
import pathlib
import subprocess
import tempfile
import time

JOBS_ON_PAPER = 1920  # 16 sequences with 120 jobs each


def timed(command):
    """Wall time [s]."""
    start = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 4):  # 4: invalid runs, which is no matter of speed
        raise SystemExit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return time.monotonic() - start


def sweep(options, folder, name, estimator, points, more):
    """The command that sweeps a limit of the scoring, which every estimator has, into `folder`/`name`."""
    return [options.aims, "sweep", "--scenarios", "corridor", "--seeds", "1", "--estimators", estimator, "--quiet",
            "--param", f"scoring.max_gap=2:3:{points}", "--cache", folder + "/cache", "--out", f"{folder}/{name}", *more]


def job_times(folder):
    return [json.loads(file.read_text())["wall_s"] for file in sorted(pathlib.Path(folder, "jobs").glob("*.json"))]


def on_paper(times, process, start, merge_per_job, shards):
    """Wall time of the list on so many shards, one process each [s]."""
    largest = -(-JOBS_ON_PAPER // shards)  # shards differ by one job at most
    work = sum(itertools.islice(itertools.cycle(times), largest)) + process * largest
    return start + work + merge_per_job * JOBS_ON_PAPER


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("aims")
    parser.add_argument("--estimator", default="aims_d")
    parser.add_argument("--jobs", type=int, default=16)
    parser.add_argument("--small-jobs", type=int, default=256)
    parser.add_argument("--shards", default="1,2,8,64")
    parser.add_argument("--temporary", help="folder for the cache and the results")
    options = parser.parse_args()

    with tempfile.TemporaryDirectory(dir=options.temporary) as folder:
        first = timed(sweep(options, folder, "first", options.estimator, 2, ["--jobs", "2"]))
        print(f"simulation and 2 jobs: {first:.1f} s")
        one = timed(sweep(options, folder, "one", options.estimator, options.jobs, ["--jobs", "1"]))
        two = timed(sweep(options, folder, "two", options.estimator, options.jobs, ["--jobs", "2"]))
        times = job_times(folder + "/one")
        start = timed(sweep(options, folder, "one", options.estimator, options.jobs, ["--jobs", "1", "--shard", "1/2"]))
        timed(sweep(options, folder, "small", "leg", options.small_jobs, ["--jobs", "2"]))
        merge = timed([options.aims, "merge", folder + "/small"])
        few = timed([options.aims, "merge", folder + "/one"])

    count = len(times)
    process = max(0.0, (one - start - sum(times)) / count)
    merge_per_job = max(0.0, (merge - few) / (options.small_jobs - options.jobs))
    print(f"one at a time: {60 * count / one:.1f} jobs a minute; two: {60 * count / two:.1f}, "
          f"{one / two / 2:.2f} of twice as many")
    print(f"a job {sum(times) / count:.2f} s ({min(times):.2f} to {max(times):.2f}), its process {1000 * process:.0f} ms, "
          f"start of a shard {1000 * start:.0f} ms, merge {1000 * merge_per_job:.2f} ms per job")
    alone = on_paper(times, process, start, merge_per_job, 1)
    print(f"on paper, {JOBS_ON_PAPER} jobs:")
    for shards in (int(each) for each in options.shards.split(",")):
        wall = on_paper(times, process, start, merge_per_job, shards)
        print(f"  {shards:3} shards: {wall:8.1f} s, speed-up {alone / wall:5.1f}, {alone / wall / shards:.2f} of all")


if __name__ == "__main__":
    main()
