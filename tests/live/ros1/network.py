# SPDX-License-Identifier: BSD-3-Clause
"""A ROS 1 network on this machine alone, on free ports, for one test."""

import os
import signal
import socket
import subprocess
import time
import xmlrpc.client


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


PATIENCE_S = 120  # with a loaded machine


def wait_until(condition, what):
    end = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < end, f"waited {PATIENCE_S} s in vain: {what}"
        time.sleep(0.05)


class Network:
    """A master, and processes that end with it."""

    def __init__(self, log_folder):
        self.uri = f"http://127.0.0.1:{free_port()}"
        self.environment = dict(os.environ, ROS_MASTER_URI=self.uri, ROS_IP="127.0.0.1",
                                ROS_LOG_DIR=log_folder, ROS_HOME=log_folder)
        self.environment.pop("ROS_HOSTNAME", None)
        self.processes = []

    def __enter__(self):
        self.start(["rosmaster", "--core", "-p", self.uri.rsplit(":", 1)[1]],
                   stdout=subprocess.DEVNULL)
        wait_until(self.answers, "the master")
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                try:
                    process.wait(PATIENCE_S)
                except subprocess.TimeoutExpired:
                    process.kill()
            process.wait()

    def start(self, command, **options):
        process = subprocess.Popen(command, env=self.environment, text=True, **options)
        self.processes.append(process)
        return process

    def ask(self, method, *arguments):
        """What the master answers to a call of its API, as a node named /test."""
        with xmlrpc.client.ServerProxy(self.uri) as master:
            code, message, value = getattr(master, method)("/test", *arguments)
        assert code == 1, message
        return value

    def answers(self):
        try:
            self.ask("getPid")
            return True
        except OSError:
            return False

    def publishers(self, topic):
        return dict(self.ask("getSystemState")[0]).get(topic, [])

    def subscribers(self, topic):
        return dict(self.ask("getSystemState")[1]).get(topic, [])
