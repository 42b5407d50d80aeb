"""`scripts/reproduce all --ci`: one row of each table of each paper runs, and every table has figures of ours."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = pathlib.Path(os.environ["PENUMBRA_SOURCE"])
sys.dont_write_bytecode = True
sys.path.insert(0, str(SOURCE / "scripts"))
from reproducing import paper, reading, runs  # noqa: E402


class Papers(unittest.TestCase):
    def test_every_table_of_every_paper_has_a_row_of_ours(self):
        with tempfile.TemporaryDirectory() as folder:
            started = time.monotonic()
            result = subprocess.run([SOURCE / "scripts" / "reproduce", "all", "--ci", "--out", folder, "--quiet"],
                                    capture_output=True, text=True, check=False, timeout=580)
            print(f"{time.monotonic() - started:.0f} s\n{result.stderr}")
            self.assertEqual(result.returncode, 0, result.stderr)
            for name in paper.papers():
                summary = json.loads((pathlib.Path(folder) / name / "ci" / "summary.json").read_text(encoding="utf-8"))
                for table in summary["tables"]:
                    figures = [f for rows in table["figures"].values() for row in rows.values() for f in row.values()]
                    with self.subTest(f"{name} {table['id']}"):
                        self.assertTrue(any(f is not None for f in figures))

    def test_full_and_short_runs_are_valid(self):
        for name in paper.papers():
            the_paper = paper.load(name)
            for mode in ("full", "short"):
                for run in runs.plan(the_paper, the_paper.data["tables"], mode, pathlib.Path("unused")):
                    with self.subTest(f"{name} {run.config.name} {mode}"):
                        try:
                            runs.check(run)
                        except reading.BadInput as error:  # meshes that no package holds need not be here
                            self.assertIn("is not found. Get it with: scripts/fetch_scenes", str(error))


if __name__ == "__main__":
    unittest.main()
