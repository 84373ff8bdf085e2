# SPDX-License-Identifier: BSD-3-Clause
import aims
import numpy as np
import pytest


def random_trajectory(seed, count=50):
    rng = np.random.default_rng(seed)
    quaternions = rng.normal(size=(count, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    return aims.Trajectory(np.arange(count) * 10**8, rng.normal(size=(count, 3)), quaternions)


@pytest.mark.parametrize("seed", range(5))
def test_matrices_and_quaternions_are_the_same_rotations(seed):
    given = random_trajectory(seed)
    matrices = given.matrices
    identity = matrices[:, :3, :3] @ matrices[:, :3, :3].transpose(0, 2, 1)
    np.testing.assert_allclose(identity, np.broadcast_to(np.eye(3), identity.shape), atol=1e-12)
    # Oracle: v + 2 q x (q x v + w v).
    vector = np.array([0.3, -0.2, 0.9])
    q, w = given.quaternions[:, :3], given.quaternions[:, 3:]
    rotated = vector + 2 * np.cross(q, np.cross(q, vector) + w * vector)
    np.testing.assert_allclose(matrices[:, :3, :3] @ vector, rotated, atol=1e-12)
    back = aims.Trajectory.from_matrices(given.stamps, matrices)
    sign = np.sign(np.sum(back.quaternions * given.quaternions, axis=1, keepdims=True))
    np.testing.assert_allclose(sign * back.quaternions, given.quaternions, atol=1e-12)


def test_half_turns_have_quaternions_too():
    for axis in np.eye(3):
        rotation = 2 * np.outer(axis, axis) - np.eye(3)
        pose = np.eye(4)
        pose[:3, :3] = rotation
        trajectory = aims.Trajectory.from_matrices([0], [pose])
        np.testing.assert_allclose(trajectory.matrices[0], pose, atol=1e-15)


def test_files_read_back_to_the_same_numbers(tmp_path):
    given = random_trajectory(9)
    given.write(tmp_path / "t.tum")
    back = aims.read_trajectory(tmp_path / "t.tum")
    np.testing.assert_array_equal(back.stamps, given.stamps)
    np.testing.assert_array_equal(back.positions, given.positions)
    np.testing.assert_allclose(back.quaternions, given.quaternions, atol=1e-15)


def test_a_shifted_estimate_has_the_error_of_its_scale():
    count = 400
    stamps = np.arange(count) * 10**8
    still = np.tile([0.0, 0, 0, 1], (count, 1))
    along = np.zeros((count, 3))
    along[:, 0] = np.linspace(0, 40, count)
    truth = aims.Trajectory(stamps, along, still)
    scores = aims.score(truth, {"long": aims.Trajectory(stamps, 1.02 * along, still)},
                        segments="a-b=0:39.9")
    assert scores["long"]["m_list_percent"]["a-b"] == pytest.approx(2.0, abs=1e-9)
    assert scores["long"]["m_end_m"] == pytest.approx(0.8, abs=1e-9)
    assert scores.rows()["long"]["m_list_percent.all"] == pytest.approx(2.0, abs=1e-9)


def test_malformed_trajectories_are_named():
    with pytest.raises(aims.Error, match="stamps: expected whole nanoseconds"):
        aims.Trajectory([0.5], [[0, 0, 0]], [[0, 0, 0, 1]])
    with pytest.raises(aims.Error, match="expected one position"):
        aims.Trajectory([0, 1], [[0, 0, 0]], [[0, 0, 0, 1]])
    good = random_trajectory(1)
    late = aims.Trajectory(good.stamps[::-1], good.positions, good.quaternions)
    with pytest.raises(aims.Error, match="truth: pose 1: its stamp is not after"):
        aims.score(late, {"e": good})
    apart = aims.Trajectory(good.stamps + 10**12, good.positions, good.quaternions)
    with pytest.raises(aims.Error, match="do not overlap"):
        aims.score(good, {"e": apart})


def test_frames_and_pictures_where_their_packages_are(tmp_path):
    given = random_trajectory(3)
    pandas = pytest.importorskip("pandas")
    frame = given.frame()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns)[:2] == ["stamp", "x"]
    scores = aims.score(given, {"same": given})
    assert scores.frame().loc["same", "ate_m"] == 0.0
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = scores.plot()
    assert [line.get_label() for line in axes.get_lines()] == ["truth", "same"]
    axes.figure.savefig(tmp_path / "p.png")
