# SPDX-License-Identifier: BSD-3-Clause
"""States of Unitree's Go2 as CDR, from the definitions of unitree_ros2 and the OMG's rules."""

import struct

FEET = ("FR", "FL", "RR", "RL")

LOW_STATE = """uint8[2] head
uint8 level_flag
uint8 frame_reserve
uint32[2] sn
uint32[2] version
uint16 bandwidth
IMUState imu_state
MotorState[20] motor_state
BmsState bms_state
int16[4] foot_force
int16[4] foot_force_est
uint32 tick
uint8[40] wireless_remote
uint8 bit_flag
float32 adc_reel
int8 temperature_ntc1
int8 temperature_ntc2
float32 power_v
float32 power_a
uint16[4] fan_frequency
uint32 reserve
uint32 crc
================================================================================
MSG: unitree_go/IMUState
float32[4] quaternion
float32[3] gyroscope
float32[3] accelerometer
float32[3] rpy
int8 temperature
================================================================================
MSG: unitree_go/MotorState
uint8 mode
float32 q
float32 dq
float32 ddq
float32 tau_est
float32 q_raw
float32 dq_raw
float32 ddq_raw
int8 temperature
uint32 lost
uint32[2] reserve
================================================================================
MSG: unitree_go/BmsState
uint8 version_high
uint8 version_low
uint8 status
uint8 soc
int32 current
uint16 cycle
int8[2] bq_ntc
int8[2] mcu_ntc
uint16[15] cell_vol
"""


class CdrWriter:
    def __init__(self):
        self.data = bytearray(b"\x00\x01\x00\x00")

    def put(self, code, *values):
        size = struct.calcsize("<" + code)
        for value in values:
            self.data += bytes(-(len(self.data) - 4) % size)
            self.data += struct.pack("<" + code, value)
        return self


def put_imu(out, imu):
    """imu: (quaternion w x y z, gyroscope, accelerometer)."""
    for values in imu:
        out.put("f", *values)
    out.put("f", 0, 0, 0).put("b", 30)


def low_state(imu, angles, rates, forces):
    """angles, rates: of FR, FL, RR, RL; forces: raw counts in that order."""
    out = CdrWriter()
    out.put("B", 0xfe, 0xef, 0, 0).put("I", 1, 2, 3, 4).put("H", 5)
    put_imu(out, imu)
    for motor in range(20):
        q, dq = (angles[motor], rates[motor]) if motor < 12 else (9.0, 9.0)
        out.put("B", 1).put("f", q, dq, 0, 1.5, q, dq, 0).put("b", 40).put("I", 0, 0, 0)
    out.put("B", 1, 2, 3, 80).put("i", -1500).put("H", 7).put("b", 25, 25, 26, 26)
    out.put("H", *[3700] * 15)
    out.put("h", *forces).put("h", 0, 0, 0, 0).put("I", 12345).put("B", *range(40)).put("B", 0)
    out.put("f", 0.5).put("b", 20, 21).put("f", 28.5, 1.2).put("H", 0, 0, 0, 0).put("I", 0, 99)
    return bytes(out.data)


def sport_state(stamp, imu, positions, speeds, forces):
    """positions, speeds: twelve numbers each, of FR, FL, RR, RL in the body."""
    out = CdrWriter()
    out.put("i", stamp // 10**9).put("I", stamp % 10**9).put("I", 0)
    put_imu(out, imu)
    out.put("B", 3).put("f", 0).put("B", 1).put("f", 0.09, 1, 2, 0.3, 0.32, 0.5, 0, 0, 0.1)
    out.put("f", 0, 0, 0, 0).put("h", *forces).put("f", *positions).put("f", *speeds)
    return bytes(out.data)
