"""Large sweeps: planning 10,000 points takes under two seconds of processor time."""
import json
import os
import pathlib
import resource
import subprocess
import tempfile
import unittest

import sweep


class Scale(unittest.TestCase):
    def test_ten_thousand_points_are_planned_in_two_seconds(self):
        config = {"name": "large", "scene": "torus_knot", "mask_size": list(range(1, 101)),
                  "light_size": [0.01 * i for i in range(1, 101)], "techniques": ["ray_tracing"]}
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "large.json"
            path.write_text(json.dumps(config), encoding="utf-8")
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            result = subprocess.run([sweep.PROGRAM, "run", str(path), "--dry-run"], capture_output=True, text=True,
                                    check=False, env=dict(os.environ))
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("10000 points", result.stdout)
        self.assertEqual(result.stdout.count("ray_tracing/torus_knot/"), 10000)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        print(f"{seconds:.2f} s, {after.ru_maxrss / 1024:.0f} MB")
        self.assertLess(seconds, 2)
        self.assertLess(after.ru_maxrss * 1024, 500e6)


if __name__ == "__main__":
    unittest.main()
