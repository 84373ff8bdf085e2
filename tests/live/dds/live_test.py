# SPDX-License-Identifier: BSD-3-Clause
"""usage: live_test.py AIMS GARBAGE FASTDDS_PEER WORK_FOLDER.

CYCLONEDDS_URI keeps it on this machine. FASTDDS_PEER may be empty."""

import glob
import itertools
import json
import os
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
import unittest
import urllib.request
from concurrent.futures import ThreadPoolExecutor
from xml.etree import ElementTree

AIMS, GARBAGE, PEER = None, None, None
FOLDER = os.path.dirname(os.path.abspath(__file__))
SCENARIO = os.path.join(os.path.dirname(FOLDER), "walk.yaml")  # standing, then three metres
# Half a minute of walking, for what a loaded machine must do meanwhile.
LONG_WALK = ["--set", "scene.corridor.length=22", "--set",
             "route.points=[{name: a, x: 0.0, y: 0.0}, {name: b, x: 15.0, y: 0.0}]"]
TOPICS = ["--set", "recording.topics.lidar=/lidar/points"]
PATIENCE_S = 120  # with a loaded machine
domains = itertools.count(os.getpid())
rosbag_lock = threading.Lock()
of_this_test = threading.local()  # each has a thread of its own while it runs


def own_domain():
    """A domain of DDS that nobody uses on this machine: no other test, whose port it holds, and no other program, whose
    ports its participants would have (7400 and so on, by the standard). Below 100 are those of robots."""
    for number in itertools.islice(domains, 100):
        domain = 100 + number % 100
        first_port = 7400 + 250 * domain
        holder = socket.socket()  # TCP, which DDS does not use
        try:
            holder.bind(("127.0.0.1", first_port))
            for port in range(first_port + 10, first_port + 30):
                with socket.socket(type=socket.SOCK_DGRAM) as probe:
                    probe.bind(("127.0.0.1", port))
        except OSError:
            holder.close()
            continue
        of_this_test.domains.append(holder)
        return str(domain)
    raise AssertionError("no free domain of DDS")


def start(*command, **options):
    """A process that ends with its test, however that ends."""
    process = subprocess.Popen(["setpriv", "--pdeathsig", "KILL", *command], **options)
    of_this_test.processes.append(process)
    return process


def wait_for(what, condition, failed=str):
    """Raises, with what `failed` says, where it never becomes true."""
    end = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"no {what} in {PATIENCE_S} s\n{failed()}")
        time.sleep(0.05)


def content(path):
    with open(path, "rb") as file:
        return file.read()


def run(*command, codes=(0,)):
    code = subprocess.run(command, check=False, stdout=subprocess.DEVNULL).returncode
    if code not in codes:
        raise AssertionError(f"exit code {code}: {command}")


def places(poses):
    """Positions of a trajectory."""
    return [tuple(map(float, row.split()[1:4])) for row in poses.decode().splitlines()]


def distance(a, b):
    return sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5


def summary(folder):
    with open(os.path.join(folder, "estimate.json"), encoding="utf-8") as file:
        return json.load(file)


def info_of(recording):
    return subprocess.run([AIMS, "info", recording], capture_output=True, text=True, check=True).stdout


def counts(recording):
    """Messages by topic."""
    rows = map(str.split, info_of(recording).splitlines())
    return {row[0]: int(row[2]) for row in rows if row[2:] and row[0].startswith("/") and row[2].isdigit()}


def estimate(recording, folder, *options, codes=(0,)):
    """The bytes of the trajectory of `aims estimate`."""
    run(AIMS, "estimate", recording, "--out", folder, "--overwrite", "--quiet", "--no-pictures", "--no-page", *TOPICS,
        *options, codes=codes)
    return content(os.path.join(folder, "aims_d.tum"))


