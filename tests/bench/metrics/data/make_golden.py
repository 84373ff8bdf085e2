#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the golden files of the evaluation's tests: python3 make_golden.py, in this folder.

Writes truth.tum, estimate.tum (a noisy, drifting copy in another frame at another rate),
straight_truth.tum, straight_estimate.tum (a tilted estimate of a walk that sways by millimetres) and
golden.txt, one "name value" per line. The metrics follow the definitions of evo 1.x:
  association   each stamp of the shorter trajectory takes the nearest of the longer, within 10 ms
  APE           translation part, RMSE, unaligned / align_origin / Umeyama SE(3) without scale
  RPE           E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), delta in metres of path, consecutive pairs or all
                pairs (relative tolerance 0.1), pairs from the estimate or from the reference
Everything is plain Python on rotation matrices and shares no algorithm with the C++ side: the
alignment is Horn's quaternion method by power iteration instead of an SVD, searches are linear.
That of the straight walk squares Horn's matrix in 60 decimal digits, where doubles would lose the
small gap of its eigenvalues.
"""
import decimal
import math
import random


def matrix(q):
    x, y, z, w = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]


def quaternion(yaw, pitch, roll):
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    return (sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy)


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def apply(r, p):
    return [sum(r[i][k] * p[k] for k in range(3)) for i in range(3)]


def transposed(r):
    return [list(row) for row in zip(*r)]


def plus(a, b):
    return [x + y for x, y in zip(a, b)]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def norm(a):
    return math.sqrt(sum(x * x for x in a))


def relative(a, b):
    """a^-1 b of poses (rotation matrix, position)."""
    inverse = transposed(a[0])
    return times(inverse, b[0]), apply(inverse, minus(b[1], a[1]))


def angle(r):
    # From the sine as well as the cosine, to keep digits near zero.
    sine = norm([r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]]) / 2
    return math.atan2(sine, (r[0][0] + r[1][1] + r[2][2] - 1) / 2)


def rmse(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def horn_matrix(estimate, truth):
    """Both means and Horn's symmetric matrix; its main eigenvector is the quaternion w x y z."""
    count = len(truth)
    me = [sum(p[i] for p in estimate) / count for i in range(3)]
    mt = [sum(p[i] for p in truth) / count for i in range(3)]
    s = [[sum((e[i] - me[i]) * (t[j] - mt[j]) for e, t in zip(estimate, truth)) / count
          for j in range(3)] for i in range(3)]
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = s
    n = [[xx + yy + zz, yz - zy, zx - xz, xy - yx],
         [yz - zy, xx - yy - zz, xy + yx, zx + xz],
         [zx - xz, xy + yx, -xx + yy - zz, yz + zy],
         [xy - yx, zx + xz, yz + zy, -xx - yy + zz]]
    return me, mt, n


def horn(estimate, truth):
    """Rotation and translation that lay positions `estimate` onto `truth`."""
    me, mt, n = horn_matrix(estimate, truth)
    shift = sum(abs(v) for row in n for v in row)  # makes the largest eigenvalue dominate
    q = [1.0, 0.1, 0.2, 0.3]
    for _ in range(20000):
        q = [sum(n[i][k] * q[k] for k in range(4)) + shift * q[i] for i in range(4)]
        size = norm(q)
        q = [v / size for v in q]
    r = matrix((q[1], q[2], q[3], q[0]))
    return r, minus(mt, apply(r, me))


def exact_ape_se3(estimate, truth):
    """RMSE after the best rotation and translation, in 60 digits."""
    estimate, truth = ([[decimal.Decimal(repr(v)) for v in p] for p in points]
                       for points in (estimate, truth))
    me, mt, n = horn_matrix(estimate, truth)
    shift = sum(abs(v) for row in n for v in row)
    n = [[v + (shift if i == j else 0) for j, v in enumerate(row)] for i, row in enumerate(n)]
    for _ in range(100):
        n = [[sum(n[i][k] * n[k][j] for k in range(4)) for j in range(4)] for i in range(4)]
        size = sum(n[i][i] for i in range(4))
        n = [[v / size for v in row] for row in n]
    q = max(n, key=lambda row: sum(v * v for v in row))
    size = sum(v * v for v in q).sqrt()
    w, x, y, z = (v / size for v in q)
    r = matrix((x, y, z, w))
    off = [minus(apply(r, minus(e, me)), minus(t, mt)) for e, t in zip(estimate, truth)]
    return (sum(v * v for each in off for v in each) / len(off)).sqrt()


def associate(estimate, truth):
    truth_chooses = len(estimate) > len(truth)
    short, long = (truth, estimate) if truth_chooses else (estimate, truth)
    pairs = []
    for each in short:
        nearest = min(long, key=lambda other: abs(other[0] - each[0]))
        if abs(nearest[0] - each[0]) <= 0.01:
            pairs.append((nearest, each) if truth_chooses else (each, nearest))
    return [(pose(e), pose(t)) for e, t in pairs]


