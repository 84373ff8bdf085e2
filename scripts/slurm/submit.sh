#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: submit.sh PLAN OUT SHARDS [SBATCH_OPTION...] [-- SWEEP_OPTION...]
# Submits a sweep as an array job of SHARDS tasks, and the merge after the last of them has ended,
# however it ended: what is missing is said, and the same command again does the rest.
#   WALKS=40 submit.sh ...   first an array of 40 tasks that simulate the walks, for many shards
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
if [ -n "${WALKS:-}" ]; then
  walks=$(sbatch --parsable --array="1-$WALKS" --output="$log/walks-%a.txt" "${options[@]}" \
    "$here/sweep.sbatch" "$WALKS" "$plan" "$out" --simulate-only "$@")
  after=(--dependency="afterany:$walks")
  echo "walks: job $walks, $WALKS tasks"
fi
units=$(sbatch --parsable --array="1-$shards" --output="$log/units-%a.txt" "${after[@]}" \
  "${options[@]}" "$here/sweep.sbatch" "$shards" "$plan" "$out" "$@")
echo "units: job $units, $shards tasks"
merge=$(sbatch --parsable --dependency="afterany:$units" --output="$log/merge.txt" \
  "${options[@]}" "$here/merge.sbatch" "$out")
echo "merge: job $merge, then $out/sweep.sqlite; logs in $log"
