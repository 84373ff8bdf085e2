# SPDX-License-Identifier: BSD-3-Clause
"""What tests of the program in Python have in common: its path, a folder, and its refusals."""

import os
import subprocess
import sys
import tempfile
import unittest

GIVEN = []  # the program, then what else run.sh hands over


def aims(*arguments, environment=None):
    return subprocess.run([GIVEN[0], *arguments], capture_output=True, text=True, check=False,
                          env={**os.environ, **(environment or {})})


def simulate(scenario, recording, *options):
    run = aims("simulate", scenario, "--out", recording, "--quiet", *options)
    assert run.returncode == 0, run.stderr
    return recording


def poses_of(recording, folder, *options, estimators="aims_d,leg"):
    """The files of poses, by name, that estimating a recording gives; the truth is among them."""
    out = tempfile.mkdtemp(dir=folder)
    run = aims("estimate", recording, "--estimators", estimators, "--no-pictures", "--no-page",
               "--quiet", "--overwrite", "--out", out, *options)
    assert run.returncode == 0, run.stderr + run.stdout
    poses = {}
    for name in (*estimators.split(","), "truth"):
        with open(os.path.join(out, name + ".tum"), "rb") as stream:
            poses[name] = stream.read()
    return poses


class ProgramTest(unittest.TestCase):
    """Has a folder, for all tests of the class."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder.name, name)

    def put(self, name, content):
        with open(self.path(name), "wb") as stream:
            stream.write(content if isinstance(content, (bytes, bytearray)) else content.encode())
        return self.path(name)

    def refuse(self, expected, *arguments, environment=None):
        """The program refuses its arguments in one line that holds `expected`."""
        run = aims(*arguments, environment=environment)
        self.assertEqual(run.returncode, 2, run.stderr + run.stdout)
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        self.assertIn(expected, run.stderr)
        return run


def main(given):
    """Runs the tests of the calling file; its first `given` arguments become GIVEN."""
    GIVEN[:] = sys.argv[1:1 + given]
    unittest.main(argv=[sys.argv[0], *sys.argv[1 + given:]])
