"""scripts/reproduce: cells, verdicts and pages of made-up results; and what it refuses."""
import copy
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from synthetic import SCENES, SOURCE, grid, paper_of, point, steady, table
from reproducing import cells, claims, page, paper, reading, runs


def curve(scene, times, spread=0.01, **more):
    return [point(scene, steady(t, spread), mask_size=k, **more) for k, t in zip((4, 8, 16, 32), times)]


def verdict(claim, points, **keys):
    return claims.judge(grid(table(**keys), points), {"id": "x", "text": "x", **claim})


class Cells(unittest.TestCase):
    def test_a_frame_rate_is_of_the_median_and_its_interval_covers_it(self):
        g = grid(table(), curve("bunny", (10, 20, 40, 80)))
        cell = g.cell(g.series[0], g.rows[0], g.columns[1])
        self.assertAlmostEqual(cell.value, 50)
        low, high = cell.interval()
        self.assertLess(low, 50)
        self.assertGreater(high, 50)
        self.assertLess(high - low, 1)

    def test_times_are_averaged_over_cameras_before_they_become_rates(self):
        points = [point("bunny", [10], mask_size=4, camera="front"), point("bunny", [30], mask_size=4, camera="low")]
        g = grid(table(average_over=["camera"]), points)
        self.assertAlmostEqual(g.cell(g.series[0], g.rows[0], g.columns[0]).value, 50)
        g = grid(table(), points)
        self.assertIn("differ in camera", g.cell(g.series[0], g.rows[0], g.columns[0]).reason)

    def test_what_failed_or_is_missing_has_its_reason(self):
        g = grid(table(rows=["a", "b", "c"]), [point("bunny", mask_size=4, status="unsupported")])
        reasons = [g.cell(g.series[0], row, g.columns[0]).reason for row in g.rows]
        self.assertEqual(reasons, ["unsupported: a reason", "not run", "no scene of ours"])

    def test_a_smaller_run_is_found_by_its_full_values(self):
        t = table(columns={"axis": "resolution", "values": [256, 512]})
        g = grid(t, [point("bunny", [5], resolution=[128, 128])], runs.Mode("short", {"resolution": 0.25}))
        self.assertAlmostEqual(g.cell(g.series[0], g.rows[0], g.columns[1]).value, 200)

    def test_ratio_and_best(self):
        t = table(columns=[{"id": "g", "where": {"technique": "gears"}}, {"id": "r", "where": {"technique": "ray_tracing"}, "best_over": ["q"]},
                           {"id": "x", "ratio": ["g", "r"]}])
        g = grid(t, [point("bunny", [10])] + [point("bunny", [ms], "ray_tracing", q=q) for q, ms in (("low", 70), ("high", 50))])
        self.assertAlmostEqual(g.cell(g.series[0], g.rows[0], g.columns[2]).value, 5)

    def test_equal_time_lies_between_measured_values(self):
        t = table(columns=[{"id": "rays", "where": {"technique": "ray_tracing"},
                            "equal": {"vary": "mask_size", "figure": "timing.frame_ms", "to": {"technique": "gears"}}}])
        rays = [point("bunny", [k * k * 0.5], "ray_tracing", mask_size=k) for k in (2, 4, 8)]
        g = grid(t, rays + [point("bunny", [16], mask_size=16)])
        self.assertAlmostEqual(g.cell(g.series[0], g.rows[0], g.columns[0]).value, 32)  # 0.5 ms a ray, exactly a power law
        g = grid(t, rays + [point("bunny", [100], mask_size=16)])
        self.assertIn("not between the measured 2 and 32", g.cell(g.series[0], g.rows[0], g.columns[0]).reason)


