#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# From a fresh Debian 12 machine to a degenerate corridor: installs, builds, runs, says what to look at.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
mkdir -p build
cat <<'TEXT'
Look at M_list, the error of the corridor's length. It is 78.6 m long with plain walls; for 18.6 m the
LiDAR sees neither end, and no scan constrains the position along the corridor. There `lio` (LiDAR and
IMU) loses its way and its map ends at 60 m, `leg` (legs alone) carries its scale error of 20 %, and
`aims_d` corrects the legs where the scans allow it and stays within 1 %.

TEXT

step "install packages" install_packages
step "configure" configure
step "build" cmake --build build/release --target aims
step "run scenarios/demo.yaml" build/release/aims run demo --out out/demo --overwrite "$@"
echo "The paper's corridor, where the doors show the way: build/release/aims run corridor"
