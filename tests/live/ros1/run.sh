#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: run.sh AIMS AIMS_NODE WORK_FOLDER. Runs the node against a loopback master.
set -euo pipefail
tests="$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"

skip() {
  echo "SKIPPED: $1"
  exit 0
}

command -v rosmaster >/dev/null || skip "python3-rosmaster is not installed"
[[ -x /usr/lib/rosbag/play ]] || skip "python3-rosbag is not installed"
/usr/bin/python3 -c 'import rospy, nav_msgs.msg, tf2_msgs.msg' 2>/dev/null ||
  skip "python3-rospy or the messages of ROS are not installed"

mkdir -p "$3"
cd "$3"
PYTHONDONTWRITEBYTECODE=1 exec /usr/bin/python3 "$tests/node_test.py" "$1" "$2"
