# SPDX-License-Identifier: BSD-3-Clause
"""One short recording for all tests. AIMS_PROGRAM: the built program."""

import os
import pathlib
import subprocess

import pytest

PROGRAM = os.environ["AIMS_PROGRAM"]
WALK = """
scene: {corridor: {length: 10}}
route: {stand_before: 2.5, points: [{name: a, x: 0, y: 0}, {name: b, x: 1.5, y: 0}]}
lidar: {columns: 450}
run: [aims_d, leg]
"""


def program(*arguments, cwd, code=0, env=None):
    """Runs `aims`; its standard output and error. Fails unless it exits with that code."""
    done = subprocess.run(
        [PROGRAM, *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        env={**os.environ, "XDG_CACHE_HOME": str(cwd / "cache"), **(env or {})},
    )
    assert done.returncode == code, f"exit code {done.returncode}: {done.stdout}{done.stderr}"
    return done.stdout, done.stderr


@pytest.fixture(scope="session")
def folder(tmp_path_factory) -> pathlib.Path:
    """A folder with walk.yaml and walk.bag, a metre and a half walked along a corridor."""
    path = tmp_path_factory.mktemp("aims")
    (path / "walk.yaml").write_text(WALK)
    program("simulate", "walk.yaml", "--quiet", "-o", "walk.bag", cwd=path)
    return path


@pytest.fixture(scope="session")
def bag(folder):
    return folder / "walk.bag"


@pytest.fixture(scope="session")
def estimated(folder):
    """The folder that `aims estimate` writes of the recording."""
    program("estimate", "walk.bag", "--estimators", "aims_d,leg", "--quiet", "--no-pictures",
            "--no-page", "-o", "estimated", cwd=folder)
    return folder / "estimated"
