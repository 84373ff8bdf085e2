# SPDX-License-Identifier: BSD-3-Clause
"""Decodes CDR messages by the ROS 2 definitions that an MCAP schema holds, from the OMG's rules:
each number is aligned to its own size, counted from behind the four bytes of the header."""

import re
import struct

CODES = {"bool": "B", "byte": "B", "char": "B", "int8": "b", "uint8": "B", "int16": "h",
         "uint16": "H", "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q",
         "float32": "f", "float64": "d"}


def parse_schema(name, text):
    """{type: [(field type, number of entries or None or "", field name)]}, and its constants."""
    types, constants = {}, {}
    for section in re.split(r"^={80}\n", text, flags=re.M):
        title, body = name, section
        if types:
            first, body = section.split("\n", 1)
            title = "/msg/".join(re.fullmatch(r"MSG: (\w+)/(\w+)", first).groups())
        fields = types[title] = []
        for line in body.splitlines():
            constant = re.fullmatch(r"(\w+) ([A-Z][A-Z0-9_]*)=(.*)", line)
            if constant:
                constants[title, constant.group(2)] = constant.groups()[::2]
                continue
            kind, brackets, field = re.fullmatch(
                r"([\w/]+?)(?:\[(\d*)\])? ([a-z][a-z0-9_]*)", line).groups()
            fields.append((kind.replace("/", "/msg/"), brackets, field))
    return types, constants


class CdrReader:
    def __init__(self, types, data):
        assert data[:4] == b"\x00\x01\x00\x00", "plain CDR, little endian"
        self.types, self.data, self.position = types, data, 4

    def decode(self, name):
        value = self.struct(name)
        assert self.position == len(self.data), "bytes left over"
        return value

    def struct(self, name):
        fields = self.types[name]
        if not fields:
            assert self.number("uint8") == 0  # the byte of an empty structure
        return {field: self.field(kind, brackets) for kind, brackets, field in fields}

    def field(self, kind, brackets):
        if brackets is None:
            return self.one(kind)
        count = int(brackets) if brackets else self.number("uint32")
        if kind == "uint8":
            self.position += count
            assert self.position <= len(self.data)
            return self.data[self.position - count:self.position]
        return [self.one(kind) for _ in range(count)]

    def one(self, kind):
        if kind == "string":
            size = self.number("uint32")
            text = self.data[self.position:self.position + size]
            assert len(text) == size and text[-1] == 0 and 0 not in text[:-1]
            self.position += size
            return text[:-1]
        return self.number(kind) if kind in CODES else self.struct(kind)

    def number(self, kind):
        code = "<" + CODES[kind]
        size = struct.calcsize(code)
        padding = -(self.position - 4) % size
        assert not any(self.data[self.position:self.position + padding])
        self.position += padding + size
        return struct.unpack_from(code, self.data, self.position - size)[0]
