#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: run.sh SOURCE_FOLDER WORK_FOLDER AIMS. Tests MCAP files against the packages of others, which
# are installed in the work folder.
set -euo pipefail
tests="$1/tests/mcap"
work="$2"

skip() {
  echo "SKIPPED: $1"
  exit 0
}

for tool in node npm; do
  command -v "$tool" >/dev/null || skip "$tool is not installed"
done
/usr/bin/python3 -c 'import rosbag, genpy.dynamic, nav_msgs.msg, sensor_msgs.msg, tf2_msgs.msg' \
  2>/dev/null || skip "python3-rosbag or the messages of ROS are not installed"

mkdir -p "$work"
cp -p "$tests"/*.{mjs,json} "$work"
# Npm writes this list last: it is older than the lock file, or absent, until all is installed.
if [[ ! "$work/node_modules/.package-lock.json" -nt "$work/package-lock.json" ]]; then
  if ! npm ci --no-audit --no-fund --prefix "$work"; then
    npm ping >/dev/null 2>&1 || skip "the npm registry cannot be reached"
    echo "npm ci failed" >&2
    exit 1
  fi
fi
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$1/tests/support" /usr/bin/python3 "$tests/mcap_test.py" "$3" "$work"