def pose(line):
    size = norm(line[4:8])
    return matrix([v / size for v in line[4:8]]), list(line[1:4])


def stretches(positions, delta, all_pairs):
    steps = [norm(minus(b, a)) for a, b in zip(positions, positions[1:])]
    if all_pairs:
        found = []
        for i in range(len(positions) - 1):
            off = [abs(sum(steps[i:j]) - delta) for j in range(i + 1, len(positions))]
            best = off.index(min(off))
            if off[best] <= 0.1 * delta:
                found.append((i, i + 1 + best))
        return found
    ends, path = [], 0.0
    for i, step in enumerate(steps, start=1):
        path += step
        if path >= delta:
            ends.append(i)
            path = 0.0
    return list(zip(ends, ends[1:]))


def make_lines():
    rng = random.Random(7)
    truth = []
    for k in range(400):
        t = k * 0.04
        yaw = 0.9 * math.sin(0.25 * t)
        truth.append((100.0 + t, 1.5 * t, 4.0 * math.sin(0.3 * t), 0.4 * math.sin(0.5 * t),
                      *quaternion(yaw, 0.05 * math.sin(t), 0.04 * math.cos(1.3 * t))))
    frame = matrix(quaternion(2.1, 0.02, -0.03))
    estimate, drift = [], [0.0, 0.0, 0.0]
    for k in range(155):
        t = 0.1 * k + 0.004 + 0.003 * math.sin(k)
        yaw = 0.9 * math.sin(0.25 * t) + 0.004 * t + rng.gauss(0.0, 0.003)
        drift = plus(drift, [rng.gauss(0.002, 0.01) for _ in range(3)])
        p = plus([1.5 * t, 4.0 * math.sin(0.3 * t), 0.4 * math.sin(0.5 * t)], drift)
        q = quaternion(2.1 + yaw, 0.02 + 0.05 * math.sin(t), -0.03)
        estimate.append((100.0 + t, *plus(apply(frame, p), [3.0, -2.0, 0.5]), *q))
    return truth, estimate


def make_straight_lines():
    rng = random.Random(11)
    tilt = matrix(quaternion(0.3, 0.02, 0.01))
    truth, estimate = [], []
    for k in range(120):
        t = 0.5 * k
        p = [t, 0.002 * math.sin(3.0 * t), 0.3 + 0.004 * math.sin(2.0 * t)]
        truth.append((t, *p, 0.0, 0.0, 0.0, 1.0))
        noisy = plus(p, [rng.gauss(0.0, 0.003) for _ in range(3)])
        estimate.append((t, *apply(tilt, noisy), *quaternion(0.3, 0.02, 0.01)))
    return truth, estimate


def rounded(line):
    return (round(line[0], 9), *[round(v, 7) for v in line[1:]])


def write_tum(name, lines):
    with open(name, "w", encoding="ascii") as file:
        for line in lines:
            file.write(f"{line[0]:.9f} " + " ".join(f"{v:.7f}" for v in line[1:]) + "\n")


def main():
    truth, estimate = ([rounded(each) for each in lines] for lines in make_lines())
    write_tum("truth.tum", truth)
    write_tum("estimate.tum", estimate)
    pairs = associate(estimate, truth)
    golden = {"pairs": len(pairs)}

    golden["ape_raw"] = rmse([norm(minus(e[1], t[1])) for e, t in pairs])
    (re, pe), (rt, pt) = pairs[0]
    r = times(rt, transposed(re))
    golden["ape_origin"] = rmse(
        [norm(minus(plus(apply(r, minus(e[1], pe)), pt), t[1])) for e, t in pairs])
    r, p = horn([e[1] for e, _ in pairs], [t[1] for _, t in pairs])
    golden["ape_se3"] = rmse([norm(minus(plus(apply(r, e[1]), p), t[1])) for e, t in pairs])

    for delta in (1, 10):
        for source, index in (("est", 0), ("ref", 1)):
            for every in (False, True):
                ids = stretches([pair[index][1] for pair in pairs], delta, every)
                errors = []
                for i, j in ids:
                    (pi, qi), (pj, qj) = pairs[i], pairs[j]
                    errors.append(relative(relative(qi, qj), relative(pi, pj)))
                name = f"rpe_{delta}m_{source}_{'all' if every else 'consecutive'}"
                golden[name + "_pairs"] = len(ids)
                golden[name + "_trans"] = rmse([norm(e[1]) for e in errors])
                golden[name + "_rot"] = rmse([angle(e[0]) for e in errors])

    truth, estimate = ([rounded(each) for each in lines] for lines in make_straight_lines())
    write_tum("straight_truth.tum", truth)
    write_tum("straight_estimate.tum", estimate)
    with decimal.localcontext(decimal.Context(prec=60)):
        golden["straight_ape_se3"] = float(
            exact_ape_se3([e[1:4] for e in estimate], [t[1:4] for t in truth]))

    with open("golden.txt", "w", encoding="ascii") as file:
        for name, value in golden.items():
            file.write(f"{name} {value!r}\n")


if __name__ == "__main__":
    main()
