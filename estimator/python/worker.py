# SPDX-License-Identifier: BSD-3-Clause
"""The Python side of an estimator written in Python: `aims` starts it as a process of its own.

It needs NumPy and nothing else, so that any interpreter serves. Messages go over a socket: kind and
length (two little-endian 64-bit numbers), then the content. Points, and which call runs, go through
memory that both processes map; estimator/python/python_process.hpp states the layout.
"""

import ast
import enum
import hashlib
import importlib
import inspect
import math
import mmap
import os
import signal
import socket
import struct
import sys
import sysconfig
import time
import traceback
import weakref

try:
    import numpy as np
except ImportError:
    sys.exit(126)  # kNoNumpy of python_process.cpp, which says so

VERSION = 3
HELLO, CREATE, MEASURE, FINISH = 1, 2, 3, 4
ERROR, DESCRIPTION, DONE, POSES = 0, 1, 2, 3
IMU, LEGS, SCAN = 1, 2, 3
METHODS = ("add_imu", "add_legs", "add_scan")
POINT = np.dtype(
    {
        "names": ["xyz", "intensity", "time_offset_ns", "ring"],
        "formats": [("<f4", (3,)), "<f4", "<i4", "<u2"],
        "offsets": [0, 12, 16, 20],
        "itemsize": 24,
    }
)


class Rig:
    """The sensors: T_body_lidar and T_body_base (4, 4), imu_rate and leg_rate [Hz]."""

    def __init__(self, cells):
        self.T_body_lidar = cells[:16].reshape(4, 4)
        self.T_body_base = cells[16:32].reshape(4, 4)
        self.imu_rate, self.leg_rate = float(cells[32]), float(cells[33])


def is_matrix(value):
    """Whether that is a pose, also as nested lists."""
    try:
        return np.shape(value) == (4, 4)
    except ValueError:  # of rows of different lengths
        return False


def poses_of(returned, stamp):
    """What a method returned as a list of (stamp [ns], T_odom_body (4, 4) float64)."""
    if returned is None:
        return []
    if isinstance(returned, list) and not is_matrix(returned):
        return [pose for each in returned for pose in poses_of(each, stamp)]
    if isinstance(returned, tuple):
        if len(returned) != 2 or not hasattr(returned[0], "__index__"):
            raise TypeError("expected (stamp [ns], pose), where a tuple is returned")
        stamp, returned = returned
    pose = np.asarray(returned, dtype=float)
    if pose.shape != (4, 4):
        raise TypeError(f"expected None or a pose of shape (4, 4), got shape {pose.shape}")
    return [(int(stamp), pose)]


def is_written(method):
    """Whether an estimator has that method, and not only the base class's."""
    return callable(method) and not getattr(method, "is_stub", False)


class Feeder:
    """Hands measurements to an estimator and collects its poses."""

    def __init__(self, estimator):
        self.estimator = estimator
        self.add_imu, self.add_legs, self.add_scan = (
            getattr(estimator, name, None) for name in METHODS
        )
        self.poses = []

    def keep(self, returned, stamp):
        if returned is not None:
            self.poses += poses_of(returned, stamp)

    def finish(self):
        if hasattr(self.estimator, "finish"):
            stamp = self.poses[-1][0] if self.poses else 0
            self.keep(self.estimator.finish(), stamp)


class Overdue(BaseException):
    """Raised in a call that has taken too long; no `except Exception` of the class catches it."""


class Call:
    """The call of the class that runs, in the first page of the shared memory.

    There the program reads which call is late. It then sends SIGUSR1, which ends the call where Python can.
    """

    LAYOUT = struct.Struct("<QQq16s")

    def __init__(self, file):
        self.page = mmap.mmap(file, mmap.PAGESIZE)
        self.count = 0
        self.method = "import"
        self.runs = False
        signal.signal(signal.SIGUSR1, self.interrupt)

    def begin(self, method, stamp=None):
        self.count += 1
        self.method = method
        self.LAYOUT.pack_into(self.page, 0, self.count, stamp is not None, stamp or 0, method.encode())
        self.runs = True

    def interrupt(self, signum, frame):
        if self.runs:
            self.runs = False
            raise Overdue("interrupted")


class Points:
    """The shared memory. A scan that somebody still refers to keeps its part of it."""

    def __init__(self, file):
        self.file = file
        self.maps = {}
        self.retained = {}

    def scan(self, count, offset, capacity):
        """(count,) of POINT; read-only."""
        if count == 0:
            return np.empty(0, POINT)
        if offset not in self.maps:
            self.maps[offset] = mmap.mmap(self.file, capacity, prot=mmap.PROT_READ, offset=offset)
        return np.frombuffer(self.maps[offset], POINT, count)

    def settle(self, points, offset):
        """Notes whether anything refers to the points besides the caller."""
        if len(points) and sys.getrefcount(points) > 3:  # its own argument, the caller's name
            self.retained[offset] = weakref.ref(points)

    def in_use(self):
        self.retained = {at: each for at, each in self.retained.items() if each() is not None}
        return list(self.retained)


