#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes small inputs for the fuzzers to start from.

usage: make_seeds.py BAG_TOOL AIMS FOLDER   (FOLDER/bag, mcap, db3, pcap, ouster, message, cdr, recording)
"""
import json
import os
import sqlite3
import struct
import subprocess
import sys
import tempfile

import rosbag

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "formats"))
sys.path.insert(1, os.path.join(sys.path[0], "..", "support"))
from lidar_packets import capture, ouster_metadata, ouster_packets, vlp16_packets
from rosidl import idl_of

TOPICS = ["sensor_msgs/Imu", "sensor_msgs/PointCloud2", "nav_msgs/Odometry",
          "sensor_msgs/JointState", "aims_msgs/FootContacts", "tf2_msgs/TFMessage"]


def save(folder, name, data):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, name), "wb") as file:
        file.write(data)


def save_as_ros2(aims, folder):
    """Files of ROS 2 with the messages of a bag, and those of each type."""
    bag = os.path.join(folder, "bag", "none_1500.bag")
    with tempfile.TemporaryDirectory() as work:
        for compression in ("none", "lz4", "zstd"):
            file = os.path.join(work, compression + ".mcap")
            subprocess.run([aims, "convert", bag, "--quiet", "--out", file, "--compression",
                            compression], check=True)
            data = open(file, "rb").read()
            save(folder + "/mcap", compression + ".mcap", data)
        save(folder + "/mcap", "cut.mcap", data[:len(data) * 3 // 4])
        subprocess.run([aims, "convert", bag, "--quiet", "--out", work + "/r/"], check=True)
        file = work + "/r/r_0.db3"
        database = sqlite3.connect(file)
        rows = database.execute(
            "SELECT encoded_message_definition, data, topic_type FROM messages JOIN topics ON "
            "topics.id = topic_id JOIN message_definitions ON topic_type = type "
            "GROUP BY topic_id").fetchall()
        for size in (512, 1024):  # small pages: files that a fuzzer can change
            database.execute(f"PRAGMA page_size = {size}")
            database.execute("VACUUM")
            save(folder + "/db3", f"pages_{size}.db3", open(file, "rb").read())
        database.execute("DELETE FROM messages WHERE id > 3")
        database.commit()
        database.execute("VACUUM")
        small = open(file, "rb").read()
        save(folder + "/db3", "few.db3", small)
        save(folder + "/db3", "cut.db3", small[:len(small) // 2048 * 1024])
    for text, data, kind in rows:
        idl = idl_of("p/msg/T", text).encode()  # the type that the fuzzer decodes
        save(folder + "/cdr", kind.replace("/", "_") + "_idl", struct.pack("<H", len(idl)) + idl + data)
        text = text.encode()
        save(folder + "/cdr", kind.replace("/", "_"), struct.pack("<H", len(text)) + text + data)


def save_captures(folder):
    """Three turns of a VLP-16, of which most packets are missing."""
    packets = vlp16_packets(1_700_000_123 * 10**9, 3)
    for name, every, options in (("micro", 12, {}), ("nano", 20, {"nanoseconds": True}),
                                 ("big", 20, {"order": ">"}), ("vlan", 20, {"vlan": True})):
        save(folder + "/pcap", name + ".pcap", capture(packets[::every], **options))
    for profile in ("LEGACY", "RNG15_RFL8_NIR8", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL"):
        metadata = ouster_metadata(profile, 2, columns=32)
        text = json.dumps(metadata).encode()
        packets = [packet for _, packet in ouster_packets(metadata, 0, 10**9, 3)]
        imu = next(packet for packet in packets if len(packet) == 48)
        save(folder + "/ouster", profile, struct.pack("<H", len(text)) + text +
             b"".join(packet for packet in packets if len(packet) != 48) + imu)
    save(folder + "/pcap", "fragments.pcap", capture([(10**9, bytes(9000)), (2 * 10**9, b"x")]))


def main():
    tool, aims, folder = sys.argv[1:4]
    os.makedirs(os.path.join(folder, "bag"), exist_ok=True)
    for compression in ("none", "lz4", "bz2"):
        for chunk in ("1500", "100000"):
            bag = os.path.join(folder, "bag", f"{compression}_{chunk}.bag")
            subprocess.run([tool, "write", bag, compression, chunk, "4", "10"], check=True)
    whole = open(bag, "rb").read()
    save(folder + "/bag", "cut.bag", whole[:len(whole) * 3 // 4])
    save_as_ros2(aims, folder)
    save_captures(folder)
    recording, seen = b"", set()
    with rosbag.Bag(os.path.join(folder, "bag", "none_1500.bag")) as bag:
        for topic, (kind, data, *_), _ in bag.read_messages(raw=True):
            if kind in TOPICS:
                recording += struct.pack("<BBH", TOPICS.index(kind), 10, len(data)) + data
            if kind not in seen:
                text = next(c for c in bag._get_connections() if c.datatype == kind).msg_def.encode()
                save(folder + "/message", kind.replace("/", "_"),
                     struct.pack("<H", len(text)) + text + data)
            seen.add(kind)
    save(folder + "/recording", "robot", recording)
    for part in (2, 3, 4):
        save(folder + "/recording", f"robot_{part}", recording[:len(recording) // part])


main()
