# SPDX-License-Identifier: BSD-3-Clause
import json
import pathlib
import re
import subprocess
import sys

from conftest import program

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


def test_the_table_of_the_readme_is_that_of_a_suite(folder):
    program("suite", "walk.yaml", "--seeds", "1-2", "--no-page", "--quiet", "-o", "suite", cwd=folder)
    script = SOURCE / "scripts" / "results_table.py"
    (folder / "page.md").write_text("before\n<!-- results -->\nold\n<!-- end of results -->\nafter\n")
    done = subprocess.run([sys.executable, script, "suite", "--into", "page.md"], cwd=folder)
    assert done.returncode == 0
    lines = (folder / "page.md").read_text().splitlines()
    assert lines[0] == "before" and lines[-1] == "after" and "old" not in lines
    suite = json.loads((folder / "suite" / "suite.json").read_text())
    row = next(line for line in lines if "`aims_d`" in line).split("|")
    scores = suite["scenarios"][0]["estimators"]["aims_d"]["scores"]
    # Wilson's interval of two successes in two runs: 100 * 2 / (2 + 1.96^2) = 34 %.
    assert row[3].strip() == "2/2 (34–100 %)"
    assert row[5].strip() == f"{scores['ate_yaw_m']['median']:.2f}"
