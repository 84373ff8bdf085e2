#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# From a fresh Debian 12 machine to a degenerate corridor: installs, builds, runs, says what to look at.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
mkdir -p build
cat <<'TEXT'
A simulated quadruped walks along a plain corridor of 78.6 m. In its middle, for about 24 m, the LiDAR sees
neither end wall, and no scan tells how far the robot has walked; before and behind only a few returns do (the
page shades both: 45 of 79 m). Four estimators get the same data; look at the column M_list, the error of the
corridor's length:
  lio       LiDAR and IMU: loses its way there and ends near 50 m
  leg       legs alone: their steps are taken a fifth too short, all the way
  aims_d    LiDAR, IMU and legs, weighed per direction: corrects the legs where scans allow it: its
            length is right within 0.1 %
  tfs_plus  the same with fixed weights: within 1 %

TEXT

step "install packages" install_packages
step "configure" configure
step "build" cmake --build build/release --target aims
step "run scenarios/demo.yaml" build/release/aims run demo --out out/demo --overwrite "$@"
cat <<'TEXT'
Next: open out/demo/page.html in a browser.
A corridor with doors, which scans do constrain:  build/release/aims run corridor
Both ends open, the hardest:                      build/release/aims run severity_9
TEXT
