# SPDX-License-Identifier: BSD-3-Clause
"""The live node while busy loops take the machine's cores: pose latency, messages dropped.

usage: overload.py AIMS AIMS_NODE BAG [LOOPS_PER_CORE]     in an empty folder; needs ROS 1 and rosbag
"""

import os
import pathlib
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "live" / "ros1"))
from network import Network, wait_until  # noqa: E402


def percentile(values, part):
    return sorted(values)[min(len(values) - 1, int(part * len(values)))]


def latencies(network):
    """Arrivals of odometry, as (wall time, stamp)."""
    for name in ("ROS_MASTER_URI", "ROS_IP", "ROS_LOG_DIR"):
        os.environ[name] = network.environment[name]
    import rospy
    from nav_msgs.msg import Odometry
    rospy.init_node("listener", disable_signals=True)
    arrivals = []
    rospy.Subscriber("/aims_node/odometry", Odometry,
                     lambda m: arrivals.append((time.monotonic(), m.header.stamp.to_sec())))
    return arrivals


def main():
    _, node_program, bag = (os.path.abspath(each) for each in sys.argv[1:4])
    loops = int(sys.argv[4]) if len(sys.argv) > 4 else 4
    with Network(os.path.abspath("log")) as network:
        arrivals = latencies(network)
        with open("node.log", "w", encoding="utf-8") as log:
            node = network.start([node_program, "--settle", "2", "--set", "recording.topics.lidar=/lidar/points"],
                                 stdout=log, stderr=log)
            busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"])
                    for _ in range(loops * os.cpu_count())]
            play = network.start(["/usr/lib/rosbag/play", "--quiet", "--delay=2", bag],
                                 stdout=subprocess.DEVNULL)
            wait_until(lambda: network.subscribers("/lidar/points"), "the node to subscribe")
            play.wait()
            time.sleep(5)
            for each in busy:
                each.kill()
            node.send_signal(signal.SIGINT)
            node.wait(30)
    # Latency up to a constant: the player started at an unknown instant.
    offsets = [arrival - stamp for arrival, stamp in arrivals]
    least = min(offsets)
    waits = [each - least for each in offsets]
    half = len(waits) // 2
    print(f"{loops} busy loops a core: {len(waits)} poses; behind the quickest: median "
          f"{1e3 * percentile(waits, 0.5):.0f} ms, 99 % {1e3 * percentile(waits, 0.99):.0f} ms; "
          f"medians of the halves {1e3 * percentile(waits[:half], 0.5):.0f} and "
          f"{1e3 * percentile(waits[half:], 0.5):.0f} ms")
    with open("node.log", encoding="utf-8") as log:
        print("".join(line for line in log if "dropped" in line or "poses" in line), end="")


if __name__ == "__main__":
    main()
