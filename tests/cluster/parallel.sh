#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: parallel.sh AIMS WORK_FOLDER. Runs a sweep's shards under GNU parallel, as docs/studies-and-tuning.md does.
set -euo pipefail
tests="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
command -v parallel >/dev/null || { echo "SKIPPED: parallel is not installed"; exit 0; }
aims=$1
rm -rf "$2"
mkdir -p "$2"
cd "$2"
cp "$tests"/{plan,sequence}.yaml .
parallel --will-cite --jobs 2 "$aims" sweep plan.yaml --out out --cache sequences --jobs 1 --quiet \
  --shard '{}/4' ::: 1 2 3 4
"$aims" merge out | tee merge.txt
grep -q '^6 of 6 jobs done' merge.txt
[ "$(ls sequences)" = "$(ls sequences | grep '\.sequence$')" ] && [ "$(ls sequences | wc -l)" -eq 2 ]
