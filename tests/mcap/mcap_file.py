# SPDX-License-Identifier: BSD-3-Clause
"""Reads MCAP files from the specification alone (mcap.dev/spec), checking all that can be checked:
lengths, checksums, indexes, offsets, statistics. Independent of every MCAP library."""

import ctypes
import ctypes.util
import struct
import zlib
from collections import Counter, namedtuple

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
STATISTICS, SUMMARY_OFFSET, DATA_END = 0x0B, 0x0E, 0x0F

Schema = namedtuple("Schema", "id name encoding text")
Channel = namedtuple("Channel", "id schema topic encoding metadata")
Message = namedtuple("Message", "channel sequence log_time publish_time data")


class Cursor:
    """Takes numbers and strings from bytes, in order."""

    def __init__(self, data):
        self.data = data
        self.position = 0

    def number(self, code):
        size = struct.calcsize("<" + code)
        return struct.unpack("<" + code, self.take(size))[0]

    def take(self, size):
        assert self.position + size <= len(self.data), "record ends early"
        self.position += size
        return self.data[self.position - size:self.position]

    def text(self):
        return self.take(self.number("I")).decode()

    def pairs(self, key, value):
        """A map whose entries are preceded by their length in bytes."""
        end = self.number("I") + self.position
        entries = {}
        while self.position < end:
            name = key(self)
            entries[name] = value(self)
        assert self.position == end
        return entries

    def rest(self):
        return self.take(len(self.data) - self.position)

    def end(self):
        assert self.position == len(self.data), "record is too long"


def records_of(data, begin, end):
    """Yields (opcode, body, offset of the record, offset behind it)."""
    while begin < end:
        opcode, length = struct.unpack_from("<BQ", data, begin)
        body = begin + 9
        assert body + length <= end, "record reaches beyond its section"
        yield opcode, data[body:body + length], begin, body + length
        begin = body + length
    assert begin == end


def decompress(name, data, size):
    if name == "":
        assert len(data) == size
        return data
    assert name == "zstd", name
    zstd = ctypes.CDLL(ctypes.util.find_library("zstd") or "libzstd.so.1")
    zstd.ZSTD_decompress.restype = ctypes.c_size_t
    zstd.ZSTD_decompress.argtypes = [ctypes.c_char_p, ctypes.c_size_t] * 2
    output = ctypes.create_string_buffer(size)
    assert zstd.ZSTD_decompress(output, size, data, len(data)) == size
    return output.raw


