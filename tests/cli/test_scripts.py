"""scripts/equal, scripts/gate_quality and scripts/alternate."""
import importlib.machinery
import importlib.util
import json
import random
import subprocess
import unittest

from program import PROGRAM, SOURCE, Folder


def script(name):
    loader = importlib.machinery.SourceFileLoader(name, str(SOURCE / "scripts" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


def call(name, *arguments):
    return subprocess.run([SOURCE / "scripts" / name, *map(str, arguments)], capture_output=True, text=True, check=False,
                          timeout=200)


class Equal(Folder):
    def test_bisection_finds_the_last_value_within(self):
        bisect = script("equal").bisect
        for hi in (2, 3, 10, 1000):
            for limit in range(1, hi + 1):
                self.assertEqual(bisect(lambda v: v / limit, 1, hi, True)[0], limit)   # grows: the largest within
                self.assertEqual(bisect(lambda v: limit / v, 1, hi, False)[0], limit)  # falls: the smallest within
        self.assertIsNone(bisect(lambda v: 2, 1, 9, True)[0])
        self.assertLess(len(bisect(lambda v: v / 700, 1, 4096, True)[1]), 15)

    def test_an_error_is_met_by_the_smallest_mask_and_no_smaller(self):
        config = self.write("c.json", {"scene": "torus_knot", "resolution": 32, "techniques": ["ray_tracing"],
                                       "reference": {"light_samples": 64},
                                       "measure": {"warmup": 0, "repetitions": 1, "min_time_s": 0}})
        result = call("equal", config, "--technique", "ray_tracing", "--vary", "mask_size", "--range", 1, 8, "--error",
                      "metrics.rmse=0.04", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        row = json.loads(result.stdout)[0]
        tries = {int(k): v for k, v in row["tries"].items()}
        self.assertLessEqual(tries[row["value"]], 1)
        self.assertGreater(tries[row["value"] - 1], 1)
        self.assertLessEqual(row["ray_tracing"]["rmse"], 0.04)

    # The comparison of light samples at one frame rate: how many rays buy the time of the other technique.
    def test_equal_time_gives_frame_rate_mask_and_number_of_rays(self):
        config = self.write("c.json", {"scene": "torus_knot", "resolution": 32, "mask_size": 8,
                                       "techniques": ["ray_tracing", "gears"], "reference": {"light_samples": 0},
                                       "measure": {"warmup": 0, "repetitions": 3, "min_time_s": 0}})
        result = call("equal", config, "--technique", "ray_tracing", "--vary", "light_samples", "--range", 1, 4, "--time-of",
                      "gears")
        self.assertIn(result.returncode, (0, 1), result.stderr)  # 1: not even one ray is as fast
        head, row = result.stdout.splitlines()
        for column in ("scene", "fps", "light_samples of ray_tracing", "gears ms", "light samples of gears"):
            self.assertIn(column, head)
        self.assertRegex(row, r"^torus_knot +[0-9.]+  .* 8x8 = 64$")

    def test_wrong_arguments_are_refused(self):
        config = self.write("c.json", {"scene": "torus_knot"})
        for goal in (("--error", "metrics.rmse"), ("--range", 5, 5)):
            result = call("equal", config, "--technique", "x", "--vary", "mask_size", "--range", 1, 4, "--time-ms", 1, *goal)
            self.assertEqual(result.returncode, 2, result.stderr)


class GateQuality(Folder):
    """The design of the gate, with noise that is known: 3 % a sample, one sample in twenty half as long again."""

    def results(self, spread):
        rng = random.Random(4)

        def point(technique, ms):
            times = [ms * rng.lognormvariate(0, spread) * (1.5 if rng.random() < 0.05 else 1) for _ in range(40)]
            return {"id": technique, "key": technique, "technique": technique, "scene": "s", "frame": 0, "params": {},
                    "status": "ok", "timing": {name: {"median": ms, "samples": times} for name in ("frame_ms", "cpu_ms")}, "metrics": {"rmse": 0.01},
                    "metrics_matched": {"mask_bit_mismatch": 0}}
        points = [point(t, ms) for t, ms in (("ray_tracing", 30), ("gears", 20), ("shadow_map", 5), ("line_space", 9))]
        return self.write("results.json", {"schema_version": 1, "run": {}, "points": points})

    def test_it_finds_a_tenth_and_raises_no_false_alarm(self):
        result = call("gate_quality", "--pairs", 60, "resample", self.results(0.03))
        counts = json.loads(result.stdout)
        self.assertEqual(result.returncode, 0, counts)
        self.assertEqual((counts["pairs"], counts["flipped_bits"], counts["rmse"]), (60, 60, 60))

    def test_noise_that_hides_a_tenth_is_told(self):
        result = call("gate_quality", "--pairs", 10, "resample", self.results(0.4))
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertLess(json.loads(result.stdout)["slowdowns"], 9)

    def test_sides_take_turns(self):
        sides = script("gate_quality").sides
        a, b = sides(list(range(24)), False, random.Random(3))
        self.assertEqual([sorted(turn) for turn in zip(a, b)], [[i, i + 1] for i in range(0, 24, 2)])
        self.assertNotEqual(a, list(range(0, 24, 2)))
        self.assertEqual(sides([1, 2, 3, 4], True, random.Random(3)), ([1, 2], [3, 4]))


class Alternate(Folder):
    def test_two_programs_take_turns_and_are_compared(self):
        config = self.write("c.json", {"scene": "torus_knot", "resolution": 16, "mask_size": 2, "techniques": ["ray_tracing"],
                                       "reference": {"light_samples": 0}, "images": [],
                                       "measure": {"warmup": 0, "repetitions": 1, "min_time_s": 0}})
        thresholds = self.write("t.json", {"thresholds": [{"metric": "metrics_matched.mask_bit_mismatch", "max": 0}]})
        arguments = (PROGRAM, PROGRAM, config, "--out", self.folder / "turns", "--runs", 2, "--thresholds", thresholds)
        result = call("alternate", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        turns = [line.split(",")[0] for line in result.stderr.splitlines() if " of 2" in line]
        self.assertEqual([sorted(turns[:2]), sorted(turns[2:])], 2 * [["base", "current"]])
        self.assertEqual(sorted(p.name for p in (self.folder / "turns" / "base").iterdir()), ["run000", "run001"])
        # What is there stays: nothing runs again.
        again = call("alternate", *arguments)
        self.assertEqual((again.returncode, again.stdout), (0, result.stdout))
        self.assertNotIn(" of 2", again.stderr)

    def test_a_program_that_is_not_there_is_refused(self):
        result = call("alternate", "/no/penumbra", PROGRAM, "c.json", "--out", self.folder / "x")
        self.assertEqual(result.returncode, 2)
        self.assertIn("/no/penumbra: no such program", result.stderr)


if __name__ == "__main__":
    unittest.main()
