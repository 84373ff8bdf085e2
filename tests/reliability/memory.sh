#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Memory, file descriptors and threads of a command over its life, from /proc, and the slope of the
# memory over the second half.
#
#   tests/reliability/memory.sh SECONDS COMMAND...     SECONDS: between samples
set -u
interval=$1
shift
"$@" > /dev/null 2>&1 &
process=$!
samples=$(mktemp)
trap 'rm -f "$samples"' EXIT
while [ -d /proc/$process ]; do
  # All processes of the command, by their parents.
  family="$process $(pgrep -P $process | tr '\n' ' ')"
  rss=0 files=0 threads=0
  for each in $family; do
    anon=$(awk '/^RssAnon/ {print $2}' "/proc/$each/status" 2> /dev/null || true)  # none: it has ended
    count=$(awk '/^Threads/ {print $2}' "/proc/$each/status" 2> /dev/null || true)
    rss=$((rss + ${anon:-0})) threads=$((threads + ${count:-0}))
    files=$((files + $(ls "/proc/$each/fd" 2> /dev/null | wc -l)))
  done
  if [ "$rss" -gt 0 ]; then echo "$SECONDS $rss $files $threads" >> "$samples"; fi
  sleep "$interval"
done
wait $process && code=0 || code=$?
awk -v code=$code '
  {t[NR] = $1; m[NR] = $2; if ($2 > top) top = $2; if ($3 > files) files = $3; if ($4 > threads) threads = $4}
  END {
    for (i = int(NR / 2) + 1; i <= NR; i++) {n++; st += t[i]; sm += m[i]; stt += t[i] * t[i]; stm += t[i] * m[i]}
    slope = n > 1 ? (n * stm - st * sm) / (n * stt - st * st) : 0
    printf "exit code %d, %d samples over %d s: largest memory %.1f MB, slope of the second half %.2f MB/min, " \
           "at most %d open files, %d threads\n", code, NR, t[NR], top / 1024, slope * 60 / 1024, files, threads
  }' "$samples"
