#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: estimate_test.sh SOURCE_FOLDER BIN_FOLDER: a short recording through the program.
set -euo pipefail
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$1/bench/independent.sh" --bin "$2" --out "$out" --cells doors_30 --rates 200 --length 15 \
  --estimators tfs_plus,leg | tee "$out/table"
awk '
  $2 == "tfs_plus" && $3 < 0.5 && $4 < 0.5 && $5 < 0.15 && $6 < 0.15 && $8 == "yes" { ++good }
  $2 == "leg" && $3 > 3.0 && $3 < 6.0 { ++good }  # the scale error of the legs
  END { exit good == 2 ? 0 : 1 }' "$out/table"
