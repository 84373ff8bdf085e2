#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Converts a ROS 1 bag into MCAP: scripts/bag_to_mcap.sh RUN.bag RUN.mcap [--compress zstd]
# Installs the converter's packages on first use.
set -euo pipefail
tool="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/mcap"
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  echo "bag_to_mcap.sh: node (18 or newer) and npm are needed, e.g. apt-get install nodejs npm" >&2
  exit 2
fi
# Npm writes this list last: it is older than the lock file, or absent, until all is installed.
if [[ ! "$tool/node_modules/.package-lock.json" -nt "$tool/package-lock.json" ]]; then
  if ! log="$(npm ci --omit=dev --no-audit --no-fund --prefix "$tool" 2>&1)"; then
    printf '%s\n' "$log" >&2
    echo "bag_to_mcap.sh: the converter's packages could not be installed" >&2
    exit 2
  fi
fi
exec node "$tool/bag-to-mcap.mjs" "$@"
