#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every shipped scenario twice, on one thread and on two, for its first seconds: all results but the
# wall times must be the same bytes. Each simulates for itself. Pages show wall times too.
#
#   tests/scenarios/same_bytes.sh AIMS OUT [SECONDS]     AIMS: the program; OUT: a folder for results
set -euo pipefail
aims=$1 out=$2 seconds=${3:-45}
rm -rf "$out"
mkdir -p "$out"
for jobs in 1 2; do
  # A cut sequence is an invalid run, so exit codes 1 (an expectation failed) and 4 are ignored.
  "$aims" suite --tags paper,corridor,severity,stress --seeds 1 --estimators aims,leg --trajectories \
    --no-page --set "max_duration=$seconds" --jobs $jobs --out "$out/jobs-$jobs" \
    --cache "$out/sequences-$jobs" --quiet >"$out/jobs-$jobs.log" 2>&1 ||
    [[ $? =~ ^[14]$ ]] || { tail -5 "$out/jobs-$jobs.log" >&2; exit 2; }
done
runs=$(find "$out/jobs-1/runs" -name aims.tum | wc -l)
[ "$runs" -gt 0 ] || { echo "no run left a trajectory" >&2; exit 2; }
# Wall times stand in the files of jobs, whose scores are in suite.csv, in scores.json and in the last column
# of the diagnostics.
rm -f "$out"/jobs-[12]/jobs/*.json
for file in $(cd "$out/jobs-1" && find . -name '*.diagnostics.csv'); do
  for jobs in 1 2; do sed -i 's/,[^,]*$//' "$out/jobs-$jobs/$file"; done
done
diff -r --exclude timings.csv --exclude scores.json --exclude scores.csv --exclude .lock \
  "$out/jobs-1" "$out/jobs-2"
echo "$runs runs: the same bytes on one thread and on two"
