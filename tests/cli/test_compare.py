"""Comparing runs and renewing baselines, as a user or a CI server meets them."""
import json
import unittest
import xml.etree.ElementTree as ET

import schema_check
from program import PROGRAM, SOURCE, Folder, penumbra


def stat(times):
    return {"median": sorted(times)[len(times) // 2], "samples": times}


def point(technique, ms, rmse=0.01, scene="torus_knot"):
    return {"id": f"{technique}-{scene}", "key": f"{technique}/{scene}/mask_size=8", "technique": technique,
            "scene": scene, "frame": 0, "params": {"mask_size": 8}, "status": "ok", "message": "",
            "timing": {"frame_ms": stat([ms * (1 + 0.001 * i) for i in range(10)])}, "metrics": {"rmse": rmse},
            "metrics_matched": {"mask_bit_mismatch": 0}}


class Comparing(Folder):
    def run_of(self, name, points, **header):
        folder = self.folder / name
        folder.mkdir()
        run = {"schema_version": 1, "name": "made_up", "complete": True, "cpu": {"model": "A"}, **header}
        (folder / "run.json").write_text(json.dumps(run), encoding="utf-8")
        (folder / "points.jsonl").write_text("".join(json.dumps(p) + "\n" for p in points), encoding="utf-8")
        return folder

    def compared(self, before, after, *arguments):
        """Exit code, the comparison as JSON, and the JUnit tree."""
        junit = self.folder / "junit.xml"
        result = penumbra("compare", before, after, "--json", "--junit", junit, *arguments)
        self.assertNotIn("internal error", result.stderr)
        return result.returncode, json.loads(result.stdout), ET.parse(junit).getroot()

    def test_equal_runs_pass(self):
        run = self.run_of("a", [point("gears", 10)])
        code, result, junit = self.compared(run, run)
        self.assertEqual((code, result["bad"], junit.get("failures")), (0, False, "0"))
        self.assertGreater(int(junit.get("tests")), 2)

    def test_worse_and_slower_are_exit_code_1_and_stand_in_every_report(self):
        before = self.run_of("a", [point("gears", 10)])
        for name, changed in (("slow", point("gears", 12)), ("bad", point("gears", 10, rmse=0.02))):
            after = self.run_of(name, [changed])
            code, result, junit = self.compared(before, after)
            self.assertEqual((code, result["counts"]["regressed"], junit.get("failures")), (1, 1, "1"))
            self.assertEqual([f.get("type") for f in junit.iter("failure")], ["regressed"])
            self.assertIn("regressed", penumbra("compare", before, after).stdout)

    def test_a_point_that_is_gone_is_exit_code_1(self):
        before = self.run_of("a", [point("gears", 10), point("ray_tracing", 10)])
        code, result, _ = self.compared(before, self.run_of("b", [point("gears", 10)]))
        self.assertEqual((code, result["counts"]["missing"]), (1, 1))

    def test_nothing_to_compare_is_bad_input_and_still_reported(self):
        gears, other = self.run_of("a", [point("gears", 10)]), self.run_of("b", [point("ray_tracing", 10)])
        for after, says in ((other, "none of the points"), (self.run_of("c", []), "measured nothing")):
            code, result, junit = self.compared(gears, after)
            self.assertEqual((code, junit.get("errors")), (2, "1"))
            self.assertIn(says, result["error"])

    def test_thresholds_are_checked_before_anything_is_judged(self):
        run = self.run_of("a", [point("gears", 10)])
        for rule, says in (({"technique": "gaers", "metric": "metrics.rmse", "max": 1}, "'gears'"),
                           ({"scene": "torus_nkot", "metric": "metrics.rmse", "max": 1}, "'torus_knot'"),
                           ({"metric": "metrics.rsme", "max": 1}, "'metrics.rmse'"),
                           ({"metric": "metrics.rmse"}, "without a condition")):
            file = self.write("t.json", {"thresholds": [rule]})
            self.refused("compare", run, run, "--thresholds", file, says=["t.json:1:", says])

    def test_the_thresholds_of_the_contract_are_accepted_and_fit_the_schema(self):
        document = {"anchor": "ray_tracing", "thresholds": [
            {"technique": "*", "scene": "*", "metric": "metrics.rmse", "max": 0.02, "max_increase": 0.001},
            {"technique": "gears", "metric": "metrics_matched.mask_bit_mismatch", "max": 1e-5},
            {"technique": "gears", "params": {"mask_size": 16}, "metric": "timing.frame_ms", "max_ratio": 1.10}]}
        file = self.write("t.json", document)
        run = self.run_of("a", [point("gears", 10), point("ray_tracing", 20)])
        result = penumbra("compare", run, run, "--thresholds", file)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("t.json:1:", result.stdout)  # no point has mask_size 16: said
        schema = json.loads(self.accepted("describe", "--schema", "thresholds"))
        self.assertEqual(schema_check.errors(document, schema), [])
        for change in ({"anchor": 1}, {"thresholds": []}, {"thresholds": [{"metric": "metrics.rmse"}]},
                       {"thresholds": [{"metric": "metrics.rmse", "mx": 1}]}, {"significance": 0}):
            self.assertNotEqual(schema_check.errors(dict(document, **change), schema), [])

    def test_what_cannot_be_read_or_written_has_its_exit_code(self):
        run = self.run_of("a", [point("gears", 10)])
        self.refused("compare", run, self.folder / "none", says=["none"])
        self.refused("compare", "gaet", run, says=["'gate'"])
        result = penumbra("compare", run, run, "--junit", "/proc/nowhere.xml")
        self.assertEqual(result.returncode, 4)

    def test_times_of_another_machine_are_reported_and_not_judged(self):
        before = self.run_of("a", [point("gears", 10)])
        after = self.run_of("b", [point("gears", 30)], cpu={"model": "B"})
        code, result, _ = self.compared(before, after)
        self.assertEqual(code, 0)
        self.assertIn("machines differ", result["remarks"][0])
        self.assertEqual(self.compared(before, after, "--any-machine")[0], 1)

    def test_a_baseline_is_renewed_and_found_by_its_name(self):
        run, folder = self.run_of("a", [point("gears", 10)]), self.folder / "results" / "baselines"
        (self.folder / "configs").mkdir()
        self.accepted("baseline", "update", run, cwd=self.folder)
        self.assertEqual([p.name for p in folder.iterdir()], ["made_up.json"])
        self.assertEqual(penumbra("compare", "made_up", run, cwd=self.folder).returncode, 0)
        (folder / "made_up.thresholds.json").write_text(
            '{"thresholds": [{"metric": "metrics.rmse", "max": 0.001}]}', encoding="utf-8")
        self.assertEqual(penumbra("compare", "made_up", run, cwd=self.folder).returncode, 1)

    def test_no_baseline_is_made_of_a_run_with_holes(self):
        failed = dict(point("gears", 10), status="failed", message="why")
        for name, points, header in (("a", [failed], {}), ("b", [point("gears", 10)], {"complete": False}), ("c", [], {})):
            run = self.run_of(name, points, **header)
            self.refused("baseline", "update", run, "--dir", self.folder / "out")
        self.refused("baseline", "update", self.run_of("d", [point("gears", 1)]), "--name", "../x", says=["--name"])
        self.refused("baseline", "update", self.folder / "d", "--dir", "/proc/nowhere", code=4)
        self.assertFalse((self.folder / "out").exists())

    def test_committed_thresholds_fit_their_schema(self):
        schema = json.loads(self.accepted("describe", "--schema", "thresholds"))
        files = list((SOURCE / "results" / "baselines").glob("*.thresholds.json"))
        self.assertTrue(files)
        for path in files:
            self.assertEqual(schema_check.errors(schema_check.load(path), schema), [], path.name)


if __name__ == "__main__":
    assert PROGRAM
    unittest.main()
