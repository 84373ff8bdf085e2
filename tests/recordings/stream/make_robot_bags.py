#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes bags as other drivers lay them out, with what went in beside each: NAME.bag, NAME.expected.

usage: make_robot_bags.py FOLDER

An expected file has lines of words:
  scan START_NS END_NS POINTS, then per point: X Y Z INTENSITY OFFSET_NS RING
  leg STAMP_NS, velocity, angular velocity, contacts
"""
import math
import os
import struct
import sys

try:
    import genpy
    import genpy.dynamic
    import rosbag
    from geometry_msgs.msg import TransformStamped, TwistStamped
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import Imu, JointState, PointCloud2, PointField
    from std_msgs.msg import Float32MultiArray
    from tf2_msgs.msg import TFMessage
except ImportError as missing:
    print(f"SKIPPED: python3-rosbag and its messages are needed: {missing}")
    sys.exit(77)

EPOCH = 1_700_000_000_000_000_000
PERIOD = 100_000_000
RINGS, COLUMNS, SCANS = 16, 90, 6
TYPES = {"b": 1, "B": 2, "h": 3, "H": 4, "i": 5, "I": 6, "f": 7, "d": 8}
SIZES = {"b": 1, "B": 1, "h": 2, "H": 2, "i": 4, "I": 4, "f": 4, "d": 8}


def float32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def stamp(ns):
    return genpy.Time(ns // 1_000_000_000, ns % 1_000_000_000)


def seconds(ns):
    """As near as a double comes; a product of the whole would be less near."""
    return ns // 1_000_000_000 + ns % 1_000_000_000 * 1e-9


def room_point(ring, column, rings, columns):
    """A return of a box of 8 x 6 x 3 m around the sensor, spinning clockwise from behind."""
    elevation = math.radians(-15.0 + 30.0 * ring / (rings - 1))
    azimuth = math.pi - 2.0 * math.pi * column / columns
    ray = (math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth),
           math.sin(elevation))
    reach = min(half / abs(c) for half, c in zip((4.0, 3.0, 1.5), ray) if abs(c) > 1e-9)
    return [float32(reach * c) for c in ray]


def scan(rings=RINGS, columns=COLUMNS):
    """All points in firing order: dictionaries with x, y, z, i (0..255), t (ns), ring, column."""
    points = []
    step = PERIOD // columns
    for column in range(columns):
        for ring in range(rings):
            x, y, z = room_point(ring, column, rings, columns)
            points.append({"x": x, "y": y, "z": z, "i": float((7 * ring + column) % 256),
                           "t": column * step + ring * (step // rings // 2), "ring": ring,
                           "column": column})
    return points


def cloud(points, fields, size, values, header_ns, frame="lidar", height=1, row_padding=0,
          big_endian=False):
    """`fields`: (name, offset, type letter); `values(point, start)`: a number per field."""
    message = PointCloud2()
    message.header.stamp = stamp(header_ns)
    message.header.frame_id = frame
    message.height = height
    message.width = len(points) // height
    message.point_step = size
    message.row_step = size * message.width + row_padding
    message.is_bigendian = big_endian
    message.fields = [PointField(name, offset, TYPES[kind], 1) for name, offset, kind in fields]
    order = ">" if big_endian else "<"
    data = bytearray(message.row_step * height)
    for index, point in enumerate(points):
        row, place = divmod(index, message.width)
        base = row * message.row_step + place * size
        for (_, offset, kind), value in zip(fields, values(point)):
            struct.pack_into(order + kind, data, base + offset, value)
    message.data = bytes(data)
    return message


class Robot:
    """One bag and what is expected of it."""

    def __init__(self, folder, name, compression="none", transforms=True):
        self.bag = rosbag.Bag(os.path.join(folder, name + ".bag"), "w", compression=compression)
        self.expected = open(os.path.join(folder, name + ".expected"), "w")
        if transforms:
            self.transforms([("imu", "lidar", (0.1, 0.0, 0.2), (0.0, 0.0, 0.0, 1.0)),
                             ("imu", "base", (0.05, 0.0, -0.03), (0.0, 0.0, 0.0, 1.0))])

    def transforms(self, given):
        message = TFMessage()
        for parent, child, t, q in given:
            each = TransformStamped()
            each.header.frame_id, each.child_frame_id = parent, child
            v, r = each.transform.translation, each.transform.rotation
            v.x, v.y, v.z = t
            r.x, r.y, r.z, r.w = q
            message.transforms.append(each)
        self.bag.write("/tf_static", message, stamp(EPOCH))

    def imu(self, seconds, scale=1.0, rate=(0.0, 0.0, 0.0)):
        for k in range(int(seconds * 50)):
            message = Imu()
            now = EPOCH + k * 20_000_000
            message.header.stamp = stamp(now)
            message.header.frame_id = "imu"
            message.linear_acceleration.z = 9.80665 * scale
            w = message.angular_velocity
            w.x, w.y, w.z = rate
            self.bag.write("/robot/imu", message, stamp(now + 1_000_000))

    def expect_scan(self, start, points, intensity=1.0 / 255.0):
        self.expected.write(f"scan {start} {start + PERIOD} {len(points)}\n")
        for p in points:
            self.expected.write(f"{p['x']!r} {p['y']!r} {p['z']!r} {p['i'] * intensity!r} "
                                f"{p['t']} {p['ring']}\n")

    def close(self):
        self.bag.close()
        self.expected.close()


def scan_starts(count=SCANS):
    return [EPOCH + 50_000_000 + k * PERIOD for k in range(count)]


def simple(folder, name, fields, size, values, header=lambda start: start, compression="none",
           order=lambda points: points, expect=lambda points: points, height=1, row_padding=0,
           big_endian=False, intensity=1.0 / 255.0, rings=RINGS, columns=COLUMNS, scans=SCANS):
    """A bag with one kind of cloud. `order`: of the points in the message."""
    robot = Robot(folder, name, compression)
    robot.imu(1.0)
    points = scan(rings, columns)
    for start in scan_starts(scans):
        message = cloud(order(points), fields, size, lambda p: values(p, start), header(start),
                        height=height, row_padding=row_padding, big_endian=big_endian)
        robot.bag.write("/robot/points", message, stamp(start + PERIOD + 5_000_000))
        robot.expect_scan(start, expect(points), intensity)
    robot.close()


def by_ring_from_top(points):
    return sorted(points, key=lambda p: (-p["ring"], p["column"]))


def velodynes(folder):
    fields = [("x", 0, "f"), ("y", 4, "f"), ("z", 8, "f"), ("intensity", 12, "f"),
              ("ring", 16, "H"), ("time", 18, "f")]
    simple(folder, "velodyne_end", fields, 22,
           lambda p, _: (p["x"], p["y"], p["z"], p["i"], p["ring"], (p["t"] - PERIOD) * 1e-9),
           header=lambda start: start + PERIOD)
    backwards = [("intensity", 4, "f"), ("ring", 9, "H"), ("time", 12, "f"), ("z", 16, "f"),
                 ("y", 24, "f"), ("x", 20, "f")]
    simple(folder, "padded_bz2", backwards, 37,
           lambda p, _: (p["i"], p["ring"], p["t"] * 1e-9, p["z"], p["y"], p["x"]),
           compression="bz2")
    simple(folder, "big_endian", fields, 22,
           lambda p, _: (p["x"], p["y"], p["z"], p["i"], p["ring"], p["t"] * 1e-9),
           big_endian=True)
    big = {"rings": 64, "columns": 1024, "scans": 2}
    simple(folder, "big_lz4", fields, 22,
           lambda p, _: (p["x"], p["y"], p["z"], p["i"], p["ring"], p["t"] * 1e-9),
           compression="lz4", **big)


def ousters(folder):
    def values(p, _):
        return (p["x"], p["y"], p["z"], p["i"], p["t"], int(p["i"]), RINGS - 1 - p["ring"], 3, 99)

    fields = [("x", 0, "f"), ("y", 4, "f"), ("z", 8, "f"), ("intensity", 16, "f"), ("t", 20, "I"),
              ("reflectivity", 24, "H"), ("ring", 26, "B"), ("ambient", 28, "H"),
              ("range", 32, "I")]
    missed = lambda p: (p["column"] + p["ring"]) % 10 == 3

    def with_misses(points):
        return [dict(p, x=0.0, y=0.0, z=0.0) if missed(p) else p for p in by_ring_from_top(points)]

    simple(folder, "ouster", fields, 48, values, compression="lz4", order=with_misses,
           expect=lambda points: [p for p in points if not missed(p)], height=RINGS)
    without_ring = [each for each in fields if each[0] != "ring"]
    simple(folder, "ouster_row_padding", without_ring, 48,
           lambda p, start: values(p, start)[:6] + values(p, start)[7:], order=by_ring_from_top,
           height=RINGS, row_padding=16)
    simple(folder, "column_major", [("x", 0, "d"), ("y", 8, "d"), ("z", 16, "d"), ("i", 24, "f"),
                                    ("time_offset", 28, "I")], 32,
           lambda p, _: (p["x"], p["y"], p["z"], p["i"], p["t"] // 1000), height=COLUMNS,
           expect=lambda points: [dict(p, t=p["t"] // 1000 * 1000) for p in points])


def absolutes(folder):
    fields = [("x", 0, "f"), ("y", 4, "f"), ("z", 8, "f"), ("intensity", 16, "f"),
              ("timestamp", 24, "d"), ("ring", 32, "H")]
    simple(folder, "hesai", fields, 48,
           lambda p, start: (p["x"], p["y"], p["z"], p["i"], seconds(start + p["t"]), p["ring"]),
           header=lambda start: start + PERIOD)
    other = 1_000_000_000_000  # a clock that was never set
    simple(folder, "other_clock", fields, 40,
           lambda p, start: (p["x"], p["y"], p["z"], p["i"],
                             seconds(start - EPOCH + other + p["t"]), p["ring"]))
    livox = [("x", 0, "f"), ("y", 4, "f"), ("z", 8, "f"), ("intensity", 12, "f"), ("tag", 16, "B"),
             ("line", 17, "B"), ("timestamp", 18, "d")]
    simple(folder, "livox_pointcloud", livox, 26,
           lambda p, start: (p["x"], p["y"], p["z"], p["i"], 0, p["ring"], float(start + p["t"])))
    simple(folder, "milliseconds", [("x", 0, "f"), ("y", 4, "f"), ("z", 8, "f"), ("t", 12, "f")],
           16, lambda p, _: (p["x"], p["y"], p["z"], p["t"] * 1e-6), intensity=0.0)
    simple(folder, "bare", [("x", 0, "f"), ("y", 4, "f"), ("z", 8, "f")], 16,
           lambda p, _: (p["x"], p["y"], p["z"]), intensity=0.0)


LIVOX = """Header header
uint64 timebase
uint32 point_num
uint8 lidar_id
uint8[3] rsvd
CustomPoint[] points
================================================================================
MSG: std_msgs/Header
uint32 seq
time stamp
string frame_id
================================================================================
MSG: livox_ros_driver2/CustomPoint
uint32 offset_time
float32 x
float32 y
float32 z
uint8 reflectivity
uint8 tag
uint8 line
"""


def livox_custom(folder):
    """The message of livox_ros_driver2, IMU in g."""
    types = genpy.dynamic.generate_dynamic("livox_ros_driver2/CustomMsg", LIVOX)
    custom, point = types["livox_ros_driver2/CustomMsg"], types["livox_ros_driver2/CustomPoint"]
    robot = Robot(folder, "livox_custom")
    robot.imu(1.0, scale=1.0 / 9.80665)
    points = scan()
    for start in scan_starts():
        message = custom()
        message.header.stamp = stamp(start)
        message.header.frame_id = "lidar"
        message.timebase = start
        message.rsvd = bytes(3)
        message.point_num = len(points)
        for p in points:
            message.points.append(point(p["t"], p["x"], p["y"], p["z"], int(p["i"]), 0, p["ring"]))
        robot.bag.write("/robot/points", message, stamp(start + PERIOD + 5_000_000))
        robot.expect_scan(start, points)
    robot.close()


# A quadruped that walks: feet that rest in the world, a trunk that moves over them.
HIP_X, HIP_Y, ABDUCTION, THIGH, CALF = 0.188, 0.047, 0.08, 0.213, 0.213
SPEED, TURNING = (0.5, -0.1, 0.02), 0.3
LEGS = ["FL", "FR", "RL", "RR"]


def leg_angles(leg, foot):
    side = 1.0 if leg % 2 == 0 else -1.0
    x = foot[0] - (HIP_X if leg < 2 else -HIP_X)
    y = foot[1] - side * HIP_Y
    across = math.hypot(y, foot[2])
    down = math.sqrt(across * across - ABDUCTION * ABDUCTION)
    q0 = math.atan2(y, -foot[2]) - math.atan2(side * ABDUCTION, down)
    length = math.hypot(x, down)
    q2 = -math.acos((length ** 2 - THIGH ** 2 - CALF ** 2) / (2.0 * THIGH * CALF))
    q1 = math.atan2(-x, down) - math.atan2(CALF * math.sin(q2), THIGH + CALF * math.cos(q2))
    return [q0, q1, q2]


def resting_foot(leg, t):
    """In the base, which moves at SPEED and turns about z at TURNING; near t = 0."""
    side = 1.0 if leg % 2 == 0 else -1.0
    foot = ((HIP_X if leg < 2 else -HIP_X) + 0.04 * leg,
            side * (HIP_Y + ABDUCTION + 0.02 * leg), -0.28)
    p = [f - v * t for f, v in zip(foot, SPEED)]
    c, s = math.cos(-TURNING * t), math.sin(-TURNING * t)
    return [c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]]


def joints(t):
    return [q for leg in range(4) for q in leg_angles(leg, resting_foot(leg, t))]


def joint_rates():
    h = 1e-5
    return [(b - a) / (2.0 * h) for a, b in zip(joints(-h), joints(h))]


def legs_by_joints(folder):
    """Feet FL and FR stand; names as on ANYmal, in another order; loads as Float32MultiArray."""
    robot = Robot(folder, "joints_and_contacts")
    robot.imu(1.0, rate=(0.0, 0.0, TURNING))
    position, velocity = joints(0.0), joint_rates()
    for leg in (2, 3):  # in the air: rates that would tell something else
        for joint in range(3):
            velocity[3 * leg + joint] += 1.0
    names = [leg + "_" + part for leg in ("LF", "RF", "LH", "RH") for part in ("HAA", "HFE", "KFE")]
    order = sorted(range(12), key=lambda i: names[i])
    for k in range(150):
        now = EPOCH + 100_000_000 + k * 5_000_000
        message = JointState()
        message.header.stamp = stamp(now)
        message.name = [names[i] for i in order]
        message.position = [position[i] for i in order]
        message.velocity = [velocity[i] for i in order]
        robot.bag.write("/robot/joints", message, stamp(now + 1_000_000))
        robot.bag.write("/robot/foot_force", Float32MultiArray(data=[55.0, 61.0, 1.0, 3.0]),
                        stamp(now + 1_100_000))
        robot.expected.write(f"leg {now} {SPEED[0]!r} {SPEED[1]!r} {SPEED[2]!r} 0 0 {TURNING!r} "
                             "1 1 0 0\n")
    robot.close()


def legs_by_twist(folder):
    """A TwistStamped, an IMU in g, and extrinsics over a chain of frames, one of them turned."""
    robot = Robot(folder, "twist", transforms=False)
    half = math.sqrt(0.5)
    robot.transforms([("base", "imu", (0.0, 0.0, 0.1), (0.0, 0.0, half, half)),
                      ("base", "mast", (0.3, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)),
                      ("mast", "lidar", (0.0, 0.0, 0.2), (0.0, 0.0, 0.0, 1.5))])
    robot.imu(1.0, scale=1.0 / 9.80665)
    for k in range(100):
        now = EPOCH + k * 10_000_000
        message = TwistStamped()
        message.header.stamp = stamp(now)
        message.header.frame_id = "base"
        message.twist.linear.x = 0.4
        message.twist.angular.z = 0.5
        robot.bag.write("/robot/velocity", message, stamp(now + 1_000_000))
        robot.expected.write(f"leg {now} 0.4 0 0 0 0 0.5 0 0 0 0\n")
    points = scan()
    fields = [("x", 0, "f"), ("y", 4, "f"), ("z", 8, "f")]
    for start in scan_starts():
        robot.bag.write("/robot/points",
                        cloud(points, fields, 12, lambda p: (p["x"], p["y"], p["z"]), start),
                        stamp(start + PERIOD + 5_000_000))
    robot.close()


def main():
    folder = sys.argv[1]
    for group in (velodynes, ousters, absolutes, livox_custom, legs_by_joints, legs_by_twist):
        group(folder)


if __name__ == "__main__":
    main()
