# SPDX-License-Identifier: BSD-3-Clause
"""usage: pcap_test.py AIMS SCENARIO. Captures of LiDAR packets, against the room that they show."""

import math
import struct
import tempfile

from cdr import CdrReader, parse_schema
from lidar_packets import ROOM, VLP16_ELEVATIONS, capture, vlp16_packets, write_ouster
from mcap_file import McapFile
from program_test import ProgramTest, aims, main

START = 1_700_000_123 * 10**9 + 456_000  # near the middle of an hour


class Captures(ProgramTest):
    def messages(self, recording, *options):
        """{topic: [(record time, message)]} of what a capture becomes."""
        output = tempfile.mktemp(suffix=".mcap", dir=self.folder.name)
        run = aims("convert", recording, "--quiet", "--out", output, *options)
        self.assertEqual(run.returncode, 0, run.stderr)
        mcap, found = McapFile(output), {}
        for message in mcap.messages:
            channel = mcap.channels[message.channel]
            schema = mcap.schemas[channel.schema]
            value = CdrReader(parse_schema(schema.name, schema.text)[0], message.data)
            found.setdefault(channel.topic, []).append((message.log_time, value.decode(schema.name)))
        return found

    def points(self, cloud):
        """[(x, y, z, intensity, ring, time)]."""
        fields = {field["name"]: field["offset"] for field in cloud["fields"]}
        step = cloud["point_step"]
        for at in range(0, len(cloud["data"]), step):
            xyz = struct.unpack_from("<fff", cloud["data"], at)
            intensity, = struct.unpack_from("<f", cloud["data"], at + fields[b"intensity"])
            ring, = struct.unpack_from("<H", cloud["data"], at + fields[b"ring"])
            time, = struct.unpack_from("<f", cloud["data"], at + fields[b"time"])
            yield *xyz, intensity, ring, time

    def check_walls(self, points, tolerance):
        for x, y, z, *_ in points:
            nearest = min(abs(abs(value) - half) for value, half in zip((x, y, z), ROOM))
            self.assertLess(nearest, tolerance)

    def stamp(self, message):
        stamp = message["header"]["stamp"]
        return stamp["sec"] * 10**9 + stamp["nanosec"]

    def check_vlp16(self, recording, points_per_turn):
        scans = self.messages(recording)["/lidar/points"]
        self.assertEqual(len(scans), 2)
        for number, (record_time, cloud) in enumerate(scans):
            points = list(self.points(cloud))
            self.assertAlmostEqual(len(points), points_per_turn, delta=0.02 * points_per_turn)
            self.check_walls(points, 0.004)
            # The turn from 210 degrees to zero takes 41.7 ms.
            start = START + round((15 / 36 + number) * 10**8)
            self.assertAlmostEqual(self.stamp(cloud), start, delta=200_000)
            self.assertAlmostEqual(record_time, start + 10**8, delta=1_700_000)
            times = [point[5] for point in points]
            self.assertEqual(times, sorted(times))
            self.assertAlmostEqual(times[-1], 0.1, delta=0.0003)
            for x, y, z, intensity, ring, time in points:
                laser = VLP16_ELEVATIONS.index(-15 + 2 * ring)
                self.assertAlmostEqual(intensity, (100 + laser) / 255, places=5)
                elevation = math.degrees(math.atan2(z, math.hypot(x, y)))
                self.assertAlmostEqual(elevation, -15 + 2 * ring, delta=0.3)
                # The head turns clockwise, by 3.6 degrees each millisecond.
                azimuth = -math.degrees(math.atan2(y, x)) % 360
                self.assertLess(abs((azimuth - 3600 * time + 180) % 360 - 180), 1.0)

    def test_vlp16_points_lie_on_the_walls_at_their_firing_times(self):
        packets = vlp16_packets(START, 3)
        per_turn = 16 * 0.1 / 55.296e-6
        for form, options in (("micro", {}), ("nano", {"nanoseconds": True}),
                              ("big", {"order": ">"}), ("vlan", {"vlan": True})):
            with self.subTest(form=form):
                self.check_vlp16(self.put(form + ".pcap", capture(packets, **options)), per_turn)
        with self.subTest(form="dual"):
            self.check_vlp16(self.put("dual.pcap", capture(vlp16_packets(START, 3, dual=True))),
                             per_turn)

    def test_a_packet_stamped_before_the_hour_belongs_to_that_hour(self):
        start = START // (3600 * 10**9) * 3600 * 10**9 - 150 * 10**6
        packets = [(time + 1_000_000_000, payload) for time, payload in vlp16_packets(start, 3)]
        scans = self.messages(self.put("hour.pcap", capture(packets)))["/lidar/points"]
        for number, (_, cloud) in enumerate(scans):
            self.assertAlmostEqual(self.stamp(cloud), start + round((15 / 36 + number) * 10**8),
                                   delta=200_000)

    def check_ouster(self, profile, tolerance):
        recording = self.path(profile + ".pcap")
        metadata = write_ouster(recording, profile)
        found = self.messages(recording)
        scans = found["/lidar/points"]
        self.assertEqual(len(scans), 2)  # of four frames the outer ones may be incomplete
        for number, (_, cloud) in enumerate(scans):
            points = list(self.points(cloud))
            self.assertEqual(len(points), 16 * (512 - 6))
            self.check_walls(points, tolerance)
            self.assertEqual(self.stamp(cloud), 55 * 10**9 + (number + 1) * 10**8)
            for x, y, z, intensity, ring, time in points:
                self.assertAlmostEqual(intensity, 77 / 255, places=5)
                column = time * 512 / 0.1
                self.assertAlmostEqual(column, round(column), delta=1e-3)
                elevation = math.degrees(math.atan2(z, math.hypot(x, y) - 0.015806))
                self.assertAlmostEqual(
                    elevation, metadata["beam_intrinsics"]["beam_altitude_angles"][15 - ring],
                    delta=0.05 if tolerance < 0.005 else 0.3)
        for _, imu in found["/imu/data"]:
            self.assertAlmostEqual(imu["angular_velocity"]["z"], math.radians(30), places=6)
            self.assertAlmostEqual(imu["linear_acceleration"]["z"], 0.8 * 9.80665, places=5)
        self.assertGreater(len(found["/imu/data"]), 40)
        (_, frames), = found["/tf_static"]
        lidar, imu = (each["transform"] for each in frames["transforms"])
        self.assertAlmostEqual(lidar["translation"]["z"], 0.03618)
        self.assertAlmostEqual(abs(lidar["rotation"]["z"]), 1.0)
        self.assertAlmostEqual(imu["translation"]["x"], 0.006253)

    def test_ouster_points_lie_on_the_walls_at_their_columns_times(self):
        for profile in ("LEGACY", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL"):
            with self.subTest(profile=profile):
                self.check_ouster(profile, 0.002)
        with self.subTest(profile="RNG15_RFL8_NIR8"):
            self.check_ouster("RNG15_RFL8_NIR8", 0.012)

    def test_an_ouster_is_estimated_with_its_own_imu_and_frames(self):
        write_ouster(self.path("os.pcap"), "RNG19_RFL8_SIG16_NIR16", frames=6)
        info = aims("info", self.path("os.pcap"))
        self.assertEqual(info.returncode, 0, info.stderr)
        self.assertNotIn("NO TRANSFORM", info.stdout)
        self.assertNotIn("not readable by aims estimate", info.stdout)

    def test_a_vlp16_has_no_imu(self):
        recording = self.put("alone.pcap", capture(vlp16_packets(START, 3)))
        self.refuse("no topic is sensor_msgs/Imu (recording.topics.imu; 'none' to do without); it has "
                    "/lidar/points", "estimate", recording, "--estimators", "lio", "--out",
                    self.path("alone"))

    def refuse_capture(self, expected, recording, *options):
        self.refuse(expected, "info", recording, *options)

    def test_what_is_no_such_capture_is_named(self):
        packets = vlp16_packets(START, 3)
        whole = capture(packets)
        self.refuse_capture("expected complete scans of a Velodyne VLP-16, Puck Hi-Res, HDL-32E or "
                    "VLP-32C, a Hesai XT32 or XT16, or a RoboSense RS-LiDAR-16, found none: ",
                    self.put("none.pcap", capture([(START, b"hello")])))
        self.refuse_capture("packets of a VLS-128 (0xa1); read are",
                    self.put("vls128.pcap", capture(vlp16_packets(START, 1, model=0xa1))))
        self.refuse_capture("expected 1248 bytes, but the file ends",
                    self.put("cut.pcap", whole[:-700]))
        self.refuse_capture("--recover reads the part before", self.path("cut.pcap"))
        self.assertEqual(len(self.messages(self.path("cut.pcap"), "--recover")["/lidar/points"]), 2)
        self.refuse_capture("found pcapng: `editcap -F pcap", self.put("ng.pcap", b"\x0a\x0d\x0d\x0a" * 20))
        link = bytearray(whole)
        link[20] = 105
        self.refuse_capture("found link type 105", self.put("wifi.pcap", bytes(link)))
        self.put("os.pcap", whole)
        self.put("os.json", b'{"beam_altitude_angles": [1, 2], "beam_azimuth_angles": [1]}')
        self.refuse_capture("os.json: beam_altitude_angles, beam_azimuth_angles: expected an angle of each "
                    "beam, found 2 and 1", self.path("os.pcap"))
        self.put("os.json", b'{"udp_profile_lidar": "FUSA_RNG15_RFL8_NIR8_DUAL"}')
        self.refuse_capture("udp_profile_lidar: expected LEGACY", self.path("os.pcap"))


if __name__ == "__main__":
    main(given=2)
