# SPDX-License-Identifier: BSD-3-Clause
import pathlib
import re
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def test_the_example_runs_and_its_documented_output_is_what_it_prints(tmp_path):
    example = SOURCE / "python" / "examples" / "first_steps.py"
    done = subprocess.run([sys.executable, example, tmp_path], capture_output=True, text=True,
                          cwd=SOURCE)
    assert done.returncode == 0, done.stderr
    document = (SOURCE / "docs" / "python.md").read_text()
    documented = re.search(r"<!-- output of first_steps.py -->\n```\n(.*?)```", document, re.S)
    lines = documented.group(1).splitlines()
    assert lines and lines == done.stdout.splitlines()[: len(lines)]


def test_the_overhead_is_measured(bag):
    done = subprocess.run([sys.executable, "-m", "aims.overhead", bag], capture_output=True,
                          text=True, check=True, env=None)
    assert re.search(r"native +\d.*\nloop +\d.*\nprocess +\d", done.stdout), done.stdout