class Texts:
    """Texts in a message: a length and UTF-8 each."""

    @staticmethod
    def pack(texts):
        coded = [str(text).encode("utf-8", "backslashreplace") for text in texts]
        return b"".join(struct.pack("<Q", len(each)) + each for each in coded)

    @staticmethod
    def unpack(data):
        texts, at = [], 0
        while at < len(data):
            (size,) = struct.unpack_from("<Q", data, at)
            texts.append(data[at + 8 : at + 8 + size].decode())
            at += 8 + size
        return texts


def value_of(text):
    """The value of a setting without a type: a Python literal, true, false, null, or the text itself."""
    named = {"true": True, "false": False, "null": None}
    if text in named:
        return named[text]
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError):
        return text


TYPES = {"bool": bool, "int": int, "float": float, "str": str}


def type_of(parameter):
    """The name of the type in TYPES that a keyword takes, by its default or annotation; else ""."""
    annotated = [name for name, kind in TYPES.items() if parameter.annotation in (name, kind)]
    default = parameter.default
    if default is parameter.empty:
        return annotated[0] if annotated and annotated != ["bool"] else ""
    found = next((name for name, kind in TYPES.items() if isinstance(default, kind)), "")
    if found == "int" and (isinstance(default, enum.Enum) or abs(default) >= 2**31):
        return ""
    if found == "int" and annotated == ["float"]:
        return "float"
    return "" if found == "float" and not math.isfinite(default) else found


def typed(text, name):
    """The value of that type."""
    if name == "bool":
        return text == "true"
    return TYPES[name](text) if name else value_of(text)


def text_of(value, name):
    """The text of which `typed` makes the value."""
    if name == "bool":
        return "true" if value else "false"
    return str(TYPES[name](value)) if name else repr(value)


def settings_of(kind):
    """[(keyword, type, default as text, "1" where there is one)] of the class, without the rig."""
    found = []
    for parameter in list(inspect.signature(kind).parameters.values())[1:]:
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            continue
        has_default = parameter.default is not parameter.empty
        name = type_of(parameter)
        text = text_of(parameter.default, name) if has_default else ""
        found.append((parameter.name, name, text, "1" if has_default else "0"))
    return found


def code_hash():
    """Of the files of all imported modules that are neither Python's nor installed packages."""
    installed = {os.path.realpath(path) for path in sysconfig.get_paths().values()}
    digest = hashlib.sha256(f"{sys.version_info[:3]} {np.__version__}".encode())
    for name, module in sorted(sys.modules.items()):
        file = getattr(module, "__file__", None)
        if not file or not os.path.isfile(file):
            continue
        folder = os.path.realpath(file)
        parts = folder.split(os.sep)
        if "site-packages" in parts or "dist-packages" in parts:
            continue
        if any(folder.startswith(path + os.sep) for path in installed):
            continue
        with open(file, "rb") as opened:
            digest.update(name.encode() + b"\0" + opened.read())
    return digest.hexdigest()[:16]


