# SPDX-License-Identifier: BSD-3-Clause
"""usage: node_test.py AIMS AIMS_NODE. Run by tests/live/ros1/run.sh in a folder of its own."""

import os
import shutil
import signal
import subprocess
import sys
import unittest

from network import PATIENCE_S, Network, free_port, wait_until

AIMS, NODE = None, None
# Eleven seconds: standing, then three metres.
SCENARIO = [os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "walk.yaml")]
TOLERANCE_M = 0.05  # messages of different topics may overtake each other on the network


def poses_of(file):
    with open(file, encoding="ascii") as stream:
        rows = [line.split() for line in stream if not line.startswith("#")]
    return {round(float(row[0]) * 1e9): tuple(map(float, row[1:])) for row in rows}


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a[:3], b[:3])) ** 0.5


class Listener:
    """Subscribes to ~odometry and /tf."""

    def __init__(self, network):
        for name in ("ROS_MASTER_URI", "ROS_IP", "ROS_LOG_DIR"):
            os.environ[name] = network.environment[name]
        import rospy
        from nav_msgs.msg import Odometry
        from tf2_msgs.msg import TFMessage
        rospy.init_node("listener", disable_signals=True)
        self.odometry, self.transforms = [], []
        rospy.Subscriber("/aims_node/odometry", Odometry, self.odometry.append)
        rospy.Subscriber("/tf", TFMessage, self.transforms.append)


