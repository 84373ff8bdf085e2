# SPDX-License-Identifier: BSD-3-Clause
"""Writes folders as versions of ROS 2 from Dashing to Iron do, with Python's SQLite alone."""

import ctypes
import ctypes.util
import os
import shutil
import sqlite3

TOPICS = "id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, " \
         "serialization_format TEXT NOT NULL"
TABLES = {
    1: (TOPICS,),
    2: (TOPICS + ", offered_qos_profiles TEXT NOT NULL",),
    4: (TOPICS + ", offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL",
        "id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL, "
        "encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL"),
}


def zstd(data):
    """A frame that states its size."""
    library = ctypes.CDLL(ctypes.util.find_library("zstd") or "libzstd.so.1")
    library.ZSTD_compress.restype = ctypes.c_size_t
    library.ZSTD_compressBound.restype = ctypes.c_size_t
    library.ZSTD_compress.argtypes = [ctypes.c_char_p, ctypes.c_size_t] * 2 + [ctypes.c_int]
    output = ctypes.create_string_buffer(library.ZSTD_compressBound(ctypes.c_size_t(len(data))))
    size = library.ZSTD_compress(output, len(output), data, len(data), 1)
    return output.raw[:size]


def write_db3(path, topics, messages, version=4, numbers=None, pack=lambda data: data):
    """topics: [(name, type, quality of service, definition)]; messages: [(topic's place, time, data)]."""
    numbers = numbers or [place + 1 for place in range(len(topics))]
    database = sqlite3.connect(path)
    database.execute(f"CREATE TABLE topics({TABLES[version][0]})")
    database.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                     "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    if version == 4:
        database.execute(f"CREATE TABLE message_definitions({TABLES[4][1]})")
    for number, (name, kind, quality, definition) in zip(numbers, topics):
        values = [number, name, kind, "cdr", quality, ""][:{1: 4, 2: 5, 4: 6}[version]]
        database.execute(f"INSERT INTO topics VALUES ({', '.join('?' * len(values))})", values)
        if version == 4:
            language = "ros2idl" if "\nIDL: " in definition else "ros2msg"
            database.execute("INSERT INTO message_definitions VALUES (NULL, ?, ?, ?, '')",
                             (kind, language, definition))
    database.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                         [(numbers[place], time, pack(data)) for place, time, data in messages])
    database.commit()
    database.close()


def pack_file(path):
    with open(path, "rb") as stream:
        packed = zstd(stream.read())
    with open(path + ".zstd", "wb") as stream:
        stream.write(packed)
    os.remove(path)
    return path + ".zstd"


def write_metadata(folder, files, mode="", compression=""):
    lines = "".join(f"    - {os.path.relpath(file, folder)}\n" for file in files)
    with open(os.path.join(folder, "metadata.yaml"), "w", encoding="utf-8") as stream:
        stream.write(
            "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
            f"  relative_file_paths:\n{lines}  duration:\n    nanoseconds: 0\n"
            "  starting_time:\n    nanoseconds_since_epoch: 0\n  message_count: 0\n"
            "  topics_with_message_count: []\n"
            f"  compression_format: \"{compression}\"\n  compression_mode: \"{mode}\"\n")


def write_forms(folder, topics, messages, mcap):
    """Yields (form, path) of the same recording in every form."""
    half = len(messages) // 2
    backwards = [1000 - place for place in range(len(topics))]

    def path(form, name):
        os.makedirs(os.path.join(folder, form), exist_ok=True)
        return os.path.join(folder, form, name)

    write_db3(path("dashing", "r.db3"), topics, messages, version=1)
    yield "dashing", path("dashing", "r.db3")
    # Messages near the split are in both orders, and the topics have other numbers.
    parts = [path("split", "r_0.db3"), path("split", "r_1.db3")]
    write_db3(parts[0], topics, messages[:half] + messages[half + 2:half + 4], version=2)
    write_db3(parts[1], topics, messages[half:half + 2] + messages[half + 4:], 2, backwards)
    write_metadata(os.path.dirname(parts[0]), parts)
    yield "split", os.path.dirname(parts[0])
    packed = [path("files", "r_0.db3"), path("files", "r_1.db3")]
    write_db3(packed[0], topics, messages[:half])
    write_db3(packed[1], topics, messages[half:], 4, backwards)
    write_metadata(os.path.dirname(packed[0]), map(pack_file, packed), "FILE", "zstd")
    yield "files", os.path.dirname(packed[0])
    small = path("messages", "r_0.db3")
    write_db3(small, topics, messages, pack=zstd)
    write_metadata(os.path.dirname(small), [small], "MESSAGE", "zstd")
    yield "messages", os.path.dirname(small)
    shutil.copy(mcap, path("mcap", "r_0.mcap"))
    write_metadata(os.path.join(folder, "mcap"), [path("mcap", "r_0.mcap")])
    yield "mcap", os.path.join(folder, "mcap")