class Server:
    """Answers the messages of the program, one at a time."""

    def __init__(self, connection, memory):
        self.connection = connection
        self.points = Points(memory)
        self.call = Call(memory)
        self.feeder = None
        self.kind = None
        self.cpu = time.process_time_ns()

    def receive(self, size):
        data = bytearray(size)
        view = memoryview(data)
        while view:
            got = self.connection.recv_into(view)
            if got == 0:
                raise EOFError
            view = view[got:]
        return bytes(data)

    def reply(self, kind, content=b""):
        self.connection.sendall(struct.pack("<QQ", kind, len(content)) + content)

    def serve(self):
        """Until the program ends or a step fails."""
        answers = {HELLO: self.hello, CREATE: self.create, MEASURE: self.measure, FINISH: self.finish}
        while True:
            kind, size = struct.unpack("<QQ", self.receive(16))
            data = self.receive(size)
            try:
                try:
                    reply = answers[kind](data)
                finally:
                    self.call.runs = False
            except BaseException as error:  # whatever the estimator raises, SystemExit too
                reply = ERROR, self.failure(error)
            self.reply(*reply)

    def failure(self, error):
        """Step, error, traceback, and the poses of the calls before."""
        frames = traceback.TracebackException.from_exception(error)
        while frames.stack and frames.stack[0].filename == main.__code__.co_filename:
            del frames.stack[0]  # of this file
        lines = traceback.format_exception_only(type(error), error)
        if isinstance(error, SyntaxError):  # the lines before show the place, as the traceback does
            lines = lines[-1:] + [f"({error.filename}, line {error.lineno})"]
        summary = " ".join("".join(lines).split())
        trace = frames.format() if frames.stack else [summary]
        if isinstance(error, Overdue):  # where the call was, without what ended it
            trace = ["Traceback (most recent call last):\n", *frames.stack.format()[:-1]]
        texts = Texts.pack([self.call.method, summary, "".join(trace).rstrip()])
        return texts + (self.taken_poses() if self.feeder else b"")

    def hello(self, data):
        version, module, name = Texts.unpack(data)
        if int(version) != VERSION:
            raise RuntimeError(f"protocol {version}, expected {VERSION}")
        self.call.begin("import")
        self.kind = getattr(importlib.import_module(module), name)
        if not isinstance(self.kind, type):
            raise TypeError(f"{module}.{name} is no class")
        methods = [each for each in METHODS if is_written(getattr(self.kind, each, None))]
        if not methods:
            raise TypeError(f"{module}.{name} has none of the methods {', '.join(METHODS)}")
        texts = [code_hash(), ",".join(methods)]
        for setting in settings_of(self.kind):
            texts += setting
        return DESCRIPTION, Texts.pack(texts)

    def create(self, data):
        self.call.begin("constructor")
        rig = Rig(np.frombuffer(data, "<f8", 34))
        texts = Texts.unpack(data[34 * 8 :])
        types = {key: name for key, name, *_ in settings_of(self.kind)}
        settings = {key: typed(text, types[key]) for key, text in zip(texts[::2], texts[1::2])}
        self.feeder = Feeder(self.kind(rig, **settings))
        return DONE, b""

    def measure(self, data):
        samples, legs, scans, events = struct.unpack_from("<QQQQ", data)
        order = data[32 : 32 + events]
        at = 32 + (events + 7) // 8 * 8
        imu = self.imu_calls(data, at, samples)
        at += samples * 13 * 8
        leg = self.leg_calls(data, at, legs)
        at += legs * 57 * 8
        scan = iter(struct.iter_unpack("<qqqQQQ", data[at : at + scans * 48]))
        feeder, begin = self.feeder, self.call.begin
        for event in order:
            if event == IMU:
                values = next(imu)
                begin("add_imu", values[0])
                feeder.keep(feeder.add_imu(*values), values[0])
            elif event == LEGS:
                values = next(leg)
                begin("add_legs", values[0])
                feeder.keep(feeder.add_legs(*values), values[0])
            else:
                self.scan(*next(scan))
        return POSES, self.taken_poses()

    @staticmethod
    def imu_calls(data, at, count):
        """Arguments of add_imu, sample by sample; the arrays are read-only views of the message."""
        cells = np.frombuffer(data, "<f8", count * 13, at).reshape(count, 13)
        stamps = cells.view("<i8")[:, 1].tolist()
        turned = cells[:, 8].tolist()
        orientations = (q if has else None for q, has in zip(cells[:, 9:13], turned))
        return zip(stamps, cells[:, 5:8], cells[:, 2:5], orientations)

    @staticmethod
    def leg_calls(data, at, count):
        cells = np.frombuffer(data, "<f8", count * 57, at).reshape(count, 57)
        stamps = cells.view("<i8")[:, 1].tolist()
        poses = cells[:, 2:18].reshape(count, 4, 4)
        contacts = cells[:, 24:28] != 0.0
        return zip(stamps, poses, cells[:, 18:21], cells[:, 21:24], contacts, cells[:, 28:40],
                   cells[:, 40:52])

    def scan(self, arrival, stamp, end, count, offset, capacity):
        points = self.points.scan(count, offset, capacity)
        self.call.begin("add_scan", stamp)
        returned = self.feeder.add_scan(stamp, points["xyz"], points["time_offset_ns"],
                                        points["ring"], points["intensity"], end)
        self.feeder.keep(returned, end)
        del returned
        self.points.settle(points, offset)

    def taken_poses(self):
        poses, self.feeder.poses = self.feeder.poses, []
        in_use = self.points.in_use()
        now = time.process_time_ns()
        content = struct.pack("<QQQ", now - self.cpu, len(poses), len(in_use))
        self.cpu = now
        rows = [struct.pack("<q", stamp) + pose.tobytes() for stamp, pose in poses]
        return content + b"".join(rows) + struct.pack(f"<{len(in_use)}Q", *in_use)

    def finish(self, data):
        self.call.begin("finish")
        self.feeder.finish()
        points = np.empty((0, 3))
        if hasattr(self.feeder.estimator, "map_points"):
            self.call.begin("map_points")
            points = np.asarray(self.feeder.estimator.map_points(), "<f4")
            if points.ndim != 2 or points.shape[1] != 3:
                raise TypeError(f"expected points of shape (N, 3), got shape {points.shape}")
        content = np.ascontiguousarray(points, "<f4").tobytes()
        return POSES, self.taken_poses() + struct.pack("<Q", len(points)) + content


def main(connection, memory):
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the program decides what Ctrl-C ends
    try:
        Server(socket.socket(fileno=connection), memory).serve()
    except (EOFError, ConnectionError):
        pass  # the program has ended


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