class LiveEstimate(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for name in ("walk.bag", "offline", "live", "live.bag"):
            shutil.rmtree(name, ignore_errors=True)
            if os.path.isfile(name):
                os.remove(name)
        subprocess.run([AIMS, "simulate", *SCENARIO, "-o", "walk.bag", "--quiet",
                        "--overwrite"], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([AIMS, "estimate", "walk.bag", "--out", "offline", "--overwrite", "--quiet",
                        "--no-pictures"], check=True, stdout=subprocess.DEVNULL)
        cls.offline = poses_of("offline/aims_d.tum")
        with Network(os.path.abspath("log")) as network:
            cls.run_live(network)
        cls.live = poses_of("live/aims_d.tum")

    @classmethod
    def run_live(cls, network):
        cls.listener = Listener(network)
        with open("node.log", "w", encoding="utf-8") as log:
            node = network.start([NODE, "--tf", "--settle", "2", "--out", "live", "--record", "live.bag", "--set",
                                  "recording.topics.lidar=/lidar/points"], stdout=log, stderr=log)
            play = network.start(["/usr/lib/rosbag/play", "--quiet", "--wait-for-subscribers", "walk.bag"],
                                 stdout=subprocess.DEVNULL)
            cls.play_code = play.wait(PATIENCE_S)
            # With publishers, it may wait for more.
            wait_until(lambda: node.poll() is not None or
                       any(line.endswith("no messages") for line in cls.said().splitlines()), "silence")
            wait_until(cls.heard_the_last, "the last odometry")
            node.send_signal(signal.SIGINT)
            cls.node_code = node.wait(PATIENCE_S)
        cls.log = cls.said()

    @staticmethod
    def said():
        with open("node.log", encoding="utf-8") as log:
            return log.read()

    @classmethod
    def heard_the_last(cls):
        written = max(poses_of("live/aims_d.tum"), default=None)
        return cls.listener.odometry and cls.listener.odometry[-1].header.stamp.to_nsec() == written

    def test_an_error_of_a_missing_topic_lists_the_existing_ones(self):
        with Network(os.path.abspath("log")) as network:
            network.start(["/usr/lib/rosbag/play", "--quiet", "walk.bag"],
                          stdout=subprocess.DEVNULL)
            wait_until(lambda: network.publishers("/imu/data"), "the player")
            fails(self, ["timeout after 8 s", "/absent", "/imu/data"], network.environment,
                  "--settle", "1", "--patience", "8", "--set", "recording.topics.imu=/absent")

    def test_the_node_ends_well(self):
        self.assertEqual((self.play_code, self.node_code), (0, 0), self.log)
        self.assertIn("aims_d publishes /aims_node/odometry", self.log)

    def test_live_poses_are_those_of_the_bag(self):
        common = sorted(self.offline.keys() & self.live.keys())
        self.assertGreater(len(common), 0.9 * len(self.offline), self.log)
        worst = max(distance(self.offline[stamp], self.live[stamp]) for stamp in common)
        walked = distance(self.offline[common[0]], self.offline[common[-1]])
        print(f"{len(common)} of {len(self.offline)} poses, {walked:.2f} m walked, "
              f"live within {1000 * worst:.3f} mm of offline")
        self.assertGreater(walked, 1.0)
        self.assertLess(worst, TOLERANCE_M)

    def test_the_record_of_what_was_read_gives_the_same_bytes(self):
        subprocess.run([AIMS, "estimate", "live.bag", "--out", "again", "--overwrite", "--quiet",
                        "--no-pictures", "--no-page", "--set", "recording.topics.lidar=/lidar/points"],
                       check=True, stdout=subprocess.DEVNULL)
        with open("live/aims_d.tum", "rb") as live, open("again/aims_d.tum", "rb") as again:
            self.assertEqual(live.read(), again.read())

    def test_published_odometry_is_what_the_node_writes(self):
        self.assertGreater(len(self.listener.odometry), 0.8 * len(self.live))
        for message in self.listener.odometry:
            pose = message.pose.pose
            published = (pose.position.x, pose.position.y, pose.position.z, pose.orientation.x,
                    pose.orientation.y, pose.orientation.z, pose.orientation.w)
            self.assertEqual(published, self.live[message.header.stamp.to_nsec()])
            self.assertEqual((message.header.frame_id, message.child_frame_id), ("odom", "imu"))

    def test_transforms_are_those_of_the_odometry(self):
        odometry = {m.header.stamp.to_nsec(): m.pose.pose.position for m in self.listener.odometry}
        self.assertGreater(len(self.listener.transforms), 0.8 * len(odometry))
        for message in self.listener.transforms:
            transform, = message.transforms
            position = odometry.get(transform.header.stamp.to_nsec())
            moved = transform.transform.translation
            if position:
                self.assertEqual((moved.x, moved.y, moved.z), (position.x, position.y, position.z))
            self.assertEqual((transform.header.frame_id, transform.child_frame_id), ("odom", "imu"))

    def test_twist_is_the_change_of_the_pose(self):
        walking = [m for m in self.listener.odometry if abs(m.twist.twist.linear.x) > 0.1]
        self.assertGreater(len(walking), 10)


def fails(test, expected, environment, *arguments):
    run = subprocess.run([NODE, *arguments], capture_output=True, text=True, check=False,
                         env=environment, timeout=PATIENCE_S)
    test.assertEqual(run.returncode, 2, run.stderr)
    test.assertEqual(run.stderr.count("\n"), 1, run.stderr)
    for text in expected:
        test.assertIn(text, run.stderr)


class BadUsage(unittest.TestCase):
    def test_a_missing_master_is_an_error(self):
        nowhere = dict(os.environ, ROS_MASTER_URI=f"http://127.0.0.1:{free_port()}",
                       ROS_LOG_DIR=os.path.abspath("log"))
        fails(self, ["no ROS master at http://127.0.0.1:"], nowhere)

    def test_bad_settings_are_errors_before_waiting(self):
        with Network(os.path.abspath("log")) as network:
            environment = network.environment
            fails(self, ["timeout after 1 s: no messages yet"], environment, "--patience", "1")
            fails(self, ["'amis'", "did you mean"], environment, "--estimator", "amis")
            fails(self, ["recording.topics.imoo"], environment, "--set",
                  "recording.topics.imoo=/imu")
            fails(self, ["_estimator:=lio", "see --help"], environment, "_estimator:=lio")


if __name__ == "__main__":
    AIMS, NODE = sys.argv[1:3]
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], warnings="ignore")
