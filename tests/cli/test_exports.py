"""Shards that become one run, what a run is exported to, and completion: each read by the tool that it is for."""
import csv
import io
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from program import PROGRAM, Folder, penumbra

CONFIG = {"name": "two", "scene": ["torus_knot", "columns"], "resolution": 32, "mask_size": [2, 4],
          "techniques": ["ray_tracing", {"technique": "shadow_map", "params": {"pcf_kernel": [1, 3]}}, "planar_shadow"],
          "images": ["visibility"], "reference": {"light_samples": 16},
          "measure": {"warmup": 0, "repetitions": 5, "min_time_s": 0, "max_time_s": 5}}


def results(folder):
    return json.loads((folder / "results.json").read_text(encoding="utf-8"))


def without_times(point):
    kept = {k: v for k, v in point.items() if k not in ("timing", "memory", "load", "other_programs", "machine", "command")}
    return json.dumps(kept, sort_keys=True)


class OfOneRun(Folder):
    """One small sweep, whole and in two shards, shared by all tests."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.base = pathlib.Path(folder.name)
        cls.config = cls.base / "two.json"
        cls.config.write_text(json.dumps(CONFIG), encoding="utf-8")
        cls.run_folder = cls.sweep("whole")
        cls.shards = [cls.sweep(f"shard{i}", "--shard", f"{i}/2") for i in (1, 2)]

    @classmethod
    def sweep(cls, name, *arguments):
        out = cls.base / name
        result = penumbra("run", cls.config, "--out", out, "--quiet", "--no-report", *arguments)
        assert result.returncode == 0, result.stderr
        return out

    def merged(self):
        out = self.folder / "merged"
        result = penumbra("merge", *self.shards, "--out", out, "--no-report")
        self.assertEqual(result.returncode, 0, result.stderr)
        return out

    def test_merged_shards_equal_the_whole_run(self):
        whole, joined = results(self.run_folder), results(self.merged())
        self.assertGreater(len(whole["points"]), 6)
        self.assertTrue(all(results(s)["points"] for s in self.shards))
        self.assertEqual(sorted(map(without_times, whole["points"])), sorted(map(without_times, joined["points"])))
        machine = {p["machine"] for p in joined["points"]}
        self.assertEqual(machine, set(joined["run"]["machines"]))
        self.assertEqual(len(joined["run"]["merged"]), 2)

    def test_a_merged_run_is_a_run(self):
        out = self.merged()
        for point in results(out)["points"]:
            for path in point.get("images", {}).values():
                self.assertTrue((out / path).is_file(), path)
        everything = self.write("t.json", {"thresholds": [
            {"metric": "metrics.*", "max_increase": 0}, {"metric": "metrics_matched.*", "max_increase": 0}]})
        self.assertEqual(penumbra("compare", self.run_folder, out, "--thresholds", everything).returncode, 0)
        self.accepted("baseline", "update", out, "--dir", self.folder / "baselines")
        self.assertEqual(penumbra("report", out, "-o", self.folder / "report").returncode, 0)

    def test_what_is_no_complete_set_of_shards_is_refused(self):
        self.refused("merge", self.shards[0], "--out", self.folder / "a", says=["missing: 2"])
        self.refused("merge", *self.shards, self.run_folder, "--out", self.folder / "a", says=["the point "])
        self.refused("merge", *self.shards, "--out", self.run_folder, says=["already holds results"])
        self.refused("merge", *self.shards, "--out", "/proc/nowhere", code=4)
        other = self.folder / "other"
        shutil.copytree(self.shards[1], other)
        run = json.loads((other / "run.json").read_text(encoding="utf-8"))
        run["config"]["seed"] = 7
        (other / "run.json").write_text(json.dumps(run), encoding="utf-8")
        self.refused("merge", self.shards[0], other, "--out", self.folder / "a", says=["config/seed: 1 against 7"])
        self.refused("baseline", "update", self.shards[0], "--dir", self.folder, says=["merge"])

    def export(self, name, *arguments):
        path = self.folder / name
        self.accepted("export", self.run_folder, *arguments, "-o", path)
        return path

    def test_csv_has_a_row_for_each_point(self):
        rows = list(csv.DictReader(io.StringIO(self.accepted("export", self.run_folder, "--format", "csv"))))
        self.assertEqual(sorted(r["id"] for r in rows), sorted(p["id"] for p in results(self.run_folder)["points"]))

    def test_google_benchmarks_own_tool_reads_its_export_and_sees_a_slowdown(self):
        tool = pathlib.Path("/usr/share/benchmark/compare.py")
        self.assertTrue(tool.is_file(), "package libbenchmark-tools")
        before = self.export("a.json", "--format", "google-benchmark")
        slower = json.loads(before.read_text(encoding="utf-8"))
        for entry in slower["benchmarks"]:
            entry["real_time"] *= 2
        after = self.write("b.json", slower)
        out = self.folder / "diff.json"
        result = subprocess.run(["/usr/bin/python3", tool, "--dump_to_json", out, "benchmarks", before, after],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        differences = json.loads(out.read_text(encoding="utf-8"))
        ok = [p for p in results(self.run_folder)["points"] if p["status"] == "ok"]
        found = {d["name"] for d in differences if d["measurements"]}
        self.assertEqual(found - {"OVERALL_GEOMEAN"}, {p["key"] for p in ok})
        for difference in differences:
            for measurement in difference["measurements"]:
                self.assertAlmostEqual(measurement["time"], 1, places=6)

    def test_latex_compiles(self):
        latex = shutil.which("pdflatex")
        self.assertTrue(latex, "packages texlive-latex-recommended and texlive-pictures")
        for name in ("latex", "pgfplots"):
            path = self.export(f"{name}.tex", "--format", name, "--standalone")
            result = subprocess.run([latex, "-interaction=nonstopmode", "-halt-on-error", path.name], cwd=self.folder,
                                    capture_output=True, text=True, check=False, timeout=120)
            self.assertEqual(result.returncode, 0, result.stdout[-3000:])
            text = subprocess.run(["pdftotext", "-layout", f"{name}.pdf", "-"], cwd=self.folder, capture_output=True,
                                  text=True, check=True).stdout
            self.assertIn("shadow", text)
            self.assertIn("columns", text)

    def test_fragments_are_what_documents_hold(self):
        for name in ("latex", "pgfplots"):
            self.assertIn(self.accepted("export", self.run_folder, "--format", name),
                          self.accepted("export", self.run_folder, "--format", name, "--standalone"))

    def test_provenance_names_what_a_reader_needs(self):
        text, run = self.accepted("export", self.run_folder, "--format", "provenance"), results(self.run_folder)["run"]
        for part in (run["program"]["version"], run["cpu"]["model"], run["vulkan"]["name"], run["embree"], "@software"):
            self.assertIn(part, text)
        self.assertNotIn("unknown", text)

    def test_unknown_formats_name_the_nearest(self):
        self.refused("export", self.run_folder, "--format", "latx", says=["'latex'"])
        self.refused("export", self.run_folder, "--format", "csv", "--standalone", says=["--standalone"])


class Completion(Folder):
    def bash(self, *words):
        script = f"""eval "$('{PROGRAM}' completion bash)"; COMP_WORDS=('{PROGRAM}' {' '.join(map(repr, words))})
