#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# consumer_test.sh BUILD SOURCE WORK: installs what BUILD has built, moves it to another place, and
# builds and runs the program of this folder against it alone.
set -euo pipefail
build=$1 source=$2 work=$3

fail() {
  echo "FAILED: $*" >&2
  exit 1
}

rm -rf "$work"
mkdir -p "$work"
for component in runtime dev; do
  cmake --install "$build" --prefix "$work/first" --component "$component" >"$work/install.log"
done
mv "$work/first" "$work/moved"  # nothing installed may know where it was put

grep -rIlF -e "$source" -e "$build" -e "$work" "$work/moved" &&
  fail "the files above name a folder of this machine"

cmake -G Ninja -S "$(dirname "$0")" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/moved" \
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" >"$work/configure.log"
cmake --build "$work/build" >"$work/build.log" || { cat "$work/build.log"; fail "does not build"; }

if ldd "$work/build/consumer" | grep -iE 'mujoco|embree|pagmo|sqlite|tbb'; then
  fail "the consumer links the libraries above"
fi

# Ten seconds at 0.5 m/s; the estimated leg scale makes them about 1 % longer.
x=$("$work/build/consumer" | tail -n 1 | cut -d ' ' -f 2)
awk -v x="$x" 'BEGIN { exit !(x > 4.9 && x < 5.1) }' || fail "expected to end near 5 m, found '$x'"

cd /
"$work/moved/bin/aims" list >"$work/list"
grep -qF "$work/moved/share/aims/scenarios" "$work/list" ||
  fail "the installed program does not find its scenarios"

# A recording estimated by the consumer is the recording estimated by the program. The clock of the
# LiDAR does not drift: a reader finds the period of scans from their stamps to a nanosecond.
cat >"$work/walk.yaml" <<'YAML'
scene: {corridor: {length: 10}}
route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 1, y: 0}]}
links: {lidar: {clock_drift_sigma: 0}}
YAML
cd "$work"
moved/bin/aims simulate walk.yaml --quiet -o walk.bag >simulate.log
moved/bin/aims run walk.yaml --quiet --no-pictures --estimators aims --out run >run.log
build/consumer walk.bag >consumer.tum 2>consumer.log
grep -qE '^end error 0\.[0-4]' consumer.log || fail "expected an end error below 0.5 m: $(cat consumer.log)"
cmp consumer.tum run/aims.tum || fail "the consumer's trajectory is not the program's"
[ "$(wc -l <consumer.tum)" -gt 10 ] || fail "the trajectory has no poses"
