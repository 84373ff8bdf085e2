#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# From a fresh Debian 12 machine to the paper's corridor experiment: installs, builds, runs.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
mkdir -p build

step "install packages" install_packages
step "configure" configure
step "build" cmake --build build/release --target aims
step "run scenarios/paper/corridor.yaml" \
  build/release/aims run scenarios/paper/corridor.yaml --out out/demo --overwrite "$@"