COMP_CWORD={len(words)}; _penumbra; printf '%s\\n' "${{COMPREPLY[@]}}" """
        result = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
        self.assertEqual(result.stderr, "")
        return result.stdout.split()

    def test_bash_completes_commands_options_and_names(self):
        self.assertEqual(self.bash("comp"), ["compare", "completion"])
        self.assertIn("--any-machine", self.bash("compare", "--a"))
        self.assertIn("--device", self.bash("run", "--dev"))
        self.assertEqual(self.bash("render", "bird"), ["bird_nest"])
        self.assertEqual(self.bash("describe", "ray_t"), ["ray_tracing"])
        self.assertEqual(self.bash("baseline", "u"), ["update"])
        self.assertIn("quick", self.bash("run", "qui"))
        self.assertNotIn("worker", self.bash(""))

    def test_fish_completes_commands_options_and_names(self):
        script = self.write("penumbra.fish", self.accepted("completion", "fish"))

        def fish(line):
            result = subprocess.run(["fish", "--no-config", "-c", f"source {script}; complete -C {line!r}"], capture_output=True,
                                    text=True, check=True, env=self.with_program)
            return [candidate.split("\t")[0] for candidate in result.stdout.splitlines()]
        self.assertEqual(fish("penumbra comp"), ["compare", "completion"])
        self.assertEqual(fish("penumbra run --dev"), ["--device"])
        self.assertEqual(fish("penumbra render bird"), ["bird_nest"])
        self.assertEqual(fish("penumbra baseline u"), ["update"])

    # The functions that zsh's completion system has, made to print what they are given.
    ZSH = """compdef() { }
_describe() { print -l -- ${${(P)2}%%:*} }
compadd() { print -l -- "${@[$(( ${@[(i)--]} + 1 )),-1]}" }
_files() { print -- FILES }
source %s
typeset -a words=(penumbra %s)
CURRENT=$#words
_penumbra
"""

    def test_zsh_offers_commands_options_and_names(self):
        script = self.write("penumbra.zsh", self.accepted("completion", "zsh"))

        def zsh(words):
            return subprocess.run(["zsh", "-f", "-c", self.ZSH % (script, words)], capture_output=True, text=True, check=True,
                                  env=self.with_program).stdout.split()
        self.assertIn("compare", zsh("comp"))
        self.assertIn("--device", zsh("run --dev"))
        self.assertEqual({"torus_knot", "bunny"} - set(zsh("render torus")), set())
        self.assertEqual(zsh("baseline u"), ["update", "FILES"])

    @property
    def with_program(self):
        return dict(os.environ, PATH=f"{pathlib.Path(PROGRAM).parent}:{os.environ['PATH']}", HOME=str(self.folder))

    def test_every_command_is_in_every_script(self):
        commands = self.bash("")
        self.assertGreater(len(commands), 10)
        for shell in ("bash", "zsh", "fish"):
            text = self.accepted("completion", shell)
            for command in commands:
                self.assertIn(command, text)
            subprocess.run([shell, "-n", self.write(shell, text)], check=True)
        self.refused("completion", "fih", says=["'fish'"])


if __name__ == "__main__":
    unittest.main()