class Live:
    """`aims live` on a recording that `aims play` plays. Faster than at its own pace, messages arrive at their times of
    sending. No cloud is dropped that waited for less than 20 s."""

    def __init__(self, recording, name, live=(), play=(), pace=4, max_wait=20, play_domain=None, limit=(),
                 settle="2", wait="--wait"):
        for old in (name, name + ".mcap", *glob.glob(name + "-[0-9].mcap")):
            shutil.rmtree(old, ignore_errors=True)
            if os.path.exists(old):
                os.remove(old)
        self.name, self.domain = name, own_domain()
        with open(name + ".log", "w", encoding="utf-8") as log:
            self.live = start(*limit, AIMS, "live", "--domain", self.domain, "--out", name, "--record", name + ".mcap",
                              "--settle", settle, "--max_wait", str(max_wait), *TOPICS,
                              *(["--source_time"] if pace > 1 else []), *live, stdout=log, stderr=log)
        self.play_command = [AIMS, "play", recording, "--domain", play_domain or self.domain, "--rate", str(pace),
                             *play]
        self.start_play(wait)

    def start_play(self, *wait):
        self.play = start(*self.play_command, *wait, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def kill(self):
        for process in (self.play, self.live):
            if process.poll() is None:
                process.kill()

    def wait_for(self, what, condition):
        wait_for(what, condition, self.log)

    def wait_for_poses(self, count):
        """Until there are so many more; how long that took [s]."""
        begin, target = time.monotonic(), count + (len(places(self.poses())) if self.written() else 0)
        self.wait_for("poses", lambda: self.written() and len(places(self.poses())) >= target)
        return time.monotonic() - begin

    def wait_for_walk(self):
        """Until it has gone half a metre."""
        self.wait_for("walk", lambda: self.written() and distance(places(self.poses())[-1], (0, 0, 0)) > 0.5)

    def stop_play(self, ending=signal.SIGKILL):
        self.play.send_signal(ending)
        self.said = self.play.communicate(timeout=PATIENCE_S)[0]

    def states(self):
        return [line for line in self.log().splitlines() if line.startswith("health at")]

    def silent(self):
        """Whether it has ended, or read all that was sent and said so: with publishers, it may wait for more."""
        states = self.states()
        return self.live.poll() is not None or bool(states) and states[-1].endswith("no messages")

    def tell(self, command):
        run(AIMS, "live", "--domain", self.domain, "--tell", command)

    def wait_to_end(self):
        """For the player, then for silence."""
        if self.play.returncode is None:
            self.said = self.play.communicate(timeout=PATIENCE_S)[0]
        self.wait_for("silence", self.silent)

    def finish(self, ending=signal.SIGTERM):
        """Waits to the end; ends the estimate by that signal. Its exit code."""
        try:
            self.wait_to_end()
            self.live.send_signal(ending)
            return self.live.wait(PATIENCE_S)
        finally:
            self.kill()

    def written(self, part=""):
        file = os.path.join(self.name, part, "aims_d.tum")
        return os.path.getsize(file) if os.path.exists(file) else 0

    def poses(self, part=""):
        return content(os.path.join(self.name, part, "aims_d.tum"))

    def log(self):
        """What it said, without what CycloneDDS says of packets."""
        lines = content(self.name + ".log").decode().splitlines(keepends=True)
        return "".join(line for line in lines if "malformed packet" not in line)


def altered(name, change, recording="walk.bag"):
    """The recording with each message, and its record time, as `change` gives them, or without it (None); nothing is
    latched."""
    import rosbag

    # The types that rosbag makes of definitions are for one thread.
    with rosbag_lock, rosbag.Bag(recording) as source, rosbag.Bag(name, "w") as target:
        for topic, message, stamp in source.read_messages():
            changed = change(topic, message, stamp)
            if changed:
                target.write(topic, *changed)
    return name


class LiveEstimate(unittest.TestCase):
    @classmethod
    def prepare(cls):
        for recording, settings in (("walk.mcap", []), ("walk.bag", []), ("long.bag", LONG_WALK)):
            run(AIMS, "simulate", SCENARIO, *settings, "-o", recording, "--quiet", "--overwrite")
        cls.offline = estimate("walk.mcap", "offline")

    def assert_same_file(self, live, file):
        ours, theirs = (content(os.path.join(folder, file)) for folder in (live.name, live.name + "-again"))
        self.assertEqual(ours, theirs, file)

    def assert_same_health(self, live):
        ours, theirs = (content(os.path.join(folder, "aims_d.health.csv")).splitlines(keepends=True)
                        for folder in (live.name, live.name + "-again"))
        stamps = [float(row.split(b",")[0]) for row in ours[1:]]
        self.assertEqual(stamps, sorted(stamps))
        heard = [row for row in ours if b"no messages" not in row]
        self.assertEqual(heard, theirs)
        self.assertGreater(len(ours), len(heard), "the silence after the last message")

    def assert_same(self, live, *options):
        code = live.finish()
        log = live.log() + live.said
        self.assertEqual((code, live.play.returncode), (0, 0), log)
        self.assertNotIn("dropped", log)
        self.assertNotIn("warning", log)
        self.assertIn("no messages", live.states()[-1], "what was queued is no news behind the silence")
        recorded = estimate(live.name + ".mcap", live.name + "-again", *options)
        poses = live.poses().count(b"\n")
        print(f"{live.name}: {poses} poses; of the recording played {len(self.offline.splitlines())}")
        self.assertGreater(poses, 80)
        self.assertEqual(live.poses(), recorded, "the record of what was read gives the same bytes")
        self.assert_same_file(live, "aims_d.map.ply")
        ours, theirs = summary(live.name), summary(live.name + "-again")
        self.assertTrue(ours["complete"])
        for key in ("schema", "topics", "counts", "warnings"):
            expected = {k: v for k, v in theirs[key].items() if k != "truth"} if key == "topics" else theirs[key]
            self.assertEqual(ours[key], expected, key)
        for key in ("poses", "counts"):
            self.assertEqual(ours["estimators"]["aims_d"][key], theirs["estimators"]["aims_d"][key], key)
        # A record has the truth to its end, so that the estimate can be scored.
        self.assertEqual(theirs["topics"]["truth"], "/ground_truth/imu")
        recorded = counts(live.name + ".mcap")
        self.assertGreater(recorded["/ground_truth/imu"], 9 * recorded["/lidar/points"], "100 Hz and 10 Hz")
        self.assertNotIn("stamps are", info_of(live.name + ".mcap"))
        return live

    def test_live_poses_are_those_of_the_recording_byte_for_byte(self):
        live = self.assert_same(Live("walk.mcap", "source"))
        self.assertEqual(live.poses(), self.offline)
        # By time of arrival, its rows are stamped by the shift of clocks, of which the record shows more.
        self.assert_same_health(live)

    def test_legs_by_joints_give_the_same_bytes_and_health(self):
        joints = ["--set", "recording.topics.leg_odometry=none"]
        self.assert_same_health(self.assert_same(Live("walk.mcap", "joints", joints), *joints))

    def test_with_a_calibration_live_poses_are_those_of_the_recording_with_it(self):
        run(AIMS, "calibrate", "walk.mcap", "--topics", "lidar=/lidar/points", "--out", "robot.yaml", "--overwrite",
            "--quiet")
        with open("robot.yaml", encoding="utf-8") as file:
            text = file.read()
        with open("robot.yaml", "w", encoding="utf-8") as file:
            mount = text.index("name: lidar_mount")  # which so short a walk leaves out
            file.write(text[:mount] + text[mount:].replace("used: false", "used: true", 1)
                       .replace("values: [0, 0, 0]", "values: [0.004, 0, 0.004]", 1))
        calibration = ["--calibration", "robot.yaml"]
        live = Live("walk.mcap", "calibrated", calibration)
        self.assertEqual(live.finish(), 0, live.log())
        expected = estimate("walk.mcap", "calibrated-offline", *calibration)
        self.assertTrue(live.poses() == expected, live.log())
        self.assertTrue(live.poses() != self.offline, "it acts")
        wrong = subprocess.run([AIMS, "live", "--calibration", "walk.mcap"], capture_output=True, text=True,
                               check=False)
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("--calibration", wrong.stderr)

    def test_by_time_of_arrival_the_record_gives_the_same_bytes(self):
        self.assert_same(Live("walk.bag", "arrival", pace=1))

    def test_what_is_heard_while_it_waits_is_recorded_and_the_replay_begins_as_it_did(self):
        def without_legs(topic, message, stamp):
            legs = topic in ("/leg_odometry", "/joint_states", "/foot_contacts")
            return None if legs and stamp.to_sec() < 12.0 else (message, stamp)

        live = Live(altered("legs.bag", without_legs), "waited", pace=2)
        self.assertEqual(live.finish(), 0, live.log())
        again = estimate("waited.mcap", "waited-again")
        self.assertGreater(len(places(live.poses())), 20, live.log())
        self.assertLess(len(places(live.poses())), len(self.offline.splitlines()))
        self.assertEqual(live.poses(), again)
        self.assertIn("left out (as_live)", json.dumps(summary("waited-again")["notes"]))
        lines = info_of("waited.mcap")
        samples = next(int(row.split()[2]) for row in lines.splitlines() if row.startswith("/imu/data "))
        self.assertGreater(samples, 750, "of 800, and 10 s are 500")

    def test_a_recording_played_again_while_it_waits_is_read_from_its_start(self):
        def without_legs(topic, message, stamp):
            return None if topic in ("/leg_odometry", "/joint_states", "/foot_contacts") else (message, stamp)

        live = Live(altered("no_legs.bag", without_legs), "again", pace=2)
        live.said = live.play.communicate(timeout=PATIENCE_S)[0]
        live.wait_for("record of what it forgot", lambda: os.path.getsize("again.mcap") > 1_000_000)
        self.assertFalse(live.written(), live.log())
        live.play_command[2] = "walk.mcap"
        live.start_play("--wait")
        self.assertEqual(live.finish(), 0, live.log())
        self.assertEqual(len(places(live.poses())), len(self.offline.splitlines()), live.log())
        self.assertEqual(live.poses(), estimate("again.mcap", "again-again"))
        again = summary("again-again")
        self.assertEqual(summary("again")["counts"], again["counts"], "nothing of before lies between")
        self.assertNotIn("left out (as_live)", json.dumps(again["notes"]))

    def test_beside_another_estimate_the_times_are_those_of_the_recording(self):
        live = Live("walk.mcap", "beside", pace=3, wait="--wait=2")
        with open("other.log", "w", encoding="utf-8") as log:
            start(AIMS, "live", "--domain", live.domain, "--node", "other", "--tf", *TOPICS, stdout=log, stderr=log)
        self.assertEqual(live.finish(), 0, live.log())
        self.assertEqual(live.poses(), self.offline)
        lines = info_of("beside.mcap")
        self.assertLess(float(re.search(r"([0-9.]+) s, \d+ messages", lines)[1]), 20.0, lines)
        self.assertEqual([line for line in live.states() if line.endswith("no messages")], live.states()[-1:])

    def test_of_a_program_that_was_stopped_no_replay_says_that_a_clock_was_set(self):
        live = Live("long.bag", "paused", pace=1)
        live.wait_for_poses(10)
        live.live.send_signal(signal.SIGSTOP)
        time.sleep(6.5)  # before DDS takes it for killed
        live.live.send_signal(signal.SIGCONT)
        live.wait_for_poses(30)
        live.stop_play(signal.SIGTERM)
        self.assertEqual(live.finish(), 0, live.log())
        self.assertEqual(live.poses(), estimate("paused.mcap", "paused-again", codes=(0, 4)), "invalid for a while")
        found = summary("paused-again")
        self.assertGreater(found["counts"]["read_late_by_the_recorder"], 100)
        self.assertIn("the recorder was stopped or too slow", json.dumps(found["notes"]))
        self.assertNotIn("clock", json.dumps(found["warnings"]))
        again = Live("paused.mcap", "paused-live", pace=2)
        self.assertEqual(again.finish(), 0, again.log())
        self.assertNotIn("anew", again.log())
        self.assertNotIn("clock", again.log())

    def test_what_is_lost_while_it_is_stopped_is_counted(self):
        # After two seconds, not ten, DDS takes it for killed.
        lease = ("<CycloneDDS><Domain><Discovery><LeaseDuration>2 s</LeaseDuration></Discovery></Domain></CycloneDDS>")
        live = Live("long.bag", "stopped", pace=1,
                    limit=["env", f"CYCLONEDDS_URI={os.environ['CYCLONEDDS_URI']},{lease}"])
        live.wait_for_poses(10)
        live.live.send_signal(signal.SIGSTOP)
        time.sleep(4)
        live.live.send_signal(signal.SIGCONT)
        self.assertEqual(live.finish(), 0, live.log())
        sent, recorded = counts("long.bag"), counts("stopped.mcap")
        missing = sum(sent[topic] - recorded[topic] for topic in recorded if topic in sent)
        self.assertGreater(missing, 500)
        found = re.search(r"note: (\d+) messages lost by the network", live.log())
        self.assertEqual(int(found[1]) if found else 0, missing, live.log())

    def test_overloaded_it_drops_the_oldest_clouds_and_counts_them(self):
        live = Live("long.bag", "overload", ["--source_time"], pace=1, max_wait=0.05)
        live.wait_for_poses(10)
        for _ in range(6):
            live.live.send_signal(signal.SIGSTOP)  # as if another program took the processor
            time.sleep(0.5)  # of topics that wait, the order of arrival is lost: a second would be a jump of clocks
            live.live.send_signal(signal.SIGCONT)
            live.wait_for_poses(3)
        live.wait_for("cause", lambda: "too slow" in live.log())
        live.stop_play(signal.SIGTERM)
        self.assertEqual(live.finish(), 0, live.log())
        dropped = re.search(r"note: (\d+) messages dropped, since the node was too slow", live.log())
        self.assertIsNotNone(dropped, live.log())
        self.assertRegex(live.log(), r"health .*: degraded: the node is too slow: \d+ messages dropped")
        self.assertNotIn("no LiDAR scans", live.log(), "which is the effect")
        self.assertNotIn("messages are missing", live.log(), "nobody else lost them")
        self.assertLess(len(live.states()), 8, "the health does not flicker")
        print(f"overload: {dropped[1]} messages dropped")
        self.assertEqual(live.poses(), estimate("overload.mcap", "overload-again"), "without the dropped ones")

    def test_a_driver_that_restarts_with_another_clock_starts_an_estimate_where_the_last_one_ended(self):
        live = Live("long.bag", "restart", pace=1)
        live.wait_for_walk()
        live.stop_play()
        live.start_play()
        live.wait_for("second walk", lambda: live.written("part-2") and distance(
            places(live.poses("part-2"))[-1], places(live.poses("part-2"))[0]) > 1.0)
        live.stop_play(signal.SIGTERM)
        self.assertEqual(live.finish(), 0, live.log())
        self.assertRegex(live.log(), "anew at the last pose: the clocks of the sensors jumped: .*/imu/data by -")
        first, second = places(live.poses()), places(live.poses("part-2"))
        self.assertLess(distance(first[-1], second[0]), 0.2, "it goes on where it was")
        recorded = places(estimate("restart-2.mcap", "restart-again"))
        self.assertEqual(len(second), len(recorded))
        self.assertAlmostEqual(distance(second[0], second[-1]), distance(recorded[0], recorded[-1]), delta=0.01)
        self.assertGreater(distance(second[0], second[-1]), 1.0, "and walks")

    def test_a_topic_with_two_publishers_is_in_the_health_while_there_are_two(self):
        live = Live("long.bag", "twice", pace=1)
        live.wait_for_poses(10)
        first = live.play
        live.start_play()
        live.wait_for("second publisher", lambda: "/imu/data has 2 publishers" in live.log())
        live.wait_for_poses(20)
        first.terminate()
        live.stop_play(signal.SIGTERM)
        first.communicate(timeout=PATIENCE_S)
        self.assertEqual(live.finish(), 0, live.log())
        states = live.states()
        found = next(i for i, state in enumerate(states) if "2 publishers" in state)
        self.assertNotIn("healthy", " ".join(states[found:]), "it does not flicker")
        self.assertIn(b"/lidar/points has 2 publishers", content("twice/aims_d.health.csv"))
        estimate("twice.mcap", "twice-again", codes=(0, 4))
        warnings = "\n".join(summary("twice-again")["warnings"])
        self.assertIn("/imu/data has 2 publishers, as the live estimate says", warnings)
        self.assertNotIn("clock was set", warnings, "by the recorder")
        self.assertNotIn("are missing", warnings + live.log(), "whose stamps go back and forth")

    def test_fixed_transforms_that_are_sent_once_last_when_the_estimate_starts_anew(self):
        once = altered("once.bag", lambda topic, message, stamp: (message, stamp))
        live = Live(once, "statics", pace=1.5)
        live.wait_for_walk()
        live.stop_play()
        live.play_command += ["--topics", "/imu/data,/lidar/points,/joint_states,/foot_contacts,/leg_odometry"]
        live.start_play()
        live.wait_for("second estimate", lambda: live.written("part-2"))
        live.stop_play(signal.SIGTERM)
        self.assertEqual(live.finish(), 0, live.log())
        self.assertNotIn("NO TRANSFORM", live.log())
        self.assertNotIn(b"unknown", content("statics/part-2/aims_d.health.csv"))
        recorded = places(estimate("statics-2.mcap", "statics-again"))
        self.assertEqual(len(places(live.poses("part-2"))), len(recorded), "its record has them")
        self.assertNotIn("NO TRANSFORM", json.dumps(summary("statics-again")["warnings"]))

    def test_fixed_transforms_that_come_late_serve_the_next_estimate(self):
        bare = altered("bare.bag", lambda topic, message, stamp: None if topic == "/tf_static" else (message, stamp),
                       "long.bag")
        live = Live(bare, "late", pace=1)
        live.wait_for_poses(10)
        subprocess.run([AIMS, "play", "walk.bag", "--domain", live.domain, "--topics", "/tf_static", "--wait"],
                       check=True, stdout=subprocess.DEVNULL, timeout=PATIENCE_S)
        live.tell("calibrate")
        live.wait_for("second estimate", lambda: live.written("part-2"))
        live.stop_play(signal.SIGTERM)
        self.assertEqual(live.finish(), 0, live.log())
        self.assertIn(b"unknown", content("late/aims_d.health.csv"))
        self.assertNotIn(b"unknown", content("late/part-2/aims_d.health.csv"))

    def test_clouds_that_go_on_in_another_frame_are_in_the_health(self):
        def rename(topic, message, stamp):
            if topic == "/lidar/points" and stamp.to_sec() > 7.0:
                message.header.frame_id = "rear"
            return message, stamp

        live = Live(altered("rear.bag", rename), "rear")
        self.assertEqual(live.finish(), 0, live.log())
        self.assertRegex(live.log(), "warning: the clouds are in frame 'rear' after .* no transform between them")
        rows = content("rear/aims_d.health.csv").splitlines()
        told = [b"frame of the LiDAR changed" in row for row in rows if b"no messages" not in row]
        self.assertEqual(told, sorted(told), "from then on")
        self.assertTrue(told[-1] and not told[2], rows)
        estimate("rear.mcap", "rear-again")
        self.assertEqual(summary("rear")["warnings"], summary("rear-again")["warnings"])

    def test_joints_that_pause_and_a_lidar_that_stops_are_named_at_the_end(self):
        def paused(topic, message, stamp):
            seconds = stamp.to_sec()
            pauses = topic == "/joint_states" and seconds > 3.0 and seconds % 1.0 < 0.4
            return None if pauses or topic == "/lidar/points" and seconds > 5.0 else (message, stamp)

        live = Live(altered("pauses.bag", paused), "pauses")
        self.assertEqual(live.finish(), 0, live.log())
        estimate("pauses.mcap", "pauses-again", codes=(0, 4))
        warnings = "\n".join(summary("pauses-again")["warnings"])
        for said in (warnings, live.log()):
            self.assertRegex(said, r"/joint_states: \d+ of \d+ messages are missing")
            self.assertRegex(said, r"/lidar/points: the last message was recorded 1[01].\d s before the last one of ")
        self.assertEqual(summary("pauses")["warnings"], summary("pauses-again")["warnings"])
        last = content("pauses/aims_d.health.csv").splitlines()[-2]
        self.assertIn(b"messages of the joints are missing; messages of the lidar ended early", last)

    def test_a_killed_subscriber_does_not_keep_the_others_waiting(self):
        for pace in (1, 2):
            with self.subTest(pace=pace):
                self.kill_a_subscriber(pace)

    def kill_a_subscriber(self, pace):
        """DDS notices it after 10 s. In step with its subscribers, the player waits a second once."""
        live = Live("long.bag", f"other-{pace}", pace=pace)
        other = start(GARBAGE, live.domain, "listen", "/lidar/points", "sensor_msgs/PointCloud2",
                      stdout=subprocess.PIPE)
        other.stdout.readline()
        live.wait_for_poses(25)  # what was gathered is estimated
        usual = live.wait_for_poses(10)
        other.kill()
        took = live.wait_for_poses(10)
        print(f"{live.name}: a second of poses took {usual:.1f} s, {took:.1f} s after the kill")
        self.assertLess(took, usual + 7.0)
        live.stop_play(signal.SIGTERM)
        self.assertEqual(live.finish(), 0, live.log())
        self.assertNotIn("not sent", live.said)

    def test_times_of_sending_that_dds_cannot_hold_are_named(self):
        import genpy

        far = altered("far.bag", lambda topic, message, stamp: (message, genpy.Time(2**32 - 1000 + stamp.secs)))
        live = Live(far, "far", pace=0.01)
        live.wait_for("reason", lambda: "no messages yet, though there are publishers of " in live.log())
        live.stop_play(signal.SIGTERM)
        live.live.send_signal(signal.SIGTERM)
        self.assertEqual(live.live.wait(PATIENCE_S), 0, live.log())
        self.assertRegex(live.said,
                         r"messages were not sent: DDS holds times from 1970 to 2038, the first .* 4294966\d\d\d")

    def test_commands_save_the_map_and_start_anew(self):
        live = Live("long.bag", "commands", pace=1)
        live.wait_for("estimate", lambda: live.written() > 2000)
        live.live.send_signal(signal.SIGUSR1)
        map_file = os.path.join("commands", "aims_d.map.ply")
        live.wait_for("map by signal", lambda: os.path.exists(map_file))
        os.remove(map_file)
        live.tell("save_map")
        live.wait_for("map by topic", lambda: os.path.exists(map_file))
        live.tell("calibrate")
        live.wait_for("calibrated estimate", lambda: live.written("part-2"))
        live.wait_for("poses", lambda: len(places(live.poses("part-2"))) > 3)
        live.tell("reset")
        live.wait_for("third estimate", lambda: live.written("part-3"))
        live.stop_play(signal.SIGTERM)
        self.assertEqual(live.finish(signal.SIGHUP), 0, live.log())
        self.assertTrue(summary("commands/part-3")["complete"], "a lost terminal is an orderly end")
        self.assertIn("starting anew at the last pose: calibration, standing", live.log())
        self.assertIn("warning: started anew in motion", live.log())
        self.assertIn(b"started anew in motion", content("commands/part-2/aims_d.health.csv"))
        self.assertIn("starting anew: reset", live.log())
        first, second = places(live.poses()), places(live.poses("part-2"))
        self.assertLess(distance(first[-1], second[0]), 0.15, "it walks meanwhile")
        third = os.path.join("commands", "part-3", "aims_d.tum")
        self.assertLess(distance(places(content(third))[0], (0, 0, 0)), 0.15, "a reset starts at the origin")

    def test_the_page_shows_what_is_estimated(self):
        live = Live("walk.mcap", "watched", pace=2)
        watch = start(AIMS, "watch", "--domain", live.domain, "--port", "0", stdout=subprocess.PIPE, text=True)
        url = watch.stdout.readline().split()[-1]
        self.assertRegex(url, r"^http://127\.0\.0\.1:\d+/$")

        def state():
            with urllib.request.urlopen(url + "state.json", timeout=PATIENCE_S) as answer:
                return json.load(answer)

        def is_written(pose):  # soon after it is published
            return [round(each, 9) for each in pose[:2]] in [[round(each, 9) for each in place[:2]]
                                                             for place in places(live.poses())]

        live.wait_for("walk on the page", lambda: state()["pose"] and state()["pose"][0] > 0.5)
        live.wait_for("scan on the page", lambda: len(state()["scan"]) > 300)
        live.wait_for("health on the page", lambda: state()["health"])
        shown = state()
        live.wait_for("pose of the page", lambda: is_written(shown["pose"]))
        self.assertIn("scans per second", dict(shown["health"]["values"]))
        with urllib.request.urlopen(url, timeout=PATIENCE_S) as page:
            text = page.read().decode()
        self.assertIn("connect-src 'self'", text)
        live.stop_play(signal.SIGTERM)
        watch.send_signal(signal.SIGTERM)
        self.assertEqual(watch.wait(PATIENCE_S), 0)
        self.assertEqual(live.finish(), 0, live.log())

    def test_a_silent_client_does_not_block_the_page(self):
        watch = start(AIMS, "watch", "--domain", own_domain(), "--port", "0", stdout=subprocess.PIPE, text=True)
        url = watch.stdout.readline().split()[-1]
        port = int(url.rsplit(":", 1)[1].strip("/"))
        with socket.create_connection(("127.0.0.1", port)) as silent:
            silent.sendall(b"GET / HT")
            with urllib.request.urlopen(url + "state.json", timeout=PATIENCE_S) as answer:
                self.assertEqual(answer.status, 200)
            silent.settimeout(PATIENCE_S)
            self.assertEqual(silent.recv(1), b"", "it is closed after two seconds")
        watch.send_signal(signal.SIGTERM)
        self.assertEqual(watch.wait(PATIENCE_S), 0)

    def test_what_was_heard_is_recorded_though_it_never_starts(self):
        live = Live("walk.mcap", "unstarted", [part for topic in ("leg_odometry", "joint_states", "contacts")
                                               for part in ("--set", f"recording.topics.{topic}=none")])
        live.wait_for("reason", lambda: "(--set recording.topics.leg_odometry=/...)" in live.log())
        live.live.send_signal(signal.SIGTERM)
        self.assertEqual(live.live.wait(PATIENCE_S), 0, live.log())
        self.assertIn("ended before the estimate could start", live.log())
        live.kill()
        live.play.communicate()
        info = subprocess.run([AIMS, "info", "unstarted.mcap"], capture_output=True, text=True, check=False).stdout
        self.assertIn("/imu/data", info)
        self.assertIn("/lidar/points", info)

    def test_a_full_disk_is_a_warning_and_the_estimate_goes_on(self):
        live = Live("walk.mcap", "full", limit=["bash", "-c", 'ulimit -f 2000; exec "$@"', "bash"])
        self.assertEqual(live.finish(), 2, live.log())
        self.assertRegex(live.log(), "warning: .*full.mcap")
        self.assertGreater(len(places(live.poses())), 60, live.log())
        self.assertIn(b"the recording cannot be written", content("full/aims_d.health.csv"))

    def test_an_estimator_that_fails_ends_the_program(self):
        if subprocess.run(["/usr/bin/python3", "-c", "import numpy"], check=False, capture_output=True).returncode:
            self.skipTest("python3-numpy is not installed")
        with open("unlucky.py", "w", encoding="utf-8") as file:
            file.write("class Unlucky:\n def __init__(self, rig): pass\n"
                       " def add_scan(self, *scan): raise ValueError('out of luck')\n")
        live = Live("walk.mcap", "failed", ["--estimator", "mine=python:unlucky.Unlucky"],
                    limit=["env", "AIMS_PYTHON=/usr/bin/python3"])
        self.assertEqual(live.live.wait(PATIENCE_S), 2, live.log())
        live.kill()
        live.play.communicate()
        self.assertIn("aims_live: python:unlucky.Unlucky: add_scan: ValueError: out of luck", live.log())
        self.assertIn(b"invalid,the estimator has failed", content("failed/mine.health.csv"))

    def test_each_setting_of_the_unit_is_one_word(self):
        file = os.path.join(os.path.dirname(SCENARIO), "..", "..", "live", "aims-live.service")
        with open(file, encoding="utf-8") as unit:
            settings = [line.split("=", 1)[1] for line in unit if line.startswith("Environment=")]
        self.assertEqual([len(shlex.split(each)) for each in settings], [1, 1])
        self.assertEqual(ElementTree.fromstring(shlex.split(settings[1])[0].split("=", 1)[1]).tag, "CycloneDDS")

    def test_after_a_crash_the_files_can_be_used(self):
        live = Live("walk.mcap", "crash", pace=3)
        live.wait_for("walk", lambda: live.written() > 4000)
        live.live.kill()
        live.live.wait()
        live.stop_play()
        self.assertFalse(summary("crash")["complete"])
        self.assertGreaterEqual(len(places(live.poses())), summary("crash")["estimators"]["aims_d"]["poses"])
        run(AIMS, "info", "crash.mcap", "--recover")
        played = ["play", "crash.mcap", "--rate", "100", "--domain", live.domain]
        run(AIMS, *played, codes=(2,))
        run(AIMS, *played, "--recover")

    def test_a_broken_participant_is_counted_and_harms_nothing_else(self):
        live = Live("long.bag", "garbage", pace=1)
        live.wait_for("estimate", lambda: "publishes" in live.log())
        garbage = subprocess.run([GARBAGE, live.domain, "/imu/data", "sensor_msgs/Imu", "/lidar/points",
                                  "sensor_msgs/PointCloud2"], capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual((garbage.returncode, garbage.stdout), (0, "sent\n"))
        live.wait_for("poses", lambda: len(places(live.poses())) > 60)
        live.stop_play(signal.SIGTERM)
        self.assertEqual(live.finish(), 0, live.log()[-2000:])
        self.assertRegex(live.log(), "note: imu_malformed: [1-9]")
        self.assertRegex(live.log(), "note: lidar_malformed: [1-9]")


# Topic, type under DDS, durability of what the simulation records.
RELAYED = [("imu/data", "sensor_msgs::msg::dds_::Imu_", "volatile"),
           ("lidar/points", "sensor_msgs::msg::dds_::PointCloud2_", "volatile"),
           ("joint_states", "sensor_msgs::msg::dds_::JointState_", "volatile"),
           ("foot_contacts", "aims_msgs::msg::dds_::FootContacts_", "volatile"),
           ("leg_odometry", "nav_msgs::msg::dds_::Odometry_", "volatile"),
           ("tf_static", "tf2_msgs::msg::dds_::TFMessage_", "transient"),
           ("aims/scenario", "std_msgs::msg::dds_::String_", "transient")]


class FastDds(unittest.TestCase):
    """Between two domains, through another implementation: both directions, clouds in fragments."""

    def setUp(self):
        if not PEER:
            self.skipTest("libfastrtps-dev is not installed")

    def peer(self, *arguments, output=subprocess.PIPE):
        return start(PEER, *arguments, stdin=subprocess.PIPE, stdout=output, stderr=subprocess.DEVNULL, text=True)

    def test_clouds_and_all_else_pass_through_it_and_it_reads_the_odometry(self):
        played = own_domain()
        topics = ["/" + topic for topic, _, _ in RELAYED]
        live = Live("walk.mcap", "fastdds", play=["--topics", ",".join(topics)], pace=2, play_domain=played)
        with open("odometry.txt", "w", encoding="utf-8") as output:
            self.peer("odometry", live.domain, "rt/aims/odometry", output=output)

        def heard():
            return content("odometry.txt").decode().splitlines()

        def time_of(line):
            seconds, nanoseconds = line.split()[0].split(".")
            return int(seconds) * 10**9 + int(nanoseconds)

        def written():
            rows = map(str.split, live.poses().decode().splitlines())
            return {round(float(row[0]) * 1e9): row[1:] for row in rows}

        live.wait_for("reader of the odometry", lambda: heard() == ["matched"])
        relay = self.peer("relay", played, live.domain, *[f"{word}" if i else f"rt/{word}"
                                                          for each in RELAYED for i, word in enumerate(each)])
        live.said = live.play.communicate(timeout=PATIENCE_S)[0]
        live.wait_for("silence", lambda: live.states() and "no messages" in live.states()[-1])
        relay.communicate("", timeout=PATIENCE_S)
        live.wait_to_end()
        live.wait_for("last odometry", lambda: heard()[1:] and time_of(heard()[-1]) == max(written()))
        self.assertEqual(live.finish(), 0, live.log())
        self.assertNotIn("dropped", live.log())
        self.assertEqual(live.poses(), estimate("walk.mcap", "fastdds-offline"))
        lines = heard()[1:]
        poses = written()
        self.assertGreater(len(lines), 0.8 * len(poses))
        for line in lines:
            _, frame, child, *numbers = line.split()
            pose = poses[time_of(line)]
            self.assertEqual((frame, child), ("odom", "imu"))
            self.assertEqual([float(each) for each in numbers[:7]], [float(each) for each in pose])
            self.assertTrue(all(float(numbers[i]) > 0.0 for i in (7, 8, 10)), line)
        speeds = [float(line.split()[12]) for line in lines]
        self.assertGreater(max(speeds), 0.2, "m/s: it walks")
        self.assertLess(max(speeds), 2.0)

    def clouds_arrive(self, reliability):
        """Numbers of clouds that it sent, that were recorded and that were lost on the way."""
        name = "clouds-" + reliability
        for old in glob.glob(name + ".*"):
            os.remove(old)
        domain = own_domain()
        with open(name + ".log", "w", encoding="utf-8") as log:
            live = start(AIMS, "live", "--domain", domain, "--record", name + ".mcap", stdout=log, stderr=log)
        sender = self.peer("clouds", domain, "rt/lidar/points", "20", "131072", reliability)
        sent = sender.stdout.readline()
        time.sleep(2)  # all that was sent is taken
        live.send_signal(signal.SIGTERM)
        self.assertEqual(live.wait(PATIENCE_S), 0)
        said = content(name + ".log").decode()
        info = info_of(name + ".mcap")
        self.assertIn("cloud /lidar/points: 131072 points; 32 bytes a point", info, said)
        self.assertNotIn("are the cloud before them", info)
        lost = re.search(r"note: (\d+) messages lost by the network", said)
        arrived = counts(name + ".mcap")["/lidar/points"]
        print(f"{name}: {sent.strip()}, {arrived} arrived, {lost[1] if lost else 0} lost")
        return int(sent.split()[1]), arrived, int(lost[1]) if lost else 0

    def test_large_clouds_that_it_sends_arrive(self):
        self.assertEqual(self.clouds_arrive("reliable"), (25, 25, 0))

    def test_of_large_clouds_that_it_sends_as_best_effort_those_that_are_lost_are_counted(self):
        sent, arrived, lost = self.clouds_arrive("best_effort")
        self.assertEqual(sent, 25)
        self.assertGreater(arrived, 0)
        self.assertIn(arrived + lost, range(23, 26), "of the last ones nobody tells")


def tests_of(suite):
    for each in suite:
        yield from tests_of(each) if isinstance(each, unittest.TestSuite) else [each]


def passes(test):
    of_this_test.processes, of_this_test.domains = [], []
    result = test.run()
    for process in of_this_test.processes:
        process.kill()
        process.wait()
    begin = "ok" if result.wasSuccessful() else "FAILED"
    print(f"{begin}: {test.id()} {result.skipped}", *[text for _, text in result.failures + result.errors], sep="\n",
          flush=True)
    return result.wasSuccessful()


def main(names):
    """Two at a time: a test waits most of its time, for a robot that walks."""
    LiveEstimate.prepare()
    loader, module = unittest.defaultTestLoader, sys.modules["__main__"]
    suite = loader.loadTestsFromNames(names, module) if names else loader.loadTestsFromModule(module)
    with ThreadPoolExecutor(2) as pool:
        return 0 if all(list(pool.map(passes, tests_of(suite)))) else 1


if __name__ == "__main__":
    AIMS, GARBAGE, PEER, work = sys.argv[1:5]
    os.makedirs(work, exist_ok=True)
    os.chdir(work)
    sys.exit(main(sys.argv[5:]))
