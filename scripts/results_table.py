#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prints the results of a folder of `aims suite` as the Markdown table of README.md.

  scripts/results_table.py out/results                     # to standard output
  scripts/results_table.py out/results --into README.md    # between the lines <!-- results --> there

A row per scenario and estimator, in the order of --estimators (default: that of suite.json).
"""

import argparse
import json
import math
import pathlib
import sys

BEGIN, END = "<!-- results -->", "<!-- end of results -->"
NAMES = {  # what README calls the scenarios
    "severity_0": "level 0: doors, pillars, clutter",
    "severity_1": "level 1: the paper's corridor",
    "severity_3": "level 3: doors, 30 m range",
    "severity_5": "level 5: recesses of 5 cm",
    "severity_8": "level 8: plain walls, end walls",
    "severity_9": "level 9: plain walls, open ends",
    "severity_9_relief": "level 9, walls with relief",
    "garage": "the paper's garage",
}


def wilson(successes, runs, z=1.96):
    """The 95 % interval of a success rate [%]."""
    rate = successes / runs
    centre = rate + z * z / (2 * runs)
    half = z * math.sqrt(rate * (1 - rate) / runs + z * z / (4 * runs * runs))
    scale = 100 / (1 + z * z / runs)
    return max(scale * (centre - half), 0.0), scale * (centre + half)


def median(scores, key, digits):
    """The median over seeds as text; beyond 100 with no digits, "-" where there is none."""
    value = scores.get(key, {}).get("median")
    if value is None:
        return "-"
    return f"{value:.{0 if abs(value) >= 100 else digits}f}"


def rows(suite, estimators):
    for case in suite["scenarios"]:
        title = NAMES.get(case["name"], case["name"])
        for name in estimators or case["estimators"]:
            found = case["estimators"].get(name)
            if found is None:
                continue
            low, high = wilson(found["successes"], found["runs"])
            scores = found["scores"]
            yield [
                title,
                f"`{name}`",
                f"{found['successes']}/{found['runs']} ({low:.0f}–{high:.0f} %)",
                median(scores, "m_list_percent.all", 2),
                median(scores, "ate_yaw_m", 2),
                median(scores, "path_error_percent.all", 2),
            ]
            title = ""


def table(suite, estimators):
    lines = [
        "| scenario | estimator | success (95 %) | M_list % | ATE m | path error % |",
        "|---|---|---:|---:|---:|---:|",
    ]
    lines += ["| " + " | ".join(row) + " |" for row in rows(suite, estimators)]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--estimators", default="")
    parser.add_argument("--into", type=pathlib.Path)
    arguments = parser.parse_args()
    try:
        suite = json.loads((arguments.folder / "suite.json").read_text())
    except OSError as error:
        sys.exit(f"results_table.py: {error}; expected a folder of aims suite")
    text = table(suite, [name for name in arguments.estimators.split(",") if name])
    if arguments.into is None:
        print(text, end="")
        return
    page = arguments.into.read_text()
    head, begin, rest = page.partition(BEGIN)
    _, end, tail = rest.partition(END)
    if not begin or not end:
        sys.exit(f"results_table.py: {arguments.into}: expected the lines {BEGIN} and {END}")
    arguments.into.write_text(f"{head}{BEGIN}\n{text}{END}{tail}")


if __name__ == "__main__":
    main()
