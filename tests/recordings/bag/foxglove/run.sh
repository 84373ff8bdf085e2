#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# npm's @foxglove/rosbag lists and decodes the same messages of our bags as we do. The packages are
# installed once, into FOLDER, as the lock file says.
# usage: run.sh BAG_TOOL FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
tool=$1
mkdir -p "$2"
cd "$2"
for command in node npm; do
  command -v $command > /dev/null || { echo "SKIPPED: $command is not installed"; exit 0; }
done
if ! cmp -s "$here/package-lock.json" installed-lock.json; then
  cp "$here/package.json" "$here/package-lock.json" .
  npm ci --no-audit --no-fund > npm.log 2>&1 ||
    { tail -3 npm.log; echo "SKIPPED: npm ci failed, perhaps without a registry"; exit 0; }
  cp package-lock.json installed-lock.json
fi
for compression in none lz4 bz2; do
  for chunk in 1 20000; do
    bag=${compression}_$chunk.bag
    rm -f "$bag"
    "$tool" write "$bag" $compression $chunk
    "$tool" list "$bag" | sort > ours
    node "$here/list_bag.mjs" "$bag" | sort > theirs
    test -s ours
    cmp ours theirs
    echo "$compression, chunks of $chunk: $(wc -l < ours) messages agree"
  done
done
