#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Kills simulate, suite, sweep and tune with SIGKILL at random moments, continues them with the same
# command, and compares the results with those of an undisturbed run.
#
#   tests/reliability/kill.sh AIMS OUT [KILLS [SEED]]     OUT: a new folder; KILLS: of each command
set -euo pipefail
tests="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
aims=$(readlink -f "$1") out=$2 kills=${3:-50}
RANDOM=${4:-1}
mkdir -p "$out"
cd "$out"
cp "$tests"/{sequence,plan,tune}.yaml .
export XDG_CACHE_HOME="$PWD/cache"

# Results without wall times and without the order in which jobs ended.
results() {
  (cd "$1" && find . -name '*.json' -path '*jobs/*' -o -name '*.tum' -o -name 'evaluations.csv' | sort |
    while read -r file; do
      echo "$file $(grep -v -e 'time_per_scan\|cpu_per_scan\|"mean"\|"p50"\|"p99"\|wall_s' "$file" | md5sum)"
    done)
}

# run NAME SECONDS COMMAND...: an undisturbed run, then kills within SECONDS of the start.
run() {
  local name=$1 span=$2 lost=0 differ=0
  shift 2
  "$@" --out "$name-reference" > "$name.log" 2>&1 || { cat "$name.log"; exit 1; }
  for ((i = 1; i <= kills; i++)); do
    rm -rf "$name-killed" cache
    for ((again = 0; again < 3; again++)); do
      setsid "$@" --out "$name-killed" > "$name.log" 2>&1 &
      local group=$!
      sleep "$(awk -v r=$RANDOM -v s="$span" 'BEGIN {printf "%.3f", s * r / 32768}')"
      kill -KILL -- -$group 2> /dev/null || true
      wait $group 2> /dev/null || true
    done
    "$@" --out "$name-killed" > "$name.log" 2>&1 || { echo "$name: does not continue"; cat "$name.log"; lost=$((lost + 1)); }
    [ "$(results "$name-reference")" = "$(results "$name-killed")" ] || differ=$((differ + 1))
  done
  echo "$name: $kills times killed thrice; $lost did not continue, $differ with other results"
  [ $((lost + differ)) -eq 0 ]
}

# Of a killed simulation the bag holds every message up to the chunk that was open.
simulate() {
  local unreadable=0 shorter=0
  for ((i = 1; i <= kills; i++)); do
    rm -f walk.bag*
    setsid "$aims" simulate sequence.yaml --quiet --out walk.bag > simulate.log 2>&1 &
    local group=$!
    sleep "$(awk -v r=$RANDOM 'BEGIN {printf "%.3f", 0.2 + 1.5 * r / 32768}')"
    kill -KILL -- -$group 2> /dev/null || true
    wait $group 2> /dev/null || true
    local left
    left=$(ls walk.bag* 2> /dev/null | head -1)
    [ -n "$left" ] || continue
    [ "$(stat -c %s "$left")" -gt 100000 ] || continue  # killed before the first chunk
    "$aims" info "$left" > info.log 2>&1 || unreadable=$((unreadable + 1))
    grep -q 'lidar/points\|imu/data' info.log || shorter=$((shorter + 1))
  done
  echo "simulate: $kills times killed; $unreadable bags unreadable, $shorter without messages"
  [ $((unreadable + shorter)) -eq 0 ]
}

simulate
run suite 4 "$aims" suite sequence.yaml --seeds 1-2 --estimators aims,leg --no-page --quiet --jobs 2
run sweep 4 "$aims" sweep plan.yaml --quiet --jobs 2
run tune 8 "$aims" tune tune.yaml --quiet --jobs 2
