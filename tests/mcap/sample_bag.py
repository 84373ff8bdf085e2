# SPDX-License-Identifier: BSD-3-Clause
"""Writes, with python3-rosbag, a bag that has every topic of a simulated recording, and one with
every kind of field that a definition can hold."""

import math
import random
import struct

import genpy
import genpy.dynamic
import rosbag
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, Imu, JointState, PointCloud2, PointField
from std_msgs.msg import Empty, String
from tf2_msgs.msg import TFMessage

CONTACTS = """Header header
string[] foot
bool[] contact
================================================================================
MSG: std_msgs/Header
uint32 seq
time stamp
string frame_id
"""

ODDITIES = """# every kind of field
uint8 first
float64 aligned_by_eight
bool flag
int16[] shorts
int64 large
uint64 larger  # than 2^53
string text
byte[3] few
char letter
float32[2] pair
duration span
time[] instants
Inner[] inners
other_pkg/Inner twin
float64[] nothing
Nothing hollow
string[2] words
int8 last
string GREETING= say "hi" # all of this
int32 ANSWER=42  # but not this
bool YES=True
float32 HALF=0.5
================================================================================
MSG: odd_msgs/Inner
uint8 a
float64[] b
string Name
geometry_msgs/Point point
================================================================================
MSG: other_pkg/Inner
int16 small
uint32 big
================================================================================
MSG: odd_msgs/Nothing
# no fields
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
"""

FootContacts = genpy.dynamic.generate_dynamic("aims_msgs/FootContacts", CONTACTS)[
    "aims_msgs/FootContacts"]
_odd = genpy.dynamic.generate_dynamic("odd_msgs/Oddities", ODDITIES)
Oddities = _odd["odd_msgs/Oddities"]

DOUBLES = [0.1, -0.0, math.inf, -math.inf, math.nan, 5e-324, 1.7976931348623157e308, math.pi]


def stamp(nanoseconds):
    return genpy.Time(nanoseconds // 10**9, nanoseconds % 10**9)


def header(message, time, frame):
    message.header.seq = 7
    message.header.stamp = stamp(time)
    message.header.frame_id = frame
    return message


def cloud(rng, time, points):
    message = header(PointCloud2(), time, "lidar")
    layout = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7), ("ring", 16, 4),
              ("time", 18, 7)]
    message.fields = [PointField(name, at, kind, 1) for name, at, kind in layout]
    message.height, message.width, message.point_step = 1, points, 22
    message.row_step, message.is_dense = 22 * points, True
    message.data = rng.randbytes(22 * points)  # any pattern, quiet and signalling NaN too
    return message


def imu(rng, time):
    message = header(Imu(), time, "imu")
    message.orientation.w = math.cos(0.3)
    message.orientation.z = math.sin(0.3)
    for vector in (message.angular_velocity, message.linear_acceleration):
        vector.x, vector.y, vector.z = (rng.choice(DOUBLES) for _ in range(3))
    message.linear_acceleration_covariance = [rng.gauss(0, 1) for _ in range(9)]
    return message


def odometry(rng, time, frame, child):
    message = header(Odometry(), time, frame)
    message.child_frame_id = child
    message.pose.pose.position.x = rng.gauss(0, 100)
    message.pose.pose.orientation.w = 1.0
    message.twist.twist.linear.y = rng.gauss(0, 1)
    message.pose.covariance = [rng.random() for _ in range(36)]
    return message


def joints(rng, time):
    message = header(JointState(), time, "")
    message.name = [f"joint_{i}" * (i % 3 + 1) for i in range(12)]
    message.position = [rng.gauss(0, 1) for _ in range(12)]
    message.velocity = [rng.gauss(0, 1) for _ in range(12)]
    return message


def contacts(rng, time):
    message = header(FootContacts(), time, "")
    message.foot = ["front_left", "front_right", "rear_left", "rear_right"]
    message.contact = [rng.random() < 0.5 for _ in range(4)]
    return message


def extrinsics():
    transforms = []
    for child in ("lidar", "base"):
        transform = header(TransformStamped(), 0, "imu")
        transform.child_frame_id = child
        transform.transform.translation.x = 0.1
        transform.transform.rotation.w = 1.0
        transforms.append(transform)
    return TFMessage(transforms)


def oddities(rng):
    message = Oddities()
    message.first, message.flag, message.letter, message.last = 255, True, 200, -128
    message.aligned_by_eight = math.nan
    message.shorts = [rng.randrange(-2**15, 2**15) for _ in range(rng.randrange(5))]
    message.large, message.larger = -2**63, 2**64 - 1
    message.text = rng.choice(["", "ascii", "Grüße, 道路"])
    message.few, message.pair = [-1, 0, 127], [0.5, -0.0]
    message.span = genpy.Duration(-1, 5)
    message.instants = [stamp(rng.randrange(2**60)) for _ in range(rng.randrange(3))]
    for _ in range(rng.randrange(4)):
        entry = _odd["odd_msgs/Inner"]()
        entry.a, entry.Name = rng.randrange(256), "n" * rng.randrange(4)
        entry.b = [rng.choice(DOUBLES) for _ in range(rng.randrange(3))]
        entry.point.z = rng.random()
        message.inners.append(entry)
    message.twin.small, message.twin.big = -2, 2**32 - 1
    message.words = ["", "two"]
    return message


def camera(time):
    message = header(CameraInfo(), time, "camera")
    message.K, message.D = [float(i) for i in range(9)], [0.1] * 5
    return message


def write(path, compression, seconds=2, points=2000, seed=11):
    """Writes the bag; yields {topic: [(record time [ns], message)]} as it went in."""
    rng = random.Random(seed)
    written = {}
    base = 1700000000 * 10**9
    with rosbag.Bag(path, "w", compression=compression, chunk_threshold=256 * 1024) as bag:
        def put(topic, time, message, delay=0, **options):
            bag.write(topic, message, stamp(base + time + delay), **options)
            written.setdefault(topic, []).append((base + time + delay, message))

        latched = {"callerid": "/test", "latching": "1", "topic": "/tf_static",
                   "type": TFMessage._type, "md5sum": TFMessage._md5sum,
                   "message_definition": TFMessage._full_text}
        put("/tf_static", 0, extrinsics(), connection_header=latched)
        put("/aims/scenario", 0, String("name: corridor\n# Länge\n"))
        for step in range(seconds * 200):
            time = step * 5_000_000
            put("/joint_states", time, joints(rng, time), 1_000)
            put("/foot_contacts", time, contacts(rng, time), 1_000)
            put("/leg_odometry", time, odometry(rng, time, "odom", "base"), 1_000)
            if step % 4 == 0:
                put("/imu/data", time, imu(rng, time), rng.randrange(10**7))
            if step % 20 == 0:
                put("/lidar/points", time, cloud(rng, time, points), 100_000_000)
                put("/ground_truth/imu", time, odometry(rng, time, "world", "imu"))
                put("/odd", time, oddities(rng))
        put("/lidar/points", 10**9, cloud(rng, 10**9, 0))
        put("/camera", 0, camera(0))
        put("/empty", 0, Empty())
    return written


def bits(value):
    """A number's bytes: NaN equals NaN, 0 does not equal -0."""
    return struct.pack("<d", value)
