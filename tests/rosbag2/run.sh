#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# usage: run.sh SOURCE_FOLDER AIMS. Tests recordings of rosbag2 against Python's SQLite and its shell.
set -euo pipefail
if ! /usr/bin/python3 -c 'import sqlite3, yaml' 2>/dev/null || ! command -v sqlite3 >/dev/null; then
  echo "SKIPPED: sqlite3 or python3-yaml is not installed"
  exit 0
fi
PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$1/tests/mcap:$1/tests/support" \
  /usr/bin/python3 "$1/tests/rosbag2/rosbag2_test.py" "$2" "$1/tests/mcap/stand.yaml"
