# SPDX-License-Identifier: BSD-3-Clause
"""Trajectories: stamped poses as NumPy arrays."""

import numpy as np

from .errors import Error, optional


class Trajectory:
    """Poses of the body in a fixed frame.

    stamps       (N,) int64 [ns]
    positions    (N, 3) float64 [m]
    quaternions  (N, 4) float64, x y z w
    """

    def __init__(self, stamps, positions, quaternions):
        stamps = np.asarray(stamps)
        if stamps.size and stamps.dtype.kind not in "iu":
            raise Error(f"stamps: expected whole nanoseconds, got {stamps.dtype}")
        self.stamps = stamps.astype(np.int64).reshape(-1)
        self.positions = np.asarray(positions, dtype=float).reshape(-1, 3)
        self.quaternions = np.asarray(quaternions, dtype=float).reshape(-1, 4)
        if not len(self.stamps) == len(self.positions) == len(self.quaternions):
            raise Error(
                f"expected one position and quaternion per stamp, got {len(self.stamps)} stamps, "
                f"{len(self.positions)} positions, {len(self.quaternions)} quaternions"
            )

    @classmethod
    def from_matrices(cls, stamps, matrices):
        """Of poses (N, 4, 4)."""
        matrices = np.asarray(matrices, dtype=float).reshape(-1, 4, 4)
        return cls(stamps, matrices[:, :3, 3], quaternions_of(matrices[:, :3, :3]))

    def __len__(self):
        return len(self.stamps)

    def __repr__(self):
        if not len(self):
            return "Trajectory: no poses"
        return f"Trajectory: {len(self)} poses over {self.seconds[-1] - self.seconds[0]:.1f} s"

    @property
    def seconds(self):
        """(N,) float64: the stamps [s]."""
        return 1e-9 * self.stamps

    @property
    def matrices(self):
        """(N, 4, 4): the poses."""
        x, y, z, w = self.quaternions.T
        poses = np.zeros((len(self), 4, 4))
        poses[:, 3, 3] = 1.0
        poses[:, :3, 3] = self.positions
        poses[:, 0, 0] = 1 - 2 * (y * y + z * z)
        poses[:, 0, 1] = 2 * (x * y - z * w)
        poses[:, 0, 2] = 2 * (x * z + y * w)
        poses[:, 1, 0] = 2 * (x * y + z * w)
        poses[:, 1, 1] = 1 - 2 * (x * x + z * z)
        poses[:, 1, 2] = 2 * (y * z - x * w)
        poses[:, 2, 0] = 2 * (x * z - y * w)
        poses[:, 2, 1] = 2 * (y * z + x * w)
        poses[:, 2, 2] = 1 - 2 * (x * x + y * y)
        return poses

    def aligned_to(self, truth):
        """The same poses laid onto `truth`: both agree at the first stamp that both cover.

        Between two poses of the truth the nearer one counts.
        """
        inside = np.flatnonzero((self.stamps >= truth.stamps[0]) & (self.stamps <= truth.stamps[-1]))
        if not len(inside):
            raise Error("aligned_to(): no pose lies within the time of the truth")
        first = inside[0]
        nearest = np.abs(truth.stamps - self.stamps[first]).argmin()
        own, true = self._rows(first).matrices[0], truth._rows(nearest).matrices[0]
        return Trajectory.from_matrices(self.stamps, true @ np.linalg.inv(own) @ self.matrices)

    def _rows(self, index):
        at = slice(index, index + 1)
        return Trajectory(self.stamps[at], self.positions[at], self.quaternions[at])

    def write(self, path):
        """Writes lines of the TUM format, which read back to the same numbers."""
        from . import _core

        _core.write_trajectory(path, self)

    def frame(self):
        """A pandas frame: stamp [ns], x, y, z [m], qx, qy, qz, qw."""
        pandas = optional("pandas", "python3-pandas", "Trajectory.frame()")
        columns = {"stamp": self.stamps}
        columns.update(zip("xyz", self.positions.T))
        columns.update(zip(("qx", "qy", "qz", "qw"), self.quaternions.T))
        return pandas.DataFrame(columns)


def quaternions_of(rotations):
    """(N, 4) x y z w with w >= 0, of rotation matrices (N, 3, 3)."""
    R = np.asarray(rotations, dtype=float).reshape(-1, 3, 3)
    xx, yy, zz = R[:, 0, 0], R[:, 1, 1], R[:, 2, 2]
    # Four times the squares of x, y, z, w; from the largest, the others follow without cancellation.
    squares = np.stack([1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz], 1)
    products = np.empty((len(R), 4, 4))
    products[:, range(4), range(4)] = squares
    for a, b, value in (
        (0, 1, R[:, 1, 0] + R[:, 0, 1]),
        (0, 2, R[:, 2, 0] + R[:, 0, 2]),
        (1, 2, R[:, 2, 1] + R[:, 1, 2]),
        (0, 3, R[:, 2, 1] - R[:, 1, 2]),
        (1, 3, R[:, 0, 2] - R[:, 2, 0]),
        (2, 3, R[:, 1, 0] - R[:, 0, 1]),
    ):
        products[:, a, b] = products[:, b, a] = value
    best = products[np.arange(len(R)), squares.argmax(axis=1)] if len(R) else np.empty((0, 4))
    best = best / np.linalg.norm(best, axis=1, keepdims=True)
    return np.where(best[:, 3:] < 0, -best, best)


def read_trajectory(source):
    """The trajectory of a TUM or KITTI file, or of a topic of a recording ("run.bag:/odom")."""
    from . import _core

    return _core.read_trajectory(str(source))