class Verdicts(unittest.TestCase):
    FALLS = {"kind": "trend", "along": "columns", "direction": "falls", "min": 0.9}

    def test_trend(self):
        falling, rising = curve("bunny", (10, 20, 40, 80)), curve("dragon", (80, 40, 20, 10))
        self.assertEqual(verdict(self.FALLS, falling).verdict, claims.HOLDS)
        self.assertEqual(verdict(self.FALLS, rising).verdict, claims.FAILS)
        both = verdict(self.FALLS, falling + rising)
        self.assertEqual((both.verdict, both.summary()), (claims.PART, "holds in 1 of 2"))
        self.assertEqual(verdict(self.FALLS, []).verdict, claims.MISSING)

    def test_noise_that_hides_a_trend_leaves_it_undecided(self):
        noisy = [point("bunny", [90, 100, 101, 110, 200], mask_size=k) for k in (4, 8, 16, 32)]
        self.assertIn(verdict(self.FALLS, noisy).verdict, (claims.OPEN, claims.FAILS))
        near = curve("bunny", (100, 101, 102, 103), spread=0.2)
        self.assertEqual(verdict(self.FALLS, near).verdict, claims.OPEN)

    def test_slope_is_the_exponent(self):
        reported = [{"source": "s", "place": "t", "rows": {"a": [80, 40, 20, 10]}}]
        claim = {"kind": "slope", "along": "columns", "fit": "power", "within": 1.5}
        result = verdict(claim, curve("bunny", (10, 20, 40, 80)), reported=reported)
        self.assertAlmostEqual(result.lines[0].paper, -1)
        self.assertAlmostEqual(result.lines[0].ours, -1, 3)
        self.assertEqual(result.verdict, claims.HOLDS)
        self.assertEqual(verdict(claim, curve("bunny", (10, 40, 160, 640)), reported=reported).verdict, claims.FAILS)

    def test_rank(self):
        rows = {"a": [40, 30, 20, 10], "b": [80, 60, 45, 35]}
        reported, claim = [{"source": "s", "place": "t", "rows": rows}], {"kind": "rank", "min": 0.5}
        same = [p for s, r in (("bunny", "a"), ("dragon", "b")) for p in curve(s, [1000 / v for v in rows[r]])]
        self.assertEqual(verdict(claim, same, reported=reported).verdict, claims.HOLDS)
        turned = [p for s, r in (("bunny", "a"), ("dragon", "b")) for p in curve(s, rows[r])]
        self.assertEqual(verdict(claim, turned, reported=reported).verdict, claims.FAILS)

    def test_ratio_and_bound(self):
        points = curve("bunny", (10, 20, 40, 80))
        ratio = {"kind": "ratio", "of": [{"column": "4"}, {"column": "32"}]}
        self.assertEqual(verdict({**ratio, "at_least": 7}, points).verdict, claims.HOLDS)
        self.assertEqual(verdict({**ratio, "at_most": 7}, points).verdict, claims.FAILS)
        self.assertEqual(verdict({**ratio, "at_least": 8}, points).verdict, claims.OPEN)  # it is 8, with noise
        self.assertEqual(verdict({"kind": "bound", "cell": {"column": "4"}, "at_least": 99, "at_most": 102}, points).verdict, claims.HOLDS)

    def test_optimum(self):
        reported = [{"source": "s", "place": "t", "rows": {"a": [10, 30, 20, 10]}}]
        claim = {"kind": "optimum", "along": "columns", "best": "highest"}
        self.assertEqual(verdict(claim, curve("bunny", (40, 20, 30, 50)), reported=reported).verdict, claims.HOLDS)
        self.assertEqual(verdict(claim, curve("bunny", (40, 30, 20, 50)), reported=reported).verdict, claims.FAILS)
        self.assertEqual(verdict({**claim, "within": 1}, curve("bunny", (40, 30, 20, 50)), reported=reported).verdict, claims.HOLDS)
        self.assertEqual(verdict(claim, curve("bunny", (40, 20, 20.01, 50)), reported=reported).verdict, claims.OPEN)

    def test_why_is_told_only_of_what_does_not_hold_and_only_with_its_figure(self):
        why = {"text": "It is {x:.0f}.", "figures": {"x": {"row": "a", "column": "32"}}}
        self.assertEqual(verdict({**self.FALLS, "why": why}, curve("bunny", (10, 20, 40, 80))).why, "")
        self.assertEqual(verdict({**self.FALLS, "why": why}, curve("bunny", (80, 40, 20, 10))).why, "It is 100.")
        self.assertIn("was not measured", verdict({**self.FALLS, "why": why}, curve("bunny", (80, 40, 20))).why)


class Pages(unittest.TestCase):
    def test_a_page_stands_alone_is_well_formed_and_the_same_again(self):
        t = table(reported=[{"source": "s", "place": "table <1>", "rows": {"a": [40, 30, 20, None]}}], claims=[{"id": "f", "text": "It <falls>.", **Verdicts.FALLS}])
        run = {"cpu": {"model": "<cpu>", "usable_cores": 2}, "vulkan": {"name": "n", "driver": "d", "driver_version": "1"}, "embree": "3", "clock": "c",
               "program": {"version": "1", "commit": "c", "compiler": "g", "build_type": "R"}, "load": [9, 1, 1], "started": "s", "scenes": []}
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            (out / "t").mkdir()
            (out / "t" / "results.json").write_text(json.dumps({"run": run, "points": curve("bunny", (10, 20, 40, 80))}))
            planned = [runs.Run(SOURCE / "t.json", runs.Mode(), out / "t", ["t"], {}, "")]
            path, measured = page.write(paper_of(t), planned, "full", out)
            text = path.read_text(encoding="utf-8")
            self.assertTrue(measured)
            self.assertEqual(re.findall(r'(?:src|href)="(?!#|data:)[^"]*"', text), [])
            self.assertIn("It &lt;falls&gt;.", text)
            self.assertIn("The machine was busy", text)
            self.assertNotIn("<cpu>", text)
            page.write(paper_of(t), planned, "full", out)
            self.assertEqual(path.read_text(encoding="utf-8"), text)
            self.assertEqual(json.loads((out / "summary.json").read_text())["tables"][0]["claims"][0]["verdict"], "holds")


