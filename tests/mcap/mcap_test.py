# SPDX-License-Identifier: BSD-3-Clause
"""usage: mcap_test.py AIMS SCRIPTS. SCRIPTS: read_as_viewer.mjs and others. Run by tests/mcap/run.sh."""

import json
import os
import re
import signal
import subprocess
import time

import genpy
import rosbag
import yaml

import sample_bag
from cdr import CdrReader, parse_schema
from mcap_file import McapFile
from program_test import GIVEN, ProgramTest, aims, main, poses_of, simulate
from rosidl import SEPARATOR, idl_of

# As in ROS 2's common_interfaces and geometry2; constants and comments left out.
ROS2_FIELDS = {
    "sensor_msgs/msg/PointCloud2":
        "std_msgs/Header header, uint32 height, uint32 width, sensor_msgs/PointField[] fields, "
        "bool is_bigendian, uint32 point_step, uint32 row_step, uint8[] data, bool is_dense",
    "sensor_msgs/msg/PointField": "string name, uint32 offset, uint8 datatype, uint32 count",
    "sensor_msgs/msg/Imu":
        "std_msgs/Header header, geometry_msgs/Quaternion orientation, "
        "float64[9] orientation_covariance, geometry_msgs/Vector3 angular_velocity, "
        "float64[9] angular_velocity_covariance, geometry_msgs/Vector3 linear_acceleration, "
        "float64[9] linear_acceleration_covariance",
    "sensor_msgs/msg/JointState":
        "std_msgs/Header header, string[] name, float64[] position, float64[] velocity, "
        "float64[] effort",
    "sensor_msgs/msg/CameraInfo":
        "std_msgs/Header header, uint32 height, uint32 width, string distortion_model, "
        "float64[] d, float64[9] k, float64[9] r, float64[12] p, uint32 binning_x, "
        "uint32 binning_y, sensor_msgs/RegionOfInterest roi",
    "nav_msgs/msg/Odometry":
        "std_msgs/Header header, string child_frame_id, "
        "geometry_msgs/PoseWithCovariance pose, geometry_msgs/TwistWithCovariance twist",
    "tf2_msgs/msg/TFMessage": "geometry_msgs/TransformStamped[] transforms",
    "geometry_msgs/msg/TransformStamped":
        "std_msgs/Header header, string child_frame_id, geometry_msgs/Transform transform",
    "geometry_msgs/msg/PoseWithCovariance": "geometry_msgs/Pose pose, float64[36] covariance",
    "geometry_msgs/msg/Quaternion": "float64 x, float64 y, float64 z, float64 w",
    "std_msgs/msg/Header": "builtin_interfaces/Time stamp, string frame_id",
    "std_msgs/msg/String": "string data",
    "builtin_interfaces/msg/Time": "int32 sec, uint32 nanosec",
    "builtin_interfaces/msg/Duration": "int32 sec, uint32 nanosec",
    "aims_msgs/msg/FootContacts": "std_msgs/Header header, string[] foot, bool[] contact",
}


def convert(bag, output, *options):
    return aims("convert", bag, "--out", output, *options)


def script(name, *arguments):
    run = subprocess.run(["node", os.path.join(GIVEN[1], name), *arguments], capture_output=True,
                         text=True, check=False)
    assert (run.returncode, run.stderr) == (0, ""), run.stderr
    return run.stdout


def as_ros2(message):
    """What a ROS 1 message must read like in ROS 2; numbers by their bits."""
    if isinstance(message, genpy.Time | genpy.Duration):
        return {"sec": message.secs, "nanosec": message.nsecs}
    if isinstance(message, genpy.Message):
        fields = {}
        for name in message.__slots__:
            if message._type == "std_msgs/Header" and name == "seq":
                continue
            new_name = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
            fields[new_name] = as_ros2(getattr(message, name))
        return fields
    return comparable(message)


