#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes pages of real results for the browser tests.
#
#   tests/render/page/real_pages.sh AIMS OUT     AIMS: the program; OUT: a folder for results, made afresh
#
# OUT/run is a short run; OUT/hostile the same under a name that is HTML; OUT/bare has scores alone.
set -euo pipefail
aims=$1 out=$2
rm -rf "$out"
mkdir -p "$out"
cat >"$out/run.yaml" <<'YAML'
name: short_walk
description: "Stand, walk three metres, turn, walk back"
scene: {corridor: {length: 10, pillars: {spacing: 3}}}
links: {leg_odometry: {burst_fraction: 0.1}}
route:
  stand_before: 2.5
  points: [{name: a, x: 0, y: 0}, {name: b, x: 3, y: 0}, {name: a, x: 0, y: 0}]
YAML
"$aims" run "$out/run.yaml" --estimators aims,lio,leg --quiet --jobs 2 --out "$out/run" >"$out/run.log"
if ! [ -s "$out/run/page.html" ]; then
  grep -q "built without the page" "$out/run.log" || { cat "$out/run.log" >&2; exit 1; }
  echo "skipped: the program was built without the page (npm)"
  exit 77
fi
cp -r "$out/run" "$out/hostile"
sed -i 's|short_walk|</script><script>window.broken=1</script>|' \
  "$out/hostile/config.yaml" "$out/hostile/scores.json"
mkdir "$out/bare"
cp "$out/run/scores.json" "$out/bare"
"$aims" page "$out/hostile" "$out/bare"
# The same folder gives the same page.
"$aims" page "$out/run" --out "$out/again.html"
cmp "$out/run/page.html" "$out/again.html"