class Refusals(unittest.TestCase):
    """paper.json is held to its grammar: file, line, place, what was found and what was expected."""

    def setUp(self):
        self.good = json.loads(json.dumps(paper.load("gears").data))
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        for config in (SOURCE / "configs/papers/gears").glob("*.json"):
            (pathlib.Path(self.folder.name) / config.name).write_bytes(config.read_bytes())

    def message(self, change):
        data = copy.deepcopy(self.good)
        change(data)
        path = pathlib.Path(self.folder.name) / "paper.json"
        path.write_text(json.dumps(data, indent=1), encoding="utf-8")
        with self.assertRaises(reading.BadInput) as raised:
            paper.read_paper(path)
        self.assertRegex(str(raised.exception), r"paper\.json:\d+:\d+: /")
        return str(raised.exception)

    def test_wrong_papers(self):
        first = lambda d: d["tables"][0]
        for change, says in (
            (lambda d: first(d).update(titel="x"), "Did you mean 'title'?"),
            (lambda d: d.pop("scenes"), "'scenes' is missing"),
            (lambda d: d.update(key="GEAR"), "Did you mean 'GEARS'?"),
            (lambda d: d["scenes"]["chess"].update(scene="ches"), "Did you mean 'chess'?"),
            (lambda d: first(d).update(config="tabel1.json"), "Did you mean 'table1.json'?"),
            (lambda d: first(d)["rows"].append("dragoon"), "Did you mean 'dragon'?"),
            (lambda d: first(d)["rows"].append("dragon"), "stands here twice"),
            (lambda d: first(d)["reported"][0]["rows"]["dragon"].pop(), "found 3 figures, expected 4"),
            (lambda d: first(d)["reported"][0]["rows"]["dragon"].__setitem__(0, "51"), "expected a number or null"),
            (lambda d: first(d)["claims"][0].update(kind="trent"), "Did you mean 'trend'?"),
            (lambda d: first(d)["claims"][0].pop("along"), "needs 'along'"),
            (lambda d: first(d)["claims"][0].update(series="cluster"), "Did you mean 'clusters'?"),
            (lambda d: first(d)["claims"][0].update(at_least=1), "has no 'at_least'"),
            (lambda d: first(d)["claims"][0].update(why={"text": "{y}", "figures": {"x": {"row": "dragon", "column": "256"}}}), "unknown figure 'y'"),
            (lambda d: first(d)["claims"][0].update(why={"text": "x", "figures": {}}), "at least one measured figure"),
        ):
            with self.subTest(says):
                self.assertIn(says, self.message(change))

    def test_broken_text_is_refused_at_its_place(self):
        path = pathlib.Path(self.folder.name) / "paper.json"
        for text, says in (('{"a": 1,}', "a comma before the end"), ('{\n "a": 1,\n "a": 2}', ":3:2: /a: this key"), ('{"a": tru}', "expected a JSON value"),
                           ("{} {}", "more text after"), ('{"a" 1}', "expected ':'")):
            path.write_text(text, encoding="utf-8")
            with self.subTest(text), self.assertRaises(reading.BadInput) as raised:
                reading.read_nodes(path)
            self.assertIn(says, str(raised.exception))

    def test_the_committed_schema_is_the_grammar(self):
        committed = (SOURCE / "configs/schema/paper.schema.json").read_text(encoding="utf-8")
        self.assertEqual(committed, json.dumps(paper.schema(), indent=2) + "\n",
                         "renew it: scripts/reproduce --schema > configs/schema/paper.schema.json")

    def test_the_script_refuses_unknown_names(self):
        for arguments, says in ((["gaers"], "Did you mean 'gears'?"), (["gears", "tabel1"], "Did you mean 'table1'?"), (["all", "table1"], "expected one paper")):
            result = subprocess.run([SOURCE / "scripts/reproduce", *arguments], capture_output=True, text=True, check=False, env=os.environ)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(says, result.stderr)


if __name__ == "__main__":
    unittest.main()