def comparable(value):
    if isinstance(value, dict):
        return {name: comparable(each) for name, each in value.items()}
    if isinstance(value, float):
        return sample_bag.bits(value)
    if isinstance(value, str):
        return value.encode()
    if isinstance(value, list | tuple):
        return [as_ros2(each) if isinstance(each, genpy.Message | genpy.rostime.TVal)
                else comparable(each) for each in value]
    return value


def check_messages(test, mcap, written):
    """Holds all messages against {topic: [(record time, message)]}."""
    found, types = {}, {}
    for number, schema in mcap.schemas.items():
        types[number] = parse_schema(schema.name, schema.text)[0]
    for message in mcap.messages:
        channel = mcap.channels[message.channel]
        name = mcap.schemas[channel.schema].name
        value = comparable(CdrReader(types[channel.schema], message.data).decode(name))
        found.setdefault(channel.topic, []).append((message, value))
    test.assertEqual(found.keys(), written.keys())
    for topic, messages in written.items():
        test.assertEqual(len(found[topic]), len(messages), topic)
        in_time = sorted(messages, key=lambda each: each[0])
        for (record_time, sent), (message, value) in zip(in_time, found[topic]):
            test.assertEqual(value, as_ros2(sent), topic)
            test.assertEqual(message.log_time, record_time)
            test.assertEqual(message.publish_time, record_time, topic)


class Sample(ProgramTest):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.bag = cls.path("run.bag")
        cls.written = sample_bag.write(cls.bag, "none")

    def left_over(self):
        return [name for name in os.listdir(self.folder.name) if "partial" in name]


class Conversion(Sample):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        output = cls.path("run.mcap")
        cls.done = convert(cls.bag, output)
        assert cls.done.returncode == 0, cls.done.stderr
        cls.mcap = McapFile(output)  # checks lengths, checksums, indexes and statistics

    def test_every_message_is_there_with_its_times_and_exact_values(self):
        check_messages(self, self.mcap, self.written)

    def test_messages_are_sorted_by_time_and_keep_the_order_of_an_instant(self):
        topics = [self.mcap.channels[message.channel].topic for message in self.mcap.messages]
        first = topics.index("/joint_states")
        self.assertEqual(topics[first:first + 3],
                         ["/joint_states", "/foot_contacts", "/leg_odometry"])
        times = [message.log_time for message in self.mcap.messages]
        self.assertEqual(times, sorted(times))
        for channel in self.mcap.channels:
            numbers = [m.sequence for m in self.mcap.messages if m.channel == channel]
            self.assertEqual(numbers, list(range(len(numbers))))

    def test_types_are_those_of_ros_2(self):
        self.assertEqual(self.mcap.profile, "ros2")
        seen = {}
        for schema in self.mcap.schemas.values():
            self.assertEqual(schema.encoding, "ros2msg")
            seen.update(parse_schema(schema.name, schema.text)[0])
        for name, expected in ROS2_FIELDS.items():
            fields = [f"{kind.replace('/msg/', '/')}{'' if size is None else f'[{size}]'} {field}"
                      for kind, size, field in seen[name]]
            self.assertEqual(", ".join(fields), expected, name)

    def test_constants_are_kept(self):
        schema = next(s for s in self.mcap.schemas.values() if s.name == "odd_msgs/msg/Oddities")
        constants = parse_schema(schema.name, schema.text)[1]
        self.assertEqual(constants, {
            (schema.name, "GREETING"): ("string", '"say \\"hi\\" # all of this"'),
            (schema.name, "ANSWER"): ("int32", "42"),
            (schema.name, "YES"): ("bool", "true"),
            (schema.name, "HALF"): ("float32", "0.5")})

    def test_latched_topics_are_offered_as_transient_local(self):
        for channel in self.mcap.channels.values():
            self.assertEqual(channel.encoding, "cdr")
            durability = 1 if channel.topic == "/tf_static" else 2
            offered, = yaml.safe_load(channel.metadata["offered_qos_profiles"])
            self.assertEqual((offered["reliability"], offered["durability"]), (1, durability))
            for key in ("history", "depth", "deadline", "lifespan", "liveliness",
                        "liveliness_lease_duration", "avoid_ros_namespace_conventions"):
                self.assertIn(key, offered)

    def test_summary_is_printed(self):
        count = sum(len(messages) for messages in self.written.values())
        size = os.path.getsize(self.path("run.mcap"))
        self.assertEqual(self.done.stdout, f"{self.path('run.mcap')}: {count} messages, "
                         f"{len(self.written)} topics, {size} bytes\n")

    def test_the_viewers_own_decoder_reads_the_same_bytes(self):
        read = script("read_as_viewer.mjs", self.path("run.mcap"))
        count = sum(len(messages) for messages in self.written.values())
        foreign = sum(not each.text.isascii() for _, each in self.written["/odd"]) + 1
        self.assertEqual(read, f"{count} messages read, {foreign} not ASCII, 0 differ\n")

    def test_compression_on_either_side_changes_no_message(self):
        for compression in ("bz2", "lz4"):
            bag, output = self.path(compression + ".bag"), self.path(compression + ".mcap")
            sample_bag.write(bag, compression)
            self.assertEqual(convert(bag, output, "--compression", "zstd").returncode, 0)
            self.assertEqual(McapFile(output).messages, self.mcap.messages)
            again = self.path(compression + "-again.mcap")
            self.assertEqual(convert(output, again).returncode, 0)
            self.assertEqual(McapFile(again).messages, self.mcap.messages)


