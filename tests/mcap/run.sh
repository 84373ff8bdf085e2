#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: run.sh SOURCE_FOLDER WORK_FOLDER AIMS. Tests the MCAP converter as a copy in the work folder.
set -euo pipefail
source_folder="$1"
work="$2"
tests="$source_folder/tests/mcap"

skip() {
  echo "SKIPPED: $1"
  exit 0
}

for tool in node npm; do
  command -v "$tool" >/dev/null || skip "$tool is not installed"
done
/usr/bin/python3 -c 'import rosbag, genpy.dynamic, nav_msgs.msg, sensor_msgs.msg, tf2_msgs.msg' \
  2>/dev/null || skip "python3-rosbag or the messages of ROS are not installed"

mkdir -p "$work/mcap"
cp "$source_folder/scripts/bag_to_mcap.sh" "$work"
cp -p "$source_folder"/scripts/mcap/*.{mjs,json} "$tests/read_as_viewer.mjs" "$work/mcap"
if [[ ! "$work/mcap/node_modules/.package-lock.json" -nt "$work/mcap/package-lock.json" ]]; then
  if ! npm ci --no-audit --no-fund --prefix "$work/mcap"; then
    npm ping >/dev/null 2>&1 || skip "the npm registry cannot be reached"
    echo "npm ci failed" >&2
    exit 1
  fi
fi
PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 "$tests/mcap_test.py" \
  "$work/bag_to_mcap.sh" "$work/mcap/read_as_viewer.mjs" "$3"
