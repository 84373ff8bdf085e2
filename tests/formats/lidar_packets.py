# SPDX-License-Identifier: BSD-3-Clause
"""Captures of a LiDAR at the centre of a room, from the packet formats in the manuals of Velodyne
(VLP-16, 63-9243) and Ouster (sensor documentation)."""

import json
import math
import struct

ROOM = (4.0, 3.0, 1.5)  # half lengths [m]
VLP16_ELEVATIONS = [-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15]
VLP16_HEIGHTS_MM = [11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1, 5.1, -6.6, 3.7, -8.1, 2.2, -9.7, 0.7,
                    -11.2]


def range_in_room(origin, direction):
    return min((math.copysign(half, d) - o) / d
               for half, o, d in zip(ROOM, origin, direction) if abs(d) > 1e-9)


def ethernet_frames(payload, identification, mtu=1500, vlan=False):
    """The frames of one datagram, in fragments where it is longer than the MTU."""
    udp = struct.pack(">HHHH", 2368, 2368, 8 + len(payload), 0) + payload
    step = (mtu - 20) // 8 * 8
    for at in range(0, len(udp), step):
        part = udp[at:at + step]
        more = 0x2000 if at + step < len(udp) else 0
        ip = struct.pack(">BBHHHBBH4s4s", 0x45, 0, 20 + len(part), identification, more | at // 8, 64,
                         17, 0, bytes([192, 168, 1, 201]), bytes([255] * 4))
        tag = struct.pack(">HH", 0x8100, 7) if vlan else b""
        yield bytes(12) + tag + struct.pack(">H", 0x0800) + ip + part


