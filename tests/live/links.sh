#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: links.sh PROGRAM LIBRARY. PROGRAM links LIBRARY, and none of the libraries that simulate,
# tune, store and draw.
set -euo pipefail
needed=$(ldd "$1" | awk '{ print $1 }')
grep -q "^$2" <<<"$needed" || { echo "ldd shows no $2: $needed"; exit 1; }
if grep -iE 'mujoco|embree|pagmo|sqlite|tbb|cairo|osmesa|libgl|ipopt|nlopt' <<<"$needed"; then
  echo "the program links the libraries above"
  exit 1
fi
