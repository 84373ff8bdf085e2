# SPDX-License-Identifier: BSD-3-Clause
"""usage: unitree_test.py AIMS SCENARIO. The recording of a walk as a Go2 would have made it."""

import math
import os
import random
import tempfile

from cdr import CdrReader, parse_schema
from mcap_file import McapFile
from program_test import GIVEN, ProgramTest, aims, main, simulate
from rosbag2_folder import write_db3
from rosidl import idl_of
from unitree_messages import FEET, LOW_STATE, low_state, sport_state

SEED = 7
LEGS = ("FL", "FR", "RL", "RR")  # of the recorded walk
HIP = (0.188, 0.047)
ABDUCTION, THIGH, CALF = 0.08, 0.213, 0.213


def foot(leg, angles):
    """The foot in the base, for angles of abduction about x, hip and knee about y."""
    side = 1 if leg[1] == "L" else -1
    x = -THIGH * math.sin(angles[1]) - CALF * math.sin(angles[1] + angles[2])
    down = -THIGH * math.cos(angles[1]) - CALF * math.cos(angles[1] + angles[2])
    y = side * ABDUCTION
    c, s = math.cos(angles[0]), math.sin(angles[0])
    front = HIP[0] if leg[0] == "F" else -HIP[0]
    return (front + x, side * HIP[1] + c * y - s * down, s * y + c * down)


def foot_speed(leg, angles, rates):
    step = 1e-6
    ends = [foot(leg, [a + sign * step * r for a, r in zip(angles, rates)]) for sign in (1, -1)]
    return [(a - b) / (2 * step) for a, b in zip(*ends)]


# Lengths of the robot that walked; where none are given, those of a Go2 serve.
OWN_LEGS = [f"recording.leg_geometry.{name}={length}" for name, length in (
    ("hip_x", 0.188), ("hip_y", 0.047), ("abduction", 0.08), ("thigh", 0.213), ("calf", 0.213),
    ("foot_radius", 0.022))]


