#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Fuzzes the readers of bags, MCAP, SQLite and capture files, messages, recordings, YAML, tables and JSON, each for some seconds, from
# the kept corpus on; what is new and reaches further is put into BUILD/corpus, what breaks into BUILD/found.
# usage: tests/fuzz/run.sh [SECONDS [BUILD [TARGET...]]]
set -eu
source=$(cd "$(dirname "$0")/../.." && pwd)
seconds=${1:-300}
build=${2:-$source/build/fuzz}
[ $# -ge 2 ] && shift 2 || set --
[ $# -gt 0 ] || set -- bag mcap db3 pcap ouster message cdr recording states legs packets merged yaml tables json

cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DCMAKE_CXX_COMPILER=clang++ -DAIMS_FUZZ=ON -DAIMS_BENCH=OFF -DAIMS_PAGE=OFF \
  -DAIMS_UNITY=ON "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -gline-tables-only" > "$build.log" 2>&1 ||
  { cat "$build.log"; exit 1; }
for target; do
  cmake --build "$build" --target "fuzz_$target"
  mkdir -p "$build/corpus/$target" "$build/found"
  "$build/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -rss_limit_mb=512 \
    -malloc_limit_mb=256 -timeout=10 -max_len=65536 -print_final_stats=1 \
    -artifact_prefix="$build/found/$target-" \
    "$build/corpus/$target" "$source/tests/fuzz/corpus/$target"
done
