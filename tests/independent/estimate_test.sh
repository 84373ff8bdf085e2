#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: estimate_test.sh SOURCE_FOLDER BIN_FOLDER: short recordings through the program.
set -euo pipefail
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
source_folder=$1 binaries=$2
measure() {
  "$source_folder/bench/independent.sh" --bin "$binaries" --out "$out" --cells doors_30 --rates 200 "$@"
}
measure --length 15 --estimators tfs_plus,leg | tee "$out/table"
awk '
  $2 == "tfs_plus" && $3 < 0.5 && $4 < 0.5 && $5 < 0.15 && $6 < 0.15 && $8 == "yes" { ++good }
  $2 == "leg" && $3 > 3.0 && $3 < 6.0 { ++good }  # the scale error of the legs
  END { exit good == 2 ? 0 : 1 }' "$out/table"

measure --length 2 --estimators leg --relief 0.003 | tee "$out/table"
grep -q '^doors_30-200-1-2m-relief_0.003 ' "$out/table"
grep -q 'relief 0.003 m' "$out/recordings/doors_30-200-1-2m-relief_0.003.bag"
if measure --length 2 --estimators leg --calibration absent.yaml 2>"$out/errors"; then exit 1; fi
grep -q 'absent.yaml' "$out/errors"
