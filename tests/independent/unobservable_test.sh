#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# In a corridor that constrains nothing along it, `aims_d` is no worse than the legs alone and than
# `tfs_plus`: mean of M_list over 32 recordings whose seeds chose nothing. Half of the legs report too
# much and half too little, since the noise of a map draws every estimate back.
#   unobservable_test.sh SOURCE_FOLDER BINARY_FOLDER [SEEDS_TOO_LONG SEEDS_TOO_SHORT]
set -euo pipefail
source_folder=$1 binaries=$2 too_long=${3:-$(seq -s, 71 78)} too_short=${4:-$(seq -s, 79 86)}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

score() {
  bash "$source_folder/bench/independent.sh" --bin "$binaries" --out "$out" --cells plain_open_30 \
    --rates 50,200 --seeds "$1" --legs-scale "$2" --length 40 --estimators aims_d,tfs_plus,leg --keep no
}
{ score "$too_long" 1.045; score "$too_short" 0.955; } | tee "$out/table.txt"

recordings=$((2 * $(tr -cd , <<<"$too_long,$too_short" | wc -c) + 2))
awk -v recordings="$recordings" '
  $1 != "recording" { sum[$2] += ($3 + $4) / 2; ++count[$2] }
  END {
    for (name in sum) {
      if (count[name] != recordings) { print "FAILED: " count[name] " rows of " name; exit 1 }
      printf "%s: M_list %.2f %%, mean of %d recordings\n", name, sum[name] / recordings, recordings
    }
    if (recordings > 0 && length(sum) == 3 && sum["aims_d"] <= sum["leg"] &&
        sum["aims_d"] <= sum["tfs_plus"]) exit 0
    print "FAILED: aims_d is worse than the legs or tfs_plus"
    exit 1
  }' "$out/table.txt"
