#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes small inputs for the fuzzers to start from.

usage: make_seeds.py BAG_TOOL FOLDER   (FOLDER/bag, FOLDER/message, FOLDER/recording)
"""
import os
import struct
import subprocess
import sys

import rosbag

TOPICS = ["sensor_msgs/Imu", "sensor_msgs/PointCloud2", "nav_msgs/Odometry",
          "sensor_msgs/JointState", "aims_msgs/FootContacts", "tf2_msgs/TFMessage"]


def save(folder, name, data):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, name), "wb") as file:
        file.write(data)


def main():
    tool, folder = sys.argv[1], sys.argv[2]
    os.makedirs(os.path.join(folder, "bag"), exist_ok=True)
    for compression in ("none", "lz4", "bz2"):
        for chunk in ("1500", "100000"):
            bag = os.path.join(folder, "bag", f"{compression}_{chunk}.bag")
            subprocess.run([tool, "write", bag, compression, chunk, "4", "10"], check=True)
    whole = open(bag, "rb").read()
    save(folder + "/bag", "cut.bag", whole[:len(whole) * 3 // 4])
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
