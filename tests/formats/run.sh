#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: run.sh SOURCE_FOLDER AIMS. Tests recordings in the formats of others: a Unitree robot, tables of
# comma-separated values, captures of LiDAR packets, compressed clouds, split IMUs, and results of evo.
set -euo pipefail
if ! /usr/bin/python3 -c 'import sqlite3, yaml' 2>/dev/null; then
  echo "SKIPPED: python3-yaml is not installed"
  exit 0
fi
for test in unitree_test csv_test pcap_test derived_test evo_test; do
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$1/tests/mcap:$1/tests/rosbag2:$1/tests/support" \
    /usr/bin/python3 "$1/tests/formats/$test.py" "$2" "$1/tests/mcap/stand.yaml"
done
