#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs, builds and tests the project on a fresh Debian 12 machine; `ctest --preset release -L nightly` has the
# scenarios and statistics that take longer.
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
mkdir -p build

step "install packages" install_packages
step "configure" configure
step "build" cmake --build build/release
step "test" ctest --preset release -j 2 -LE "stress|nightly" "$@"
