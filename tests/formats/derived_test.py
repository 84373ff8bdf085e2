# SPDX-License-Identifier: BSD-3-Clause
"""usage: derived_test.py AIMS SCENARIO. A walk with compressed clouds and with its IMU in two halves."""

import os
import shutil
import subprocess
import tempfile
import zlib

from cdr import CdrReader, parse_schema
from mcap_file import McapFile
from program_test import GIVEN, ProgramTest, aims, main, simulate
from rosbag2_folder import write_db3
from unitree_messages import CdrWriter

CLOUD = "point_cloud_interfaces/msg/CompressedPointCloud2"


def put_text(out, text):
    data = (text if isinstance(text, bytes) else text.encode()) + b"\0"
    out.put("I", len(data))
    out.data += data


def put_header(out, header):
    out.put("i", header["stamp"]["sec"]).put("I", header["stamp"]["nanosec"])
    put_text(out, header["frame_id"])


def compressed_cloud(cloud, data, transport):
    out = CdrWriter()
    put_header(out, cloud["header"])
    out.put("I", cloud["height"], cloud["width"], len(cloud["fields"]))
    for field in cloud["fields"]:
        put_text(out, field["name"])
        out.put("I", field["offset"]).put("B", field["datatype"]).put("I", field["count"])
    out.put("B", cloud["is_bigendian"]).put("I", cloud["point_step"], cloud["row_step"], len(data))
    out.data += data
    out.put("B", cloud["is_dense"])
    put_text(out, transport)
    return bytes(out.data)


def vector(header, value):
    out = CdrWriter()
    put_header(out, header)
    return bytes(out.put("d", *(value[axis] for axis in "xyz")).data)


def gzip_of(data):
    packer = zlib.compressobj(wbits=31)
    return packer.compress(data) + packer.flush()


def zstd_of(data):
    return subprocess.run(["zstd", "-q", "-c", "--content-size", "--stream-size=" + str(len(data))],
                          input=data, capture_output=True, check=True).stdout


class Derived(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        simulate(GIVEN[1], cls.path("walk.mcap"), "--set", "lidar.columns=180", "--set",
                 "route.points=[{name: a, x: 0, y: 0}, {name: b, x: 1, y: 0}]")
        mcap = McapFile(cls.path("walk.mcap"))
        cls.messages = []
        for message in mcap.messages:
            channel = mcap.channels[message.channel]
            cls.messages.append((channel.topic, mcap.schemas[channel.schema], message))
        cls.raw = cls.poses(cls.write("raw.db3", lambda *_: None))

    @classmethod
    def write(cls, name, change):
        """The walk without legs; `change(topic, value, schema)`: other [(topic, type, definition, data)]."""
        topics, rows = [], []
        for topic, schema, message in cls.messages:
            if topic not in ("/lidar/points", "/imu/data", "/tf_static"):
                continue
            value = CdrReader(parse_schema(schema.name, schema.text)[0], message.data)
            written = change(topic, value.decode(schema.name), schema) or [
                (topic, schema.name, schema.text, message.data)]
            for to, kind, definition, data in written:
                entry = (to, kind, "", definition)
                if entry not in topics:
                    topics.append(entry)
                rows.append((topics.index(entry), message.log_time, data))
        write_db3(cls.path(name), topics, rows)
        return cls.path(name)

    @classmethod
    def poses(cls, recording):
        out = tempfile.mkdtemp(dir=cls.folder.name)
        run = aims("estimate", recording, "--estimators", "lio", "--no-pictures", "--no-page",
                   "--overwrite", "--out", out)
        if run.returncode not in (0, 4):
            raise AssertionError(run.stderr + run.stdout)
        with open(os.path.join(out, "lio.tum"), encoding="utf-8") as stream:
            return stream.read()

    def clouds(self, transport, pack):
        def change(topic, value, schema):
            if topic != "/lidar/points":
                return None
            own, used = schema.text.split("\n====", 1)
            definition = own.replace("] data", "] compressed_data") + "\nstring format\n====" + used
            data = compressed_cloud(value, pack(bytes(value["data"])), transport)
            return [(topic, CLOUD, definition, data)]
        return change

    def test_compressed_clouds_give_the_trajectory_of_the_raw_ones(self):
        packers = {"zlib": ("zlib", zlib.compress), "best": ("zlib", lambda data: zlib.compress(data, 9)),
                   "stored": ("zlib", lambda data: zlib.compress(data, 0)), "gzip": ("zlib", gzip_of)}
        if shutil.which("zstd"):
            packers["zstd"] = ("zstd", zstd_of)
        for name, (transport, pack) in packers.items():
            self.assertEqual(self.poses(self.write(name + ".db3", self.clouds(transport, pack))), self.raw, name)

    def test_other_compressions_are_named(self):
        recording = self.write("draco.db3", self.clouds("draco", lambda data: b"DRACO" + data[:9]))
        self.refuse("topic '/lidar/points' holds clouds compressed by 'draco'; read are zlib and zstd", "estimate",
                    recording, "--estimators", "lio", "--out", self.path("draco"))

    def test_an_imu_in_two_halves_is_one(self):
        def change_vectors(topic, value, _):
            if topic != "/imu/data":
                return None
            text = ("std_msgs/Header header\ngeometry_msgs/Vector3 vector\n" + "=" * 80 +
                    "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + "=" * 80 +
                    "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" + "=" * 80 +
                    "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n")
            kind = "geometry_msgs/msg/Vector3Stamped"
            return [("/imu/angular_velocity", kind, text, vector(value["header"], value["angular_velocity"])),
                    ("/imu/acceleration", kind, text, vector(value["header"], value["linear_acceleration"]))]
        self.compare_split(self.write("vectors.db3", change_vectors))

        def change_halves(topic, value, schema):
            if topic != "/imu/data":
                return None
            whole = CdrWriter()
            put_header(whole, value["header"])
            data = []
            for half in ("angular_velocity", "linear_acceleration"):
                out = CdrWriter()
                put_header(out, value["header"])
                out.put("d", 0, 0, 0, 1).put("d", -1, *[0] * 8)
                for each in ("angular_velocity", "linear_acceleration"):
                    out.put("d", *(value[each][axis] if each == half else 0.0 for axis in "xyz"))
                    out.put("d", *[0] * 9)
                data.append(bytes(out.data))
            return [("/camera/gyro/sample", schema.name, schema.text, data[0]),
                    ("/camera/accel/sample", schema.name, schema.text, data[1])]
        self.compare_split(self.write("halves.db3", change_halves))

    def compare_split(self, recording):
        ours, raw = ([[float(word) for word in line.split()] for line in text.splitlines() if line[0] != "#"]
                     for text in (self.poses(recording), self.raw))
        self.assertEqual(len(ours), len(raw))
        for a, b in zip(ours, raw):
            # The recorded orientation, of which the halves have none, serves the first attitude alone.
            self.assertLess(max(abs(x - y) for x, y in zip(a[1:4], b[1:4])), 0.01)


if __name__ == "__main__":
    main(given=2)
