"""`penumbra run` as a user meets it: plans, results, interrupts, resuming."""
import json
import os
import pty
import signal
import subprocess
import time
import unittest

from program import PROGRAM, TINY, Folder, penumbra


class Runs(Folder):
    def test_a_dry_run_prints_the_plan_and_writes_nothing(self):
        config = self.write("tiny.json", TINY)
        result = penumbra("run", "--set", "/seed=2", config, "--dry-run", cwd=self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.count("ray_tracing/torus_knot/"), 2)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["tiny.json"])

    def test_a_run_gives_a_result_for_each_point_and_a_command_that_makes_it_again(self):
        out = self.folder / "out"
        result = penumbra("run", self.write("tiny.json", TINY), "--out", out, "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        points = json.loads((out / "results.json").read_text(encoding="utf-8"))["points"]
        self.assertEqual([p["status"] for p in points], ["ok", "ok"])
        command = points[1]["command"].replace("penumbra run", f"'{PROGRAM}' run", 1)
        again = subprocess.run(command + " --dry-run", shell=True, capture_output=True, text=True, check=False)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(again.stdout.count("ray_tracing/torus_knot/"), 1)
        self.assertIn(points[1]["id"], again.stdout)

    def test_results_that_cannot_be_written_are_exit_code_4(self):
        config = self.write("tiny.json", TINY)
        self.refused("run", config, "--out", config / "below", code=4, says=["tiny.json"])
        self.refused("run", config, "--out", "/proc/nowhere", code=4, says=["/proc/nowhere"])

    def test_bad_input_runs_and_writes_nothing(self):
        out = self.folder / "out"
        for change in ({"resolution": 0}, {"resolution": 100000}, {"scene": "nowhere"}, {"mask_sise": 4}):
            self.refused("run", self.write("bad.json", dict(TINY, **change)), "--out", out, says=["bad.json:1:"])
        self.refused("run", self.write("tiny.json", TINY), "--out", out, "--filter", "gears", says=["--filter"])
        self.refused("run", self.folder / "tiny.json", "--out", out, "--set", "mask_size=4", says=["--set"])
        self.assertFalse(out.exists())

    def test_progress_is_shown_on_a_terminal_alone(self):
        config = self.write("tiny.json", TINY)
        ours, terminal = pty.openpty()
        process = subprocess.Popen([PROGRAM, "run", str(config), "--out", str(self.folder / "a"), "--no-report"],
                                   stdout=subprocess.DEVNULL, stderr=terminal)
        os.close(terminal)
        shown = b""
        try:
            while piece := os.read(ours, 4096):
                shown += piece
        except OSError:  # how the end of a terminal is told
            pass
        os.close(ours)
        self.assertEqual(process.wait(timeout=60), 0, shown)
        self.assertRegex(shown.decode(), r"\[[#.]{20}\] [0-2]/2  about .+ left  ")
        self.assertTrue(shown.endswith(b"\x1b[2K"), "the line is wiped at the end")
        quiet = penumbra("run", config, "--out", self.folder / "b", "--no-report")
        self.assertEqual((quiet.returncode, quiet.stderr), (0, ""))

    def test_resume_with_a_filter_keeps_the_other_points(self):
        config, out = self.write("two.json", dict(TINY, mask_size=[2, 3])), self.folder / "out"

        def points():
            return {p["id"]: p for p in json.loads((out / "results.json").read_text(encoding="utf-8"))["points"]}
        self.assertEqual(penumbra("run", config, "--out", out, "--no-report").returncode, 0)
        first = points()
        result = penumbra("run", config, "--out", out, "--no-report", "--resume", "--filter", "mask_size=3,")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(points(), first)
        self.assertEqual(len((out / "results.csv").read_text(encoding="utf-8").splitlines()), 3)
        # A run of its own with a filter has that filter's points alone.
        penumbra("run", config, "--out", self.folder / "own", "--no-report", "--filter", "mask_size=3,")
        own = json.loads((self.folder / "own" / "results.json").read_text(encoding="utf-8"))
        self.assertEqual((len(own["points"]), own["run"]["points"]), (1, 1))

    def test_an_interrupt_keeps_what_is_done_and_resume_goes_on(self):
        config, out = self.write("long.json", dict(TINY, mask_size=list(range(1, 41)))), self.folder / "out"
        process = subprocess.Popen([PROGRAM, "run", str(config), "--out", str(out), "--no-report"], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        journal = out / "points.jsonl"
        while not journal.exists() or journal.stat().st_size == 0:
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        text, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("interrupted, --resume goes on", text)
        kept = json.loads((out / "results.json").read_text(encoding="utf-8"))["points"]
        self.assertTrue(0 < len(kept) < 40, len(kept))
        result = penumbra("run", config, "--out", out, "--no-report", "--resume")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"40 ok; {len(kept)} of them kept from before", result.stdout)

    def test_no_driver_is_exit_code_3(self):
        nowhere = str(self.folder / "none.json")
        result = penumbra("run", self.write("tiny.json", TINY), "--out", self.folder / "out",
                          env={"VK_ICD_FILENAMES": nowhere, "VK_DRIVER_FILES": nowhere})
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    unittest.main()
