#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Counts what damaged bags do to our reader and to librosbag-storage, and what a killed writer of
either leaves. Each read is a process of its own with 2 GB of address space and 10 s.

usage: compare_robustness.py BAG_TOOL ROSBAG_STORAGE_TOOL [COUNT]
"""
import collections
import os
import random
import resource
import signal
import struct
import subprocess
import sys
import tempfile

LIMIT = 2 << 30


def outcome_of(tool, file):
    """How reading ended, in words, and what was said."""
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (LIMIT, LIMIT))
    try:
        done = subprocess.run([tool, "list", file], capture_output=True, timeout=10,
                              preexec_fn=limit)
    except subprocess.TimeoutExpired:
        return "hangs (over 10 s)", ""
    said = done.stderr.decode(errors="replace")
    if "Assertion `buffer_' failed" in said or "bad_alloc" in said:
        return "asks for more than 2 GB", said
    if done.returncode < 0:
        return f"killed by {signal.Signals(-done.returncode).name}", said
    if done.returncode == 0:
        return "reads to the end", said
    return "refuses", said


def damaged(whole, rng):
    """One of the ways in which files go wrong."""
    data = bytearray(whole)
    way = rng.randrange(4)
    if way == 0:
        return bytes(data[:rng.randrange(len(data))])
    for _ in range(rng.choice([1, 1, 3, 10])):
        # The padding of the file header tells nothing.
        at = rng.choice([rng.randrange(13, 100), rng.randrange(4117, len(data) - 4)])
        if way == 1:
            data[at] = rng.randrange(256)
        elif way == 2:
            data[at:at + 4] = struct.pack("<I", rng.choice([0, 2 ** 31, 2 ** 32 - 1, 10 ** 9]))
        else:
            # A length or number behind a field's name.
            name = rng.choice([b"size=", b"count=", b"conn=", b"chunk_pos=", b"index_pos=", b"ver="])
            places = [i for i in range(len(data)) if data.startswith(name, i)]
            place = rng.choice(places) + len(name)
            data[place:place + 4] = struct.pack("<I", rng.randrange(2 ** rng.randrange(1, 33)))
    return bytes(data)


def compare_damaged(tools, count, folder):
    rng = random.Random(1)
    wholes = []
    for compression in ("none", "lz4", "bz2"):
        file = os.path.join(folder, "whole.bag")
        subprocess.run([tools[0], "write", file, compression, "6000", "20", "50"], check=True)
        wholes.append(open(file, "rb").read())
        os.remove(file)
    counts = [collections.Counter() for _ in tools]
    named = collections.Counter()
    for i in range(count):
        file = os.path.join(folder, "damaged.bag")
        with open(file, "wb") as out:
            out.write(damaged(wholes[i % 3], rng))
        for k, tool in enumerate(tools):
            outcome, said = outcome_of(tool, file)
            counts[k][outcome] += 1
            if outcome == "refuses":
                named[k] += file in said and "byte" in said
    for k, tool in enumerate(tools):
        print(f"{os.path.basename(tool)}: {dict(counts[k])}, errors that name file and offset: "
              f"{named[k]}")


def compare_killed(tools, count, folder):
    rng = random.Random(2)
    for writer in tools:
        opened = collections.Counter()
        for _ in range(count):
            file = os.path.join(folder, "killed.bag")
            process = subprocess.Popen([writer, "flood", file])
            wanted = rng.randrange(10 ** 5, 10 ** 7)
            while not os.path.exists(file) or os.path.getsize(file) < wanted:
                assert process.poll() is None
            process.kill()
            process.wait()
            for reader in tools:
                opened[os.path.basename(reader)] += outcome_of(reader, file)[0] == "reads to the end"
            os.remove(file)
        print(f"{count} bags of a killed {os.path.basename(writer)}: opened by {dict(opened)}")


def main():
    tools, count = sys.argv[1:3], int(sys.argv[3]) if len(sys.argv) > 3 else 500
    with tempfile.TemporaryDirectory() as folder:
        compare_damaged(tools, count, folder)
        compare_killed(tools, 20, folder)


main()