def capture(packets, order="<", nanoseconds=False, vlan=False):
    """packets: [(time in ns, payload)]; among them a frame that is no datagram."""
    magic = 0xa1b23c4d if nanoseconds else 0xa1b2c3d4
    data = struct.pack(order + "IHHiIII", magic, 2, 4, 0, 0, 1 << 18, 1)
    arp = bytes(12) + b"\x08\x06" + bytes(28)
    for number, (time, payload) in enumerate(packets):
        frames = list(ethernet_frames(payload, number & 0xffff, vlan=vlan))
        for frame in ([arp] if number % 50 == 0 else []) + frames:
            fraction = time % 10**9 // (1 if nanoseconds else 1000)
            data += struct.pack(order + "IIII", time // 10**9, fraction, len(frame), len(frame))
            data += frame
    return data


def vlp16_packets(start, turns, dual=False, model=0x22):
    """Packets of a sensor at 10 Hz whose clock is that of the capture; and the directions fired."""
    hour = 3600 * 10**9
    time, azimuth, packets = start, 21000, []
    per_block = 2 * 55.296
    step = 36000 * per_block * 1e-6 / 0.1
    end = start + turns * 10**8
    exact, clock = float(azimuth), float(start)
    while clock < end:
        time = int(clock / 1000) * 1000
        payload = b""
        for block in range(6 if dual else 12):
            turn = exact + block * step
            body = struct.pack("<HH", 0xeeff, int(turn) % 36000)
            for firing in range(32):
                laser, after = firing % 16, firing // 16 * 55.296 + firing % 16 * 2.304
                angle = math.radians((turn + step * after / per_block) / 100)
                elevation = math.radians(VLP16_ELEVATIONS[laser])
                direction = (math.cos(elevation) * math.cos(angle),
                             -math.cos(elevation) * math.sin(angle), math.sin(elevation))
                distance = range_in_room((0, 0, 1e-3 * VLP16_HEIGHTS_MM[laser]), direction)
                body += struct.pack("<HB", round(distance / 0.002), 100 + laser)
            payload += body + (body[:4] + struct.pack("<HB", 300, 1) * 32 if dual else b"")
        payload += struct.pack("<IBB", time % hour // 1000, 0x39 if dual else 0x37, model)
        packets.append((time + 200_000, payload))
        blocks = 6 if dual else 12
        exact = (exact + blocks * step) % 36000
        clock += blocks * per_block * 1000
    return packets


def ouster_metadata(profile, beams, columns=512):
    altitude = [20 - 40 * i / (beams - 1) for i in range(beams)]
    azimuth = [(-1) ** i * 2.1 for i in range(beams)]
    matrix = lambda x, z, s: [s, 0, 0, x, 0, s, 0, 0, 0, 0, 1, z, 0, 0, 0, 1]
    return {"beam_intrinsics": {"beam_altitude_angles": altitude, "beam_azimuth_angles": azimuth,
                                "lidar_origin_to_beam_origin_mm": 15.806},
            "config_params": {"lidar_mode": f"{columns}x10", "udp_profile_lidar": profile},
            "lidar_data_format": {"columns_per_frame": columns, "columns_per_packet": 16,
                                  "pixels_per_column": beams},
            "lidar_intrinsics": {"lidar_to_sensor_transform": matrix(0, 36.18, -1)},
            "imu_intrinsics": {"imu_to_sensor_transform": matrix(6.253, 7.645, 1)}}


def ouster_pixel(profile, distance_mm):
    if profile == "LEGACY":
        return struct.pack("<IHHHH", distance_mm, 77, 500, 3, 0)
    if profile == "RNG15_RFL8_NIR8":
        return struct.pack("<HBB", distance_mm // 8, 77, 4)
    if profile == "RNG19_RFL8_SIG16_NIR16_DUAL":  # behind a weaker return, at half the way
        word = lambda distance, reflectivity: distance | 0xf80000 | reflectivity << 24
        signal = 500 if distance_mm else 0
        return struct.pack("<IIHHHH", word(distance_mm // 2, 9), word(distance_mm, 77), signal // 2,
                           signal, 3, 0)
    return struct.pack("<IBBHHH", distance_mm | 0xf80000, 77, 0, 500, 3, 0)


def ouster_packets(metadata, capture_start, sensor_start, frames):
    """Packets at 10 Hz, with one of the IMU in each tenth of a turn; some columns are missing."""
    beams = metadata["beam_intrinsics"]
    columns = metadata["lidar_data_format"]["columns_per_frame"]
    profile = metadata["config_params"]["udp_profile_lidar"]
    origin = beams["lidar_origin_to_beam_origin_mm"] / 1000
    packets = []
    for frame in range(frames):
        for first in range(0, columns, 16):
            payload = b"" if profile == "LEGACY" else struct.pack("<HH", 1, 65530 + frame & 0xffff) + bytes(28)
            for column in range(first, first + 16):
                stamp = sensor_start + frame * 10**8 + column * 10**8 // columns
                encoder = 2 * math.pi * (1 - column / columns)
                valid = column % 97 != 5
                pixels = b""
                for altitude, azimuth in zip(beams["beam_altitude_angles"],
                                             beams["beam_azimuth_angles"]):
                    angle, up = encoder - math.radians(azimuth), math.radians(altitude)
                    start = (origin * math.cos(encoder), origin * math.sin(encoder), 0)
                    direction = (math.cos(up) * math.cos(angle), math.cos(up) * math.sin(angle),
                                 math.sin(up))
                    distance = range_in_room(start, direction) + origin
                    pixels += ouster_pixel(profile, round(1000 * distance) if valid else 0)
                if profile == "LEGACY":
                    payload += struct.pack("<QHHI", stamp, column, 65530 + frame & 0xffff, 0)
                    payload += pixels + struct.pack("<I", 0xffffffff if valid else 0)
                else:
                    payload += struct.pack("<QHH", stamp, column, int(valid)) + pixels
            if profile != "LEGACY":
                payload += bytes(32)
            after = frame * 10**8 + (first + 16) * 10**8 // columns
            packets.append((capture_start + after, payload))
            if first // 16 % 3 == 0:
                stamp = sensor_start + after
                imu = struct.pack("<QQQ6f", stamp - 9, stamp - 5, stamp, 0, 0.6, 0.8, 10, -20, 30)
                packets.append((capture_start + after, imu))
    return packets


def write_ouster(path, profile, beams=16, frames=4, **options):
    metadata = ouster_metadata(profile, beams)
    with open(path.replace(".pcap", ".json"), "w", encoding="utf-8") as stream:
        json.dump(metadata, stream)
    with open(path, "wb") as stream:
        stream.write(capture(ouster_packets(metadata, 1_700_000_000 * 10**9, 55 * 10**9, frames),
                             **options))
    return metadata