class Walk(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        # Each state has an IMU sample of its own: repeated ones count once in tables.
        simulate(GIVEN[1], cls.path("walk.mcap"), "--set", "lidar.columns=360",
                 "--set", "imu.rate=200", "--set",
                 "route.points=[{name: a, x: 0, y: 0}, {name: b, x: 1.5, y: 0}]")
        cls.read()

    @classmethod
    def read(cls):
        """The newest IMU sample, contacts and joints at each message of the joints."""
        mcap = McapFile(cls.path("walk.mcap"))
        types = {number: parse_schema(schema.name, schema.text)[0]
                 for number, schema in mcap.schemas.items()}
        state, cls.states = {}, []
        for message in mcap.messages:
            channel = mcap.channels[message.channel]
            if channel.topic not in ("/imu/data", "/foot_contacts", "/joint_states"):
                continue
            reader = CdrReader(types[channel.schema], message.data)
            state[channel.topic] = reader.decode(mcap.schemas[channel.schema].name)
            if channel.topic == "/foot_contacts" and len(state) == 3:
                cls.states.append(cls.state_of(state))

    @staticmethod
    def state_of(messages):
        imu, joints = messages["/imu/data"], messages["/joint_states"]
        stamp = joints["header"]["stamp"]
        vector = lambda value: [value[axis] for axis in "xyz"]
        q = imu["orientation"]
        by_leg = {}
        for i, leg in enumerate(LEGS):
            by_leg[leg] = (joints["position"][3 * i:3 * i + 3], joints["velocity"][3 * i:3 * i + 3],
                           messages["/foot_contacts"]["contact"][i])
        return (stamp["sec"] * 10**9 + stamp["nanosec"],
                ((q["w"], q["x"], q["y"], q["z"]), vector(imu["angular_velocity"]),
                 vector(imu["linear_acceleration"])), by_leg)

    def forces(self, contacts):
        """Raw counts of sensors that differ from foot to foot, with noise and bounces."""
        offset, gain = (20, 5, 0, 33), (90, 160, 60, 240)
        return [max(0, round(offset[i] + (gain[i] * random.uniform(0.7, 1.3) if contact else 0)
                             + random.gauss(0, 1.5))) for i, contact in enumerate(contacts)]

    def write(self, name, kind, messages, definition=""):
        topics = [("/state", f"unitree_go/msg/{kind}", "", definition)]
        write_db3(self.path(name), topics, [(0, time, data) for time, data in messages],
                  version=4 if definition else 2)
        return self.path(name)

    def low_states(self):
        random.seed(SEED)
        for stamp, imu, legs in self.states:
            angles = [angle for leg in FEET for angle in legs[leg][0]]
            rates = [rate for leg in FEET for rate in legs[leg][1]]
            yield stamp, low_state(imu, angles, rates, self.forces([legs[leg][2] for leg in FEET]))

    def sport_states(self, zero=False):
        random.seed(SEED)
        for stamp, imu, legs in self.states:
            feet = [x for leg in FEET for x in foot(leg, legs[leg][0])]
            speeds = [x for leg in FEET for x in foot_speed(leg, *legs[leg][:2])]
            if zero:
                feet = [0] * 12
            yield stamp + 10**6, sport_state(stamp, imu, feet, speeds,
                                             self.forces([legs[leg][2] for leg in FEET]))

    def poses(self, recording, *settings):
        """[(stamp, x, y, z)] of the legs alone, and what the program said."""
        out = tempfile.mkdtemp(dir=self.folder.name)
        options = [option for setting in ("recording.topics.lidar=none", *settings)
                   for option in ("--set", setting)]
        run = aims("estimate", recording, "--estimators", "leg", "--no-pictures", "--no-page",
                        "--overwrite", "--out", out, *options)
        self.assertIn(run.returncode, (0, 4), run.stderr + run.stdout)
        with open(os.path.join(out, "leg.tum"), encoding="utf-8") as stream:
            lines = [[float(word) for word in line.split()] for line in stream if line[0] != "#"]
        return [line[:4] for line in lines], run.stdout + run.stderr

    def differ_by(self, poses, others, tolerance):
        at = {round(pose[0], 2): pose for pose in others}
        common = [(pose, at[round(pose[0], 2)]) for pose in poses if round(pose[0], 2) in at]
        self.assertGreater(len(common), 0.8 * len(others))
        for pose, other in common:
            self.assertLess(math.dist(pose[1:], other[1:]), tolerance, f"seed {SEED}")

    def test_states_carry_the_robot_as_its_joints_do(self):
        joints, _ = self.poses(self.path("walk.mcap"), "recording.topics.leg_odometry=none")
        low, said = self.poses(self.write("low.db3", "LowState", self.low_states()),
                               *OWN_LEGS)
        self.assertIn("learned from", said)
        sport, said = self.poses(self.write("sport.db3", "SportModeState", self.sport_states()))
        self.assertIn("learned from", said)
        self.assertGreater(joints[-1][1] - joints[0][1], 1.0)
        # The states repeat each sample of the IMU, to which the legs are levelled.
        self.differ_by(low, joints, 0.03)
        # The kinematics here are the program's.
        self.differ_by(sport, low, 1e-5)

    def test_a_definition_in_idl_gives_the_same(self):
        low, _ = self.poses(self.write("plain.db3", "LowState", self.low_states()))
        text = idl_of("unitree_go/msg/LowState", LOW_STATE)
        self.assertIn("typedef unitree_go__msg__MotorState unitree_go__msg__MotorState__20[20];", text)
        idl, _ = self.poses(self.write("idl.db3", "LowState", self.low_states(), text))
        self.assertEqual(idl, low)

    def test_a_standing_robot_teaches_no_threshold(self):
        states = list(self.low_states())[:150]
        standing = self.write("standing.db3", "LowState", states[:60] * 3)
        run = aims("estimate", standing, "--estimators", "leg", "--out", self.path("none"),
                        "--set", "recording.topics.lidar=none")
        self.assertEqual(run.returncode, 2)
        self.assertIn("field 'foot_force': no threshold of contact can be learned: F", run.stderr)
        self.assertIn("set contact_detection: threshold with contact_threshold", run.stderr)
        _, said = self.poses(standing, "recording.contact_detection=threshold")
        self.assertNotIn("learned", said)

    def test_feet_at_the_origin_are_no_legs(self):
        run = aims("info", self.write("wheels.db3", "SportModeState", self.sport_states(True)),
                        "--set", "recording.topics.lidar=none")
        self.assertIn("foot_position_body is zero: estimators run without legs", run.stdout)

    def test_info_finds_the_imu(self):
        info = aims("info", self.write("info.db3", "LowState", self.low_states()))
        self.assertIn("IMU /state: specific force in m/s^2, orientation valid", info.stdout)


if __name__ == "__main__":
    main(given=2)
