"""Faults put into the running program (faults.c): each file in turn on a full disk; a device that is lost, a driver that
aborts or never comes back. Every one ends as results/README.md says, and the sweep goes on afterwards as if nothing had
been."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import sweep

HERE = pathlib.Path(__file__).parent
CONFIG = {"name": "tiny", "scene": "torus_knot", "resolution": 16, "mask_size": 2, "techniques": ["ray_tracing", "gears"],
          "images": ["visibility", "shaded", "error", "mask", "position", "normal", "triangle"],
          "reference": {"light_samples": 16}, "measure": {"warmup": 0, "repetitions": 2, "min_time_s": 0, "max_time_s": 3}}


class Injected(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.base = pathlib.Path(folder.name)
        library = cls.base / "faults.so"
        subprocess.run([os.environ.get("CC", "cc"), "-shared", "-fPIC", "-O1", "-o", library, HERE / "faults.c", "-ldl"],
                       check=True)
        cls.config = cls.base / "tiny.json"
        cls.config.write_text(json.dumps(CONFIG), encoding="utf-8")
        cls.env = dict(os.environ, PENUMBRA_CACHE=str(cls.base / "cache"), PENUMBRA_VALIDATION="0")
        cls.faulty = dict(cls.env, LD_PRELOAD=str(library))
        result = sweep.run(cls.config, cls.base / "calm", env=cls.env)
        assert result.returncode == 0, result.stderr
        cls.calm = sweep.outcome(cls.base / "calm")

    def program(self, *arguments, **faults):
        return subprocess.run([sweep.PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, timeout=120,
                              env=dict(self.faulty, **faults))

    def ends_well(self, out):
        result = sweep.run(self.config, out, resume=(out / "points.jsonl").exists(), env=self.env)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sweep.outcome(out), self.calm)

    def test_a_full_disk_under_any_file_of_a_run_is_exit_code_4_and_names_it(self):
        files = ["run.json", "points.jsonl", "results.json", "results.csv"]
        files += sorted({p.name for p in (self.base / "calm" / "images").rglob("*") if p.is_file()})
        self.assertGreaterEqual(len(files), 12, files)
        for file in files:
            with self.subTest(file):
                out = self.base / f"full-{file}"
                result = self.program("run", self.config, "--out", out, "--quiet", "--no-report", FAULT_FULL=f"/{file}")
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assertRegex(result.stderr, rf"{file}: cannot be written: No space left on device")
                self.assertNotIn("internal error", result.stderr)
                if file in ("points.jsonl", "results.csv", "mask.exr"):
                    self.ends_well(out)

    def test_a_full_disk_under_the_cache_is_a_message_and_no_error(self):
        shutil.rmtree(self.base / "cache")
        out = self.base / "full-cache"
        result = self.program("run", self.config, "--out", out, "--quiet", "--no-report", FAULT_FULL=".bin.part")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sweep.outcome(out), self.calm)
        self.assertEqual(list((self.base / "cache").rglob("*.bin*")), [])

    def test_a_full_disk_under_what_is_made_of_a_run_is_exit_code_4(self):
        calm, out = self.base / "calm", self.base / "made"
        out.mkdir()
        for file, command in (("index.html", ("report", calm, "-o", out / "report")),
                              ("data.js", ("report", calm, "-o", out / "report2")),
                              ("report.css", ("report", calm, "-o", out / "report3")),
                              ("visibility.png", ("report", calm, "-o", out / "report4")),
                              ("t.csv", ("export", calm, "--format", "csv", "-o", out / "t.csv")),
                              ("t.tex", ("export", calm, "--format", "latex", "-o", out / "t.tex")),
                              ("junit.xml", ("compare", calm, calm, "--junit", out / "junit.xml")),
                              ("index.html", ("compare", calm, calm, "--report", out / "compare")),
                              ("tiny.json", ("baseline", "update", calm, "--dir", out / "baselines")),
                              ("points.jsonl", ("merge", calm, "--out", out / "merged")),
                              ("picture.exr", ("render", "torus_knot", "ray_tracing", "resolution=16", "-o", out / "picture.exr"))):
            with self.subTest(command[0] + " " + file):
                result = self.program(*command, FAULT_FULL=f"/{file}")
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assertIn("cannot be written", result.stderr)
        self.assertEqual(sweep.outcome(calm), self.calm)

    def faulted(self, how, after):
        """A run whose worker meets the fault at its submission number `after`: its records by technique."""
        marker = self.base / "marker"
        marker.touch()
        out = self.base / f"{how}{after}"
        result = self.program("run", self.config, "--out", out, "--quiet", "--no-report", FAULT_SUBMIT=str(marker),
                              FAULT_HOW=how, FAULT_AFTER=str(after))
        self.assertFalse(marker.exists(), "the fault was not reached")
        points = json.loads((out / "results.json").read_text(encoding="utf-8"))["points"]
        self.assertEqual(len(points), 2, result.stderr)
        return result, out, {p["technique"]: p for p in points}

    def test_a_device_lost_in_a_point_ends_that_point_alone(self):
        result, out, points = self.faulted("lost", 12)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(points["ray_tracing"]["status"], "ok")
        self.assertEqual(points["gears"]["status"], "failed")
        self.assertIn("the device was lost", points["gears"]["message"])
        self.assertTrue(points["gears"]["last_pass"])
        self.ends_well(out)

    def test_an_abort_in_the_driver_ends_its_point_and_says_the_signal_the_pass_and_the_last_words(self):
        result, out, points = self.faulted("abort", 12)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(points["ray_tracing"]["status"], "ok")
        failed = points["gears"]
        self.assertEqual((failed["status"], failed["signal"]), ("failed", 6))
        self.assertIn("the fault is here: abort", failed["worker_messages"])
        self.assertTrue(failed["last_pass"])
        self.ends_well(out)

    # While it is being timed: there the limit is max_time_s without the half minute that a first frame has more.
    def test_a_driver_that_never_comes_back_is_a_timeout_of_its_point(self):
        result, out, points = self.faulted("loop", 40)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(points["ray_tracing"]["status"], "ok")
        late = points["gears"]
        self.assertEqual((late["status"], late["signal"]), ("timeout", 9), late["message"])
        self.assertIn(late["stage"], ("build", "warm-up", "measure"))
        self.assertIn("the fault is here: loop", late["worker_messages"])
        self.assertTrue(late["last_pass"])
        self.ends_well(out)

    # Before any point, in the making of view samples: another process tries again.
    def test_faults_between_points_cost_none(self):
        for how in ("lost", "abort"):
            with self.subTest(how):
                result, out, points = self.faulted(how, 3)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual({p["status"] for p in points.values()}, {"ok"})
                self.assertEqual(sweep.outcome(out), self.calm)


if __name__ == "__main__":
    unittest.main()
