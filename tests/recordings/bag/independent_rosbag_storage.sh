#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# librosbag-storage lists the same messages of our bags as we do.
# usage: independent_rosbag_storage.sh BAG_TOOL ROSBAG_STORAGE_TOOL
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for compression in none lz4 bz2; do
  for chunk in 1 20000 4000000; do
    bag=$folder/${compression}_$chunk.bag
    "$1" write "$bag" $compression $chunk
    "$1" list "$bag" | sort > "$folder/ours"
    "$2" list "$bag" | sort > "$folder/theirs"
    test -s "$folder/ours"
    cmp "$folder/ours" "$folder/theirs"
    echo "$compression, chunks of $chunk: $(wc -l < "$folder/ours") messages agree"
  done
done
