#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Holds our bags against python3-rosbag and genpy: each side reads what the other wrote.

usage: independent_rosbag.py BAG_TOOL FOLDER
"""
import importlib
import os
import random
import shutil
import subprocess
import sys
import zlib

try:
    import genpy
    import genpy.dynamic
    import rosbag
except ImportError as missing:
    print(f"SKIPPED: python3-rosbag and genpy are needed: {missing}")
    sys.exit(0)

PACKAGES = ["std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "tf2_msgs"]
INTEGERS = {"int8": 8, "byte": 8, "int16": 16, "int32": 32, "int64": 64}
NATURALS = {"uint8": 8, "char": 8, "uint16": 16, "uint32": 32, "uint64": 64}


def run(*words, expect=0):
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == expect, (words, done.returncode, done.stderr)
    return done.stdout if expect == 0 else done.stderr


# What our tool prints, made by the other side.

def listed(bag):
    return [f"{t.to_nsec()} {topic} {raw[0]} {len(raw[1])} {zlib.crc32(raw[1]):08x}"
            for topic, raw, t in bag.read_messages(raw=True)]


def text_of(value):
    data = value if isinstance(value, bytes) else value.encode()
    return "'" + data.hex()


def scalar(kind, value):
    if kind == "string":
        return text_of(value)
    if kind in ("time", "duration"):
        return str(value.to_nsec())
    return "%.17g" % float(value)


def array_type(kind):
    return kind[:kind.index("[")] if "[" in kind else None


def is_builtin(kind):
    return kind in INTEGERS or kind in NATURALS or kind in (
        "bool", "float32", "float64", "string", "time", "duration")


def fields(message, prefix=""):
    lines = []
    for name, kind in zip(message.__slots__, message._slot_types):
        value, path, entry = getattr(message, name), prefix + name, array_type(kind)
        if entry and is_builtin(entry):
            lines.append(" ".join([path] + [scalar(entry, each) for each in value]))
        elif entry:
            for i, each in enumerate(value):
                lines += fields(each, f"{path}[{i}].")
        elif is_builtin(kind):
            lines.append(f"{path} {scalar(kind, value)}")
        else:
            lines += fields(value, path + ".")
    return lines


def decoded(bag):
    blocks = []
    for topic, message, t in bag.read_messages():
        blocks.append("\n".join([f"{t.to_nsec()} {topic}"] + fields(message)))
    return blocks


def our_blocks(tool, file):
    """Our decoded messages, cut at the lines 'TIME TOPIC'."""
    blocks = []
    for line in run(tool, "decode", file).splitlines():
        if line[0].isdigit():
            blocks.append(line)
        else:
            blocks[-1] += "\n" + line
    return blocks


def check_same(tool, file, what):
    with rosbag.Bag(file) as bag:
        ours, theirs = run(tool, "list", file).splitlines(), listed(bag)
        times = [int(line.split()[0]) for line in ours]
        assert times == sorted(times), f"{what}: not in order of record time"
        assert sorted(ours) == sorted(theirs), f"{what}: other messages"
        ours, theirs = sorted(our_blocks(tool, file)), sorted(decoded(bag))
        for a, b in zip(ours, theirs):
            assert a == b, f"{what}: decoded otherwise:\n{a[:2000]}\n---\n{b[:2000]}"
        assert len(ours) == len(theirs)
        print(f"{what}: {len(theirs)} messages in {len(bag._chunks)} chunks agree")


# Our bags.

def check_types(file):
    """The md5 of a type is that of the package, and that of the definition as written."""
    with rosbag.Bag(file) as bag:
        for connection in bag._get_connections():
            dynamic = genpy.dynamic.generate_dynamic(connection.datatype, connection.msg_def)
            assert dynamic[connection.datatype]._md5sum == connection.md5sum, connection.datatype
            package, name = connection.datatype.split("/")
            if package == "aims_msgs":
                continue
            known = getattr(importlib.import_module(package + ".msg"), name)
            assert known._md5sum == connection.md5sum, connection.datatype


def check_ours(tool, folder):
    for compression in ("none", "lz4", "bz2"):
        for chunk in (1, 50000):
            file = os.path.join(folder, f"ours_{compression}_{chunk}.bag")
            run(tool, "write", file, compression, str(chunk))
            check_same(tool, file, f"ours, {compression}, chunks of {chunk}")
            check_types(file)


# Their bags.

def random_builtin(kind, rng):
    if kind in INTEGERS:
        return rng.randrange(-2 ** (INTEGERS[kind] - 1), 2 ** (INTEGERS[kind] - 1))
    if kind in NATURALS:
        return rng.randrange(2 ** NATURALS[kind])
    if kind == "bool":
        return bool(rng.randrange(2))
    if kind == "float32":
        return rng.randrange(-2 ** 20, 2 ** 20) / 64
    if kind == "float64":
        return rng.gauss(0, 1e3)
    if kind == "string":
        return "".join(rng.choice("abcäö#= ") for _ in range(rng.randrange(12)))
    if kind == "time":
        return genpy.Time(rng.randrange(2 ** 32), rng.randrange(10 ** 9))
    return genpy.Duration(rng.randrange(-2 ** 31, 2 ** 31), rng.randrange(10 ** 9))


def random_value(kind, rng):
    entry = array_type(kind)
    if entry:
        digits = kind[kind.index("[") + 1:-1]
        count = int(digits) if digits else rng.randrange(5)
        values = [random_value(entry, rng) for _ in range(count)]
        return bytes(v % 256 for v in values) if entry in ("uint8", "char") else values
    if is_builtin(kind):
        return random_builtin(kind, rng)
    package, name = ("std_msgs", "Header") if kind == "Header" else kind.split("/")
    message = getattr(importlib.import_module(package + ".msg"), name)()
    for slot, slot_kind in zip(message.__slots__, message._slot_types):
        setattr(message, slot, random_value(slot_kind, rng))
    return message


def all_types():
    for package in PACKAGES:
        try:
            module = importlib.import_module(package + ".msg")
        except ImportError:
            continue
        for name in sorted(dir(module)):
            kind = getattr(module, name)
            if isinstance(kind, type) and issubclass(kind, genpy.Message):
                yield f"{package}/{name}"


def write_theirs(file, compression, threshold, seed):
    rng = random.Random(seed)
    with rosbag.Bag(file, "w", compression=compression, chunk_threshold=threshold) as bag:
        kinds = list(all_types())
        for i, kind in enumerate(kinds):
            # Record times go up and down: chunks overlap, and so do their messages.
            when = genpy.Time(1000 + rng.randrange(50), rng.randrange(10 ** 9))
            bag.write("/" + kind, random_value(kind, rng), when)
            if i % 3 == 0:
                # A second publisher of the topic, with a connection of its own, and equal times.
                header = {"topic": "/" + kind, "callerid": f"/node{i}",
                          "type": kind, "md5sum": random_value(kind, rng)._md5sum,
                          "message_definition": random_value(kind, rng)._full_text}
                bag.write("/" + kind, random_value(kind, rng), genpy.Time(1020, 0),
                          connection_header=header)
        cloud = random_value("sensor_msgs/PointCloud2", rng)
        cloud.data = bytes(rng.randrange(256) for _ in range(1000)) * 200
        bag.write("/big", cloud, genpy.Time(1, 5))


def check_theirs(tool, folder):
    seed = 0
    for compression in (rosbag.Compression.NONE, rosbag.Compression.LZ4, rosbag.Compression.BZ2):
        for threshold in (1, 20000, 1 << 26):
            seed += 1
            file = os.path.join(folder, f"theirs_{compression}_{threshold}.bag")
            write_theirs(file, compression, threshold, seed)
            check_same(tool, file, f"theirs, {compression}, chunks of {threshold}, seed {seed}")


def check_unclosed(tool, folder):
    """A bag whose writer died: refused, then recovered as `rosbag reindex` would."""
    file = os.path.join(folder, "unclosed.bag")
    if os.fork() == 0:
        bag = rosbag.Bag(file, "w", chunk_threshold=5000)
        for i in range(400):
            bag.write("/s", random_value("std_msgs/String", random.Random(i)), genpy.Time(1 + i))
        bag._file.flush()
        os._exit(0)
    os.wait()
    error = run(tool, "list", file, expect=2)
    assert file in error and "--recover" in error and "rosbag reindex" in error, error
    ours = run(tool, "list", file, "recover").splitlines()
    with rosbag.Bag(file, "a", allow_unindexed=True) as bag:
        for _ in bag.reindex():
            pass
    with rosbag.Bag(file) as bag:
        theirs = listed(bag)
    assert ours and ours == theirs[:len(ours)], "recovered messages differ"
    print(f"unclosed: {len(ours)} messages recovered by us, {len(theirs)} by rosbag reindex")


def check_killed(tool, folder):
    """Our writer, killed at any moment, leaves a bag with an index that rosbag takes."""
    rng, counts = random.Random(3), []
    for _ in range(6):
        file = os.path.join(folder, "killed.bag")
        writer = subprocess.Popen([tool, "flood", file])
        wanted = rng.randrange(10 ** 5, 10 ** 7)
        while not os.path.exists(file) or os.path.getsize(file) < wanted:
            assert writer.poll() is None
        writer.kill()
        writer.wait()
        with rosbag.Bag(file) as bag:
            theirs = listed(bag)
        assert theirs and theirs == run(tool, "list", file).splitlines()
        counts.append(len(theirs))
        os.remove(file)
    print(f"killed: {counts} messages read")


def main():
    tool, folder = sys.argv[1], sys.argv[2]
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    check_ours(tool, folder)
    check_theirs(tool, folder)
    check_unclosed(tool, folder)
    check_killed(tool, folder)
    shutil.rmtree(folder)


main()
