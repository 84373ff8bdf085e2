#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far each stage of a scan is from what the machine can do.

  lab/speed/roofline.py AIMS BENCH_MACHINE [--estimator aims_d] [--length 8] [--seed 1] [--core 1]

Simulates the paper's corridor cut to LENGTH metres and estimates it three times, pinned to one core:
plainly, under `perf record` (time by function) and under `valgrind --tool=cachegrind` (instructions
and cache misses by function, with the caches of this machine). Functions are grouped into stages.
Per scan and stage it prints the time [us], the instructions [1000], the bytes that miss the first
and the second cache [kB], the floor [us] and time / floor. The floor is the largest of: instructions
at the rate of independent additions, the bytes at the rates of reading in order, all three measured
by BENCH_MACHINE. Needs perf and valgrind.
"""

import argparse
import collections
import json
import pathlib
import re
import subprocess
import tempfile

LINE = 64  # bytes of a cache line
SAMPLES = 4000  # a second, by perf

# Stage and what the names of its functions contain; the first that fits counts.
STAGES = [
    ("reading the recording", r"read_cloud|numbers_at|number_at|CloudDecoder|CloudSurvey|RingSurvey|llround|atan2|"
                              r"hypot|is_sorted|_copy_to_iter|Recording|Bag|MessageTraversal|FieldLookup|leg_of_name"),
    ("mixed returns", r"MixedPixelFilter"),
    ("moving returns", r"RangeImage|DynamicPoints"),
    ("thinning", r"ScanSelection"),
    ("deskewing", r"deskew|ScanMotion"),
    ("nearest points, map insertion", r"VoxelMap::nearest|VoxelMap::planes_at"),
    ("plane fits", r"fit_plane|lies_among"),
    ("linearization", r"ScanMatcher|HalvesSum|ResidualNoise|aligned|plane_row"),
    ("map, the rest", r"VoxelMap|VoxelStore|VoxelHash"),
    ("ground", r"ground|Ground|refit|Floor"),
    ("filter", r"propagate|Eskf|fuse|Eigen::|covariance|Leg|Imu|Belief|iterated_update"),
]
REST = "rest"


def stage_of(function):
    return next((name for name, pattern in STAGES if re.search(pattern, function)), REST)


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    if done.returncode not in (0, 3):  # 3: invalid at some time, which is no matter of speed
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def simulate(options, recording):
    route = f"[{{name: a, x: 0, y: 0}}, {{name: b, x: {options.length}, y: 0}}, {{name: a, x: 0, y: 0}}]"
    run([options.aims, "simulate", "corridor", "--seed", str(options.seed), "--quiet", "--out", recording,
         "--set", f"scene.corridor.length={options.length}", "--set", f"route.points={route}", "--set", "expect=[]"])


def machine(options):
    """Instructions a second, and bytes a second from the second and the third cache; sizes of the first two."""
    report = json.loads(run(["taskset", "-c", str(options.core), options.machine, "--benchmark_format=json"]))
    by_name = {each["name"]: each for each in report["benchmarks"]}
    data = {cache["level"]: cache["size"] for cache in report["context"]["caches"] if cache["type"] != "Instruction"}
    return {"instructions": by_name["instructions"]["items_per_second"],
            "second": by_name["read_in_order/512"]["bytes_per_second"],
            "third": by_name["read_in_order/8192"]["bytes_per_second"],
            "sizes": (data[1], data[2]), "all": by_name}


def times(command, folder):
    """Seconds by stage, from samples of the running function."""
    data = folder + "/perf.data"
    run(["perf", "record", "-e", "cpu-clock", "-F", str(SAMPLES), "-o", data] + command)
    samples = run(["perf", "script", "-i", data, "-F", "ip,sym"])
    seconds = collections.Counter()
    for line in samples.splitlines():
        if line.strip():
            seconds[stage_of(line.strip().partition(" ")[2])] += 1.0 / SAMPLES
    return seconds


def cache_of(size):
    """A cache of `size` bytes as cachegrind takes it: of 8 ways, or more so that its sets are a power of two."""
    lines = size // LINE
    ways = next(ways for ways in range(8, lines + 1) if lines % ways == 0 and (lines // ways).bit_count() == 1)
    return f"{size},{ways},{LINE}"


def counts(command, folder, sizes):
    """Instructions and misses of the first and the second cache by stage."""
    data = folder + "/cachegrind.out"
    run(["valgrind", "--tool=cachegrind", "--cache-sim=yes", f"--D1={cache_of(sizes[0])}",
         f"--LL={cache_of(sizes[1])}", f"--cachegrind-out-file={data}"] + command)
    events, totals, stage = [], collections.defaultdict(collections.Counter), REST
    for line in pathlib.Path(data).read_text().splitlines():
        if line.startswith("events:"):
            events = line.split()[1:]
        elif line.startswith("fn="):
            stage = stage_of(line[3:])
        elif line[:1].isdigit():
            for event, number in zip(events, line.split()[1:]):
                totals[stage][event] += int(number)
    return totals


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("aims")
    parser.add_argument("machine")
    parser.add_argument("--estimator", default="aims_d")
    parser.add_argument("--length", type=float, default=8)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--core", type=int, default=1)
    options = parser.parse_args()
    best = machine(options)
    for name, each in best["all"].items():
        rate = each.get("items_per_second") or each["bytes_per_second"]
        print(f"{name:24} {rate / 1e9:8.3f} G/s")
    with tempfile.TemporaryDirectory() as folder:
        recording = folder + "/corridor.bag"
        simulate(options, recording)
        pinned = ["taskset", "-c", str(options.core)]
        command = [options.aims, "estimate", recording, "--estimators", options.estimator, "--no-pictures",
                   "--no-page", "--quiet", "--jobs", "1", "--overwrite", "--out", folder + "/out"]
        run(pinned + command)
        result = json.loads(pathlib.Path(folder, "out", "estimate.json").read_text())["estimators"][options.estimator]
        seconds = times(pinned + command, folder)
        counted = counts(command, folder, best["sizes"])
    scans = result["scans"]
    print(f"\n{scans} scans, {result['cpu_per_scan_ms']['mean']:.2f} ms each, without reading")
    print(f"{'stage':30}{'us':>8}{'k instr':>9}{'kB > 1st':>10}{'kB > 2nd':>10}{'floor us':>10}{'ratio':>7}")
    total = collections.Counter()
    for stage in [name for name, _ in STAGES] + [REST, "all"]:
        count = total if stage == "all" else counted[stage]
        if stage != "all":
            total.update(count)
            seconds["all"] += seconds[stage]
        instructions = count["Ir"] / scans
        second = LINE * (count["D1mr"] + count["D1mw"]) / scans
        third = LINE * (count["DLmr"] + count["DLmw"]) / scans
        floor = max(instructions / best["instructions"], second / best["second"], third / best["third"])
        time = seconds[stage] / scans
        print(f"{stage:30}{1e6 * time:8.0f}{instructions / 1e3:9.0f}{second / 1e3:10.0f}{third / 1e3:10.0f}"
              f"{1e6 * floor:10.0f}{time / floor:7.1f}")


if __name__ == "__main__":
    main()
