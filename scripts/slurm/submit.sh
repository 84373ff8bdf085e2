#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: submit.sh PLAN OUT SHARDS [SBATCH_OPTION...] [-- SWEEP_OPTION...]
# Submits a sweep as an array job of SHARDS tasks, and the merge after the last of them has ended,
# however it ended. The same command again does what is missing.
#   SEQUENCES=40 submit.sh ...  first an array of 40 tasks that only simulate, for many shards
#   AIMS=/path/to/aims       the program on the nodes (aims)
# Logs: OUT.log/. Example: submit.sh plan.yaml out/eta 64 --mem=3G -- --cache /scratch/aims
set -euo pipefail
if [ $# -lt 3 ]; then
  sed -n '3,10s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
plan=$(readlink -f "$1") out=$(readlink -m "$2") shards=$3
shift 3
options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  options+=("$1")
  shift
done
[ $# -gt 0 ] && shift
log=$out.log
mkdir -p "$log"

after=()
if [ -n "${SEQUENCES:-}" ]; then
  sequences=$(sbatch --parsable --array="1-$SEQUENCES" --output="$log/sequences-%a.txt" "${options[@]}" \
    "$here/sweep.sbatch" "$SEQUENCES" "$plan" "$out" --simulate-only "$@")
  after=(--dependency="afterany:$sequences")
  echo "sequences: job $sequences, $SEQUENCES tasks"
fi
jobs=$(sbatch --parsable --array="1-$shards" --output="$log/jobs-%a.txt" "${after[@]}" \
  "${options[@]}" "$here/sweep.sbatch" "$shards" "$plan" "$out" "$@")
echo "jobs: job $jobs, $shards tasks"
merge=$(sbatch --parsable --dependency="afterany:$jobs" --output="$log/merge.txt" \
  "${options[@]}" "$here/merge.sbatch" "$out")
echo "merge: job $merge, then $out/sweep.sqlite; logs in $log"