class SimulatedRecording(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        scenario = os.path.join(os.path.dirname(os.path.abspath(__file__)), "stand.yaml")
        cls.bag = simulate(scenario, cls.path("walk.bag"))
        cls.mcap = simulate(scenario, cls.path("walk.mcap"), "--compression", "zstd")
        cls.poses = poses_of(cls.bag, cls.folder.name)

    def test_every_message_is_there_with_its_times_and_exact_values(self):
        output = self.path("converted.mcap")
        done = convert(self.bag, output)
        self.assertEqual(done.returncode, 0, done.stderr)
        written = {}
        with rosbag.Bag(self.bag) as reader:
            for topic, message, record_time in reader.read_messages():
                written.setdefault(topic, []).append((record_time.to_nsec(), message))
        self.assertGreaterEqual(len(written), 10)
        for file in (output, self.mcap):
            check_messages(self, McapFile(file), written)

    def test_the_viewers_own_reader_accepts_what_is_simulated(self):
        packed = self.path("packed.mcap")
        self.assertEqual(convert(self.mcap, packed, "--compression", "lz4").returncode, 0)
        for file in (self.mcap, packed):
            self.assertTrue(script("read_as_viewer.mjs", file).endswith(" 0 differ\n"))

    def test_files_of_other_writers_give_the_same_trajectories(self):
        self.assertEqual(poses_of(self.mcap, self.folder.name), self.poses)
        script("write_as_others.mjs", self.mcap, self.folder.name, self.definitions())
        for form in ("plain", "lz4", "zstd", "unindexed", "unchunked", "big_endian"):
            with self.subTest(form=form):
                poses = poses_of(self.path(form + ".mcap"), self.folder.name)
                self.assertEqual(poses, self.poses)
        without_odometry = ("--set", "recording.topics.leg_odometry=none",
                            "--set", "recording.topics.contacts=/foot_contacts",
                            "--set", "recording.contacts_field=contact",
                            # The odd messages hold no forces, from which feet would learn.
                            "--set", "estimators.*.feet.enabled=false")
        expected = poses_of(self.mcap, self.folder.name, *without_odometry)
        self.assertNotEqual(expected, self.poses)
        for form in ("idl", "idl_big_endian"):
            with self.subTest(form=form):
                file = self.path(form + ".mcap")
                self.assertEqual(poses_of(file, self.folder.name, *without_odometry), expected)
                self.assertIn("odd_msgs/Feet", aims("info", file).stdout)

    def definitions(self):
        """A file with the definitions in OMG IDL of all types, and of the odd one."""
        idl = {schema.name: idl_of(schema.name, schema.text)
               for schema in McapFile(self.mcap).schemas.values()}
        others = idl["sensor_msgs/msg/Imu"].split(SEPARATOR)
        with open(os.path.join(os.path.dirname(__file__), "feet.idl"), encoding="utf-8") as stream:
            used = [each for each in others if each.startswith(("IDL: std_msgs/", "IDL: builtin"))]
            idl["odd_msgs/msg/Feet"] = SEPARATOR.join([stream.read(), *used])
        return self.put("idl.json", json.dumps(idl))


class BadInput(Sample):
    def fails(self, expected, *arguments):
        bag, output, *options = arguments
        run = self.refuse(expected, "convert", bag, "--out", output, *options)
        self.assertEqual(run.stdout, "")
        self.assertEqual(self.left_over(), [])

    def bytes_of_bag(self):
        with open(self.bag, "rb") as stream:
            return stream.read()

    def test_files_that_cannot_be_read_or_written_are_named(self):
        self.fails(self.path("gone.bag") + ": cannot be read: No such file", self.path("gone.bag"),
                   self.path("x.mcap"))
        os.mkdir(self.path("empty"))
        self.fails("it is a directory", self.path("empty"), self.path("x.mcap"))
        self.fails("/proc/nowhere/x.mcap.partial: cannot be created", self.bag,
                   "/proc/nowhere/x.mcap")
        self.fails("is the recording itself", self.bag, self.bag, "--overwrite")
        self.fails("expected a name that ends in", self.bag, self.path("x.txt"))
        self.fails("compression bz2: expected none, lz4 or zstd", self.bag, self.path("x.mcap"),
                   "--compression", "bz2")

    def test_what_is_no_whole_bag_is_told_apart(self):
        whole = self.bytes_of_bag()
        text = self.put("text.bag", b"# a text file\n" * 1000)
        self.fails("text.bag: at byte 0: expected a ROS 1 bag", text, self.path("x.mcap"))
        cut = self.put("cut.bag", whole[:len(whole) // 2])
        self.fails("--recover reads the intact chunks", cut, self.path("x.mcap"))

    def test_a_bag_without_messages_is_no_error(self):
        bag, output = self.path("none.bag"), self.path("none.mcap")
        rosbag.Bag(bag, "w").close()
        self.assertEqual(convert(bag, output).returncode, 0)
        self.assertEqual(McapFile(output).messages, [])

    def test_damage_inside_is_an_error_and_leaves_nothing(self):
        whole = bytearray(self.bytes_of_bag())
        at = whole.index(b"front_left")
        whole[at - 4:at] = b"\xff\xff\xff\x7f"  # a string that claims two gigabytes
        output = self.path("damaged.mcap")
        self.fails("expected a message as its definition states", self.put("damaged.bag", whole), output)
        self.assertFalse(os.path.exists(output))

    def test_an_existing_file_stays_unless_asked(self):
        output = self.put("old.mcap", b"old")
        self.fails("exists already; choose another --out, or --overwrite", self.bag, output)
        with open(output, "rb") as stream:
            self.assertEqual(stream.read(), b"old")
        self.assertEqual(convert(self.bag, output, "--overwrite").returncode, 0)
        McapFile(output)

    def test_interruption_leaves_nothing(self):
        bag, output = self.path("long.bag"), self.path("long.mcap")
        sample_bag.write(bag, "none", seconds=10, points=20000)
        with subprocess.Popen([GIVEN[0], "convert", bag, "--out", output], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE) as run:
            while not self.left_over():
                self.assertIsNone(run.poll())
                time.sleep(0.005)
            run.send_signal(signal.SIGINT)
            run.communicate(timeout=30)
        self.assertEqual(run.returncode, 130)
        self.assertEqual(self.left_over(), [])
        self.assertFalse(os.path.exists(output))


if __name__ == "__main__":
    main(given=2)
