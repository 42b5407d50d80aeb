"""How the tests of the command line call the program, and a folder of their own."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["PENUMBRA_PROGRAM"]
SOURCE = pathlib.Path(os.environ["PENUMBRA_SOURCE"])
# A config of two points that takes no time.
TINY = {"scene": "torus_knot", "resolution": 32, "mask_size": [2, 4], "techniques": ["ray_tracing"], "images": [],
        "reference": {"light_samples": 16},
        "measure": {"warmup": 0, "repetitions": 1, "min_time_s": 0, "max_time_s": 5}}


def penumbra(*arguments, cwd=None, stdout=subprocess.PIPE, env=None):
    environment = dict(os.environ, **(env or {}))
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, stdout=stdout, stderr=subprocess.PIPE, text=True,
                          env=environment, timeout=120, check=False)


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text if isinstance(text, str) else json.dumps(text), encoding="utf-8")
        return path

    def refused(self, *arguments, code=2, says=(), **options):
        """The call ends with `code`, prints no data, and one message that contains every text of `says`."""
        result = penumbra(*arguments, **options)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertFalse(result.stdout)
        self.assertTrue(result.stderr.startswith("penumbra: "), result.stderr)
        self.assertNotIn("internal error", result.stderr)
        for text in says:
            self.assertIn(text, result.stderr)

    def accepted(self, *arguments, **options):
        result = penumbra(*arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        return result.stdout
