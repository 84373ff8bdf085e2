# SPDX-License-Identifier: BSD-3-Clause
"""usage: evo_test.py AIMS SCENARIO. Scores as a result of evo, and as a table of LaTeX."""

import json
import math
import struct
import zipfile

from program_test import ProgramTest, aims, main


def array(content):
    """Numbers of a file of NumPy, by the description of its format."""
    magic, major, minor, length = struct.unpack("<6sBBH", content[:10])
    assert (magic, major, minor) == (b"\x93NUMPY", 1, 0), content[:10]
    assert (10 + length) % 64 == 0 and content[9 + length:10 + length] == b"\n"
    header = eval(content[10:10 + length].decode("ascii"), {"__builtins__": {}})  # a dict of literals
    assert header["descr"] == "<f8" and header["fortran_order"] is False
    (count,) = header["shape"]
    return list(struct.unpack(f"<{count}d", content[10 + length:]))


class EvoResults(ProgramTest):
    def scored(self):
        poses = [(0.1 * i, 0.1 * i, 3.0 * math.sin(0.01 * i)) for i in range(400)]
        self.put("truth.tum", "".join(f"{t} {x} {y} 0 0 0 0 1\n" for t, x, y in poses))
        self.put("my_est.tum", "".join(f"{t} {1.01 * x} {y} 0 0 0 0 1\n" for t, x, y in poses))
        done = aims("score", "--truth", self.path("truth.tum"), "--estimate", self.path("my_est.tum"),
                    "--evo", "--no-pictures", "--no-page", "--overwrite", "--out", self.path("out"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with open(self.path("out/scores.json"), encoding="utf-8") as file:
            return json.load(file)["estimators"]["my_est"]

    def test_the_archive_holds_what_evo_res_reads(self):
        scores = self.scored()
        with zipfile.ZipFile(self.path("out/my_est.evo.zip")) as archive:
            self.assertIsNone(archive.testzip())
            info = json.loads(archive.read("info.json"))
            stats = json.loads(archive.read("stats.json"))
            arrays = {name[:-4]: array(archive.read(name)) for name in archive.namelist() if name.endswith(".npy")}
        self.assertEqual(info["est_name"], "my_est")
        self.assertLessEqual({"title", "label", "ref_name"}, set(info))
        errors = arrays["error_array"]
        self.assertEqual(len(errors), 400)
        mean = sum(errors) / 400
        self.assertAlmostEqual(stats["rmse"], math.sqrt(sum(e * e for e in errors) / 400), places=12)
        self.assertAlmostEqual(stats["rmse"], scores["ate_yaw_m"], places=12)
        self.assertAlmostEqual(stats["mean"], mean, places=12)
        self.assertAlmostEqual(stats["std"], math.sqrt(sum((e - mean) ** 2 for e in errors) / 400), places=12)
        self.assertAlmostEqual(stats["median"], 0.5 * sum(sorted(errors)[199:201]), places=12)
        self.assertAlmostEqual(stats["sse"], sum(e * e for e in errors), places=10)
        self.assertEqual((stats["min"], stats["max"]), (min(errors), max(errors)))
        self.assertAlmostEqual(arrays["timestamps"][7], 0.7, places=9)
        self.assertAlmostEqual(arrays["seconds_from_start"][-1], 39.9, places=9)
        self.assertGreater(arrays["distances_from_start"][-1], 39.9)
        try:
            import numpy
        except ImportError:
            return
        with zipfile.ZipFile(self.path("out/my_est.evo.zip")) as archive, archive.open("error_array.npy") as file:
            self.assertEqual(list(numpy.load(file)), errors)

    def test_the_table_is_one_of_latex(self):
        self.scored()
        with open(self.path("out/scores.tex"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        self.assertTrue(lines[0].startswith("\\begin{tabular}{lrr"))
        self.assertIn("path error \\%", lines[2])
        self.assertTrue(lines[4].startswith("my\\_est & "))
        self.assertEqual(lines[4].count(" & "), lines[2].count(" & "))
        self.assertEqual(lines[-1], "\\end{tabular}")


if __name__ == "__main__":
    main(given=2)