class McapFile:
    """All of a file in memory: header, schemas, channels, messages in their order, statistics."""

    def __init__(self, path):
        with open(path, "rb") as stream:
            self.data = stream.read()
        self.schemas, self.channels, self.messages = {}, {}, []
        self.chunks, self.found_indexes = {}, {}
        assert self.data[:8] == MAGIC and self.data[-8:] == MAGIC
        summary = self._read_footer()
        self._read_data(summary)
        self._read_summary(summary)

    def _read_footer(self):
        begin = len(self.data) - 8 - 9 - 20
        opcode, length = struct.unpack_from("<BQ", self.data, begin)
        assert (opcode, length) == (FOOTER, 20)
        summary, offsets, checksum = struct.unpack_from("<QQI", self.data, begin + 9)
        # The summary's checksum covers it up to the footer's own checksum.
        assert zlib.crc32(self.data[summary:begin + 9 + 16]) == checksum
        self.summary_offsets, self.footer = offsets, begin
        return summary

    def _read_data(self, summary):
        chunk = None
        for opcode, body, begin, end in records_of(self.data, 8, summary):
            cursor = Cursor(body)
            if opcode == HEADER:
                assert begin == 8
                self.profile, self.library = cursor.text(), cursor.text()
            elif opcode == CHUNK:
                chunk = self._read_chunk(cursor, begin, end)
            elif opcode == MESSAGE_INDEX:
                self._read_message_index(cursor, chunk, begin)
            elif opcode == DATA_END:
                assert end == summary and cursor.number("I") == zlib.crc32(self.data[:begin])
            else:
                raise AssertionError(f"record {opcode} between chunks")
            cursor.end()

    def _read_chunk(self, cursor, begin, end):
        start, stop, size = (cursor.number("Q") for _ in range(3))
        checksum, compression = cursor.number("I"), cursor.text()
        stored = cursor.take(cursor.number("Q"))
        data = decompress(compression, stored, size)
        assert zlib.crc32(data) == checksum
        places = {}
        for opcode, body, at, _ in records_of(data, 0, len(data)):
            if opcode == MESSAGE:
                message = self._read_message(Cursor(body))
                places.setdefault(message.channel, []).append((message.log_time, at))
            else:
                self._read_definition(opcode, Cursor(body))
        times = [time for place in places.values() for time, _ in place]
        assert (start, stop) == (min(times), max(times))
        self.chunks[begin] = (start, stop, end - begin, compression, len(stored), size)
        self.found_indexes[begin] = {}
        self._places = places
        return begin

    def _read_definition(self, opcode, cursor):
        if opcode == SCHEMA:
            number = cursor.number("H")
            new = Schema(number, cursor.text(), cursor.text(), cursor.text())
            assert number != 0 and self.schemas.setdefault(number, new) == new
        else:
            assert opcode == CHANNEL
            number, schema = cursor.number("H"), cursor.number("H")
            topic, encoding = cursor.text(), cursor.text()
            metadata = cursor.pairs(Cursor.text, Cursor.text)
            new = Channel(number, schema, topic, encoding, metadata)
            assert schema in self.schemas and self.channels.setdefault(number, new) == new
        cursor.end()

    def _read_message(self, cursor):
        message = Message(cursor.number("H"), cursor.number("I"), cursor.number("Q"),
                          cursor.number("Q"), cursor.rest())
        assert message.channel in self.channels, "message before its channel"
        self.messages.append(message)
        return message

    def _read_message_index(self, cursor, chunk, begin):
        channel = cursor.number("H")
        entries = cursor.take(cursor.number("I"))
        assert list(struct.iter_unpack("<QQ", entries)) == self._places.pop(channel)
        self.found_indexes[chunk][channel] = begin

    def _read_summary(self, summary):
        groups, described = {}, {}
        for opcode, body, begin, end in records_of(self.data, summary, self.footer):
            if opcode != SUMMARY_OFFSET:
                start = groups.setdefault(opcode, [begin, end])[0]
                groups[opcode] = [start, end]
            self._read_summary_record(opcode, Cursor(body), described)
        assert {key: (a, b - a) for key, (a, b) in groups.items()} == described
        assert not self.chunks, "a chunk has no index"

    def _read_summary_record(self, opcode, cursor, described):
        if opcode in (SCHEMA, CHANNEL):
            self._read_definition(opcode, cursor)
        elif opcode == CHUNK_INDEX:
            start, stop, begin, length = (cursor.number("Q") for _ in range(4))
            indexes = cursor.pairs(lambda c: c.number("H"), lambda c: c.number("Q"))
            cursor.number("Q")  # bytes of all message indexes
            compression, stored, size = cursor.text(), cursor.number("Q"), cursor.number("Q")
            assert self.chunks.pop(begin) == (start, stop, length, compression, stored, size)
            assert indexes == self.found_indexes[begin]
        elif opcode == STATISTICS:
            self._check_statistics(cursor)
        else:
            assert opcode == SUMMARY_OFFSET, opcode
            group, begin, length = cursor.number("B"), cursor.number("Q"), cursor.number("Q")
            described[group] = (begin, length)
        cursor.end()

    def _check_statistics(self, cursor):
        messages, schemas, channels = cursor.number("Q"), cursor.number("H"), cursor.number("I")
        attachments, metadata, chunks = (cursor.number("I") for _ in range(3))
        start, stop = cursor.number("Q"), cursor.number("Q")
        counts = cursor.pairs(lambda c: c.number("H"), lambda c: c.number("Q"))
        times = [message.log_time for message in self.messages] or [0]
        assert messages == len(self.messages)
        assert (schemas, channels) == (len(self.schemas), len(self.channels))
        assert (attachments, metadata, chunks) == (0, 0, len(self.found_indexes))
        assert (start, stop) == (min(times), max(times))
        assert counts == Counter(message.channel for message in self.messages)
