#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Proves that the tests can fail: builds the project with one seeded fault at a time (the patches
# beside this script; a patch's first line says what is wrong) and reports which suites catch it. Each
# suite stops at its first failing test; of the scenarios, the four of the label `smoke` run.
#
#   tests/faults/run.sh [--jobs N] [--out DIR] [FAULT...]
#
# Works on a copy of the sources in DIR (build/faults). Writes DIR/report.md. Exit code 1 when a
# fault is caught by no suite, 2 when the sources do not pass without a fault or a patch does not fit.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
out=$root/build/faults
jobs=2
faults=()
while [ $# -gt 0 ]; do
  case $1 in
    --jobs) jobs=$2; shift 2 ;;
    --out) out=$2; shift 2 ;;
    -*) echo "usage: run.sh [--jobs N] [--out DIR] [FAULT...]" >&2; exit 2 ;;
    *) faults+=("$1"); shift ;;
  esac
done
if [ ${#faults[@]} -eq 0 ]; then
  for patch in "$here"/*.patch; do faults+=("$(basename "$patch" .patch)"); done
fi
mkdir -p "$out"
out=$(cd "$out" && pwd)
sources=$out/source
build=$out/build
report=$out/report.md

copy_sources() {
  rm -rf "$sources"
  mkdir -p "$sources"
  tar -C "$root" --exclude=./build --exclude=./out --exclude=./.git -cf - . | tar -C "$sources" -xf -
  # What an interrupted run left compiled with a fault must be compiled again.
  sed -n 's,^+++ b/,,p' "$here"/*.patch | sort -u | (cd "$sources" && xargs touch)
}

configure() {
  cmake -S "$sources" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DAIMS_BENCH=OFF -DAIMS_PAGE=OFF \
    $(command -v ccache >/dev/null && echo -DCMAKE_CXX_COMPILER_LAUNCHER=ccache) >"$out/configure.log"
}

compile() { cmake --build "$build" -j "$jobs" >"$out/build.log" 2>&1; }

# Names of the tests of a label that fail until it stops, one a line; further arguments go to ctest.
failures_in() {
  local suite=$1
  shift
  ctest --test-dir "$build" -L "^$suite\$" -j "$jobs" --timeout 300 --stop-on-failure "$@" \
    >"$out/$suite.log" 2>&1 || true
  grep -q 'tests passed' "$out/$suite.log" || echo "(suite did not run)"
  sed -n 's/^.*[0-9]* - \(.*\) (\(Failed\|Timeout\|SEGFAULT\|Subprocess aborted\|ILLEGAL\|Not Run\|Exit code.*\)).*$/\1/p' \
    "$out/$suite.log" | sort -u
}

# The unit tests, the quick folders first.
unit_failures() {
  local quick='^(core|files|estimator|metrics|bag|stream|sim)\.' failed
  failed=$(failures_in unit -R "$quick")
  if [ -n "$failed" ]; then echo "$failed"; else failures_in unit -E "$quick"; fi
}

# "no", or the first test that failed.
cell() { if [ -z "$1" ]; then echo no; else head -1 <<<"$1"; fi; }

copy_sources
configure
if ! compile; then tail -20 "$out/build.log" >&2; exit 2; fi
failed=$(unit_failures; failures_in smoke)
if [ -n "$failed" ]; then
  printf 'without a fault, these tests fail:\n%s\n' "$failed" >&2
  exit 2
fi

printf '| fault | what is wrong | unit suite | scenario suite |\n|---|---|---|---|\n' >"$report"
missed=0
for fault in "${faults[@]}"; do
  patch_file=$here/$fault.patch
  [ -f "$patch_file" ] || { echo "$fault: no such fault in $here" >&2; exit 2; }
  says=$(head -1 "$patch_file")
  (cd "$sources" && patch -p1 --force --fuzz=0 --quiet <"$patch_file") ||
    { echo "$fault: the patch does not fit the sources" >&2; exit 2; }
  if compile; then
    unit=$(unit_failures)
    scenario=$(failures_in smoke)
  else
    unit="(does not build)" scenario="(does not build)"
  fi
  [ -n "$unit$scenario" ] || missed=$((missed + 1))
  printf '| %s | %s | %s | %s |\n' "$fault" "$says" "$(cell "$unit")" "$(cell "$scenario")" |
    tee -a "$report"
  (cd "$sources" && patch -p1 --force --fuzz=0 --quiet --reverse <"$patch_file")
done
printf '\n%d faults, %d caught by no suite\n' ${#faults[@]} "$missed" | tee -a "$report"
[ "$missed" -eq 0 ]
