# SPDX-License-Identifier: BSD-3-Clause
"""Definitions in OMG IDL as ROS 2's rosidl makes them of .msg files, joined as rosbag2 joins them."""

import re

SEPARATOR = "=" * 80 + "\n"
NAMES = {"bool": "boolean", "byte": "octet", "char": "uint8", "float32": "float", "float64": "double"}


def full_name(kind, user):
    """"std_msgs::msg::Header" of "std_msgs/Header", "std_msgs/msg/Header" or a name in its package."""
    parts = [part for part in kind.split("/") if part != "msg"]
    package = parts[0] if len(parts) > 1 else user.split("/")[0]
    return f"{package}::msg::{parts[-1]}"


def file_of(name, fields):
    """fields: lines of a .msg. The file NAME.idl, with a typedef for each array of fixed length."""
    package, _, own = name.split("/")
    includes, aliases, constants, members = set(), [], [], []
    for line in fields:
        constant = re.fullmatch(r"(\S+) ([A-Z][A-Z0-9_]*)=(.*)", line)
        if constant:
            kind, key, value = constant.groups()
            value = {"true": "TRUE", "false": "FALSE"}.get(value, value)
            constants.append(f"      const {NAMES.get(kind, kind)} {key} = {value};\n")
            continue
        kind, brackets, count, field = re.fullmatch(r"([\w/]+)(\[(\d*)\])? (\w+)", line).groups()
        basic = kind in NAMES or kind == "string" or re.fullmatch(r"u?int\d+", kind)
        used = NAMES.get(kind, kind) if basic else full_name(kind, name)
        if not basic:
            includes.add(f'#include "{used.replace("::", "/")}.idl"\n')
        if count:
            single = used.replace("::", "__")
            if single != used:
                aliases.append(f"    typedef {used} {single};\n")
            aliases.append(f"    typedef {single} {single}__{count}[{count}];\n")
            used = f"{single}__{count}"
        elif brackets:
            used = f"sequence<{used}>"
        members.append(f'      @verbatim (language="comment", text=\n        "{field}," "\\n" "of {kind}")\n'
                       f"      {used} {field};\n")
    module = "".join(f"    module {own}_Constants {{\n{''.join(constants)}    }};\n" for _ in constants[:1])
    return (f"// generated from rosidl_adapter/resource/msg.idl.em\n\n{''.join(sorted(includes))}\n"
            f"module {package} {{\n  module msg {{\n{''.join(dict.fromkeys(aliases))}{module}"
            f"    struct {own} {{\n{''.join(members) or '      uint8 structure_needs_at_least_one_member;'}"
            "    };\n  };\n};\n")


def idl_of(name, text):
    """The IDL of a type, "package/msg/Type", whose .msg definitions are `text`."""
    files = []
    for section in re.split(r"^={80}\n", text, flags=re.M):
        lines = section.splitlines()
        title = name
        if files:
            title = full_name(lines.pop(0).removeprefix("MSG: "), name).replace("::", "/")
        lines = [line for line in lines if line and line[0] != "#"]
        files.append(SEPARATOR + f"IDL: {title}\n" + file_of(title, lines))
    return "".join(files)
