# SPDX-License-Identifier: BSD-3-Clause
"""usage: csv_test.py AIMS SCENARIO. The recording of a walk as a table of comma-separated values."""

import math

import unitree_test
from program_test import aims, main
from unitree_test import LEGS, Walk

MAPPING = """file: {file}
time: t
time_unit: {unit}
gyro: [wx, wy, wz]
gyro_unit: deg/s
accelerometer: [ax, ay, az]
joint_position: [{angles}]
joint_velocity: [{rates}]
foot_force: [f_fl, f_fr, f_rl, f_rr]
"""


class Table(Walk):
    test_a_definition_in_idl_gives_the_same = None
    test_a_standing_robot_teaches_no_threshold = None
    test_feet_at_the_origin_are_no_legs = None
    test_info_finds_the_imu = None
    test_states_carry_the_robot_as_its_joints_do = None

    def mapping(self, name, unit="ns", rates=True):
        columns = [f"{leg}{i}" for leg in LEGS for i in range(3)]
        return self.put(name + ".yaml", MAPPING.format(
            file=name + ".csv", unit=unit, angles=", ".join("q" + each for each in columns),
            rates=", ".join("d" + each for each in columns) if rates else ""))

    def table(self, name, **options):
        unitree_test.random.seed(unitree_test.SEED)
        columns = [f"{leg}{i}" for leg in LEGS for i in range(3)]
        lines = [",".join(["t", "note", "wx", "wy", "wz", "ax", "ay", "az", "f_rr", "f_fl", "f_fr",
                           "f_rl"] + ["q" + c for c in columns] + ["d" + c for c in columns])]
        for stamp, (_, gyro, force), legs in self.states:
            fr, fl, rr, rl = self.forces([legs[leg][2] for leg in unitree_test.FEET])
            numbers = [math.degrees(w) for w in gyro] + list(force) + [rr, fl, fr, rl]
            numbers += [angle for leg in LEGS for angle in legs[leg][0]]
            numbers += [rate for leg in LEGS for rate in legs[leg][1]]
            lines.append(f"{stamp},x," + ",".join(map(repr, numbers)))
        self.put(name + ".csv", "\n".join(lines) + "\n")
        return self.mapping(name, **options)

    def test_a_table_carries_the_robot_as_its_joints_do(self):
        joints, _ = self.poses(self.path("walk.mcap"), "recording.topics.leg_odometry=none")
        low, _ = self.poses(self.write("low.db3", "LowState", self.low_states()),
                            *unitree_test.OWN_LEGS)
        found, said = self.poses(self.table("run"))
        self.assertIn("learned from", said)
        self.assertIn("warning: nothing states the lengths of the legs", said)
        self.differ_by(found, joints, 0.03)
        self.differ_by(found, low, 1e-4)  # of float32 there
        differentiated, _ = self.poses(self.table("angles", rates=False))
        self.assertLess(math.dist(differentiated[-1][1:], joints[-1][1:]), 0.15)
        self.assertEqual(aims("convert", self.path("run.yaml"), "--out", self.path("run.mcap"))
                         .returncode, 0)
        self.assertEqual(self.poses(self.path("run.mcap"))[0], found)

    def refuse_table(self, mapping, expected):
        self.refuse(expected, "info", mapping)

    def test_errors_name_file_row_and_column(self):
        self.put("bad.csv", "t,wx,wy,wz,ax,ay,az\n1,0,0,0,0,0,9.8\n0.5,0,0,0,0,0,9.8\n")
        columns = "gyro: [wx, wy, wz]\naccelerometer: [ax, ay, {}]\n"
        self.refuse_table(self.put("a.yaml", "file: bad.csv\ntime: t\n" + columns.format("az")),
                    "bad.csv:3: t: expected a time >= 1000000000 ns, found '0.5'")
        self.refuse_table(self.put("b.yaml", "file: bad.csv\ntime: t\ntime_unit: s\n" +
                             columns.format("a_z")), "bad.csv:3: t: ")
        self.put("bad.csv", "t,wx,wy,wz,ax,ay,az\n1,0,0,0,0,0,9.8\n2,0,0,0,0,0,9.8\n")
        self.refuse_table(self.put("c.yaml", "file: bad.csv\ntime: t\n" + columns.format("a_z")),
                    "bad.csv: expected a column 'a_z', which the mapping names")
        self.put("bad.csv", "t,wx,wy,wz,ax,ay,az\n1,0,0,0,0,0,9.8\n2,0,up,0,0,0,9.8\n")
        self.refuse_table(self.path("a.yaml"), "bad.csv:3: wy: expected a number, found 'up'")
        self.refuse_table(self.put("d.yaml", "file: bad.csv\ngyro: [wx]\n"),
                    "d.yaml: gyro: expected 3 columns or none, found 1")
        self.refuse_table(self.put("e.yaml", "file: bad.csv\ngiro: [wx]\n"), "e.yaml:2")
        self.refuse_table(self.put("f.yaml", "file: gone.csv\n" + columns.format("az")), "gone.csv")
        self.refuse_table(self.put("g.yaml", "file: bad.csv\ngyro: [wx, wy, wz]\n"),
                    "expected gyro and accelerometer together")


del Walk

if __name__ == "__main__":
    main(given=2)
