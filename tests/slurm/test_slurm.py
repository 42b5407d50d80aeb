"""scripts/slurm against a real Slurm on loopback: an array over two nodes, one of which dies in the middle."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "fault"))
import cluster  # noqa: E402
import sweep  # noqa: E402

SOURCE = pathlib.Path(__file__).parents[2]
SUBMIT = SOURCE / "scripts" / "slurm" / "submit"


class Slurm(unittest.TestCase):
    def setUp(self):
        self.assertTrue(cluster.installed(), "packages slurm-wlm and munge")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.base = pathlib.Path(folder.name)
        (self.base / "slurm").mkdir()
        self.cluster = cluster.Cluster(self.base / "slurm")
        self.addCleanup(self.cluster.stop)
        self.cluster.start()
        self.env = {"PENUMBRA_PROGRAM": sweep.PROGRAM}

    def config(self, repetitions):
        # Four views a scene: points come one view after the other, so that a shard can be caught between two.
        config = dict(sweep.CONFIG, resolution=[24, 32, 40, 48],
                      measure=dict(sweep.CONFIG["measure"], repetitions=repetitions, max_time_s=60))
        path = self.base / "config.json"
        path.write_text(json.dumps(config), encoding="utf-8")
        return path

    def points(self, shard):
        journal = self.base / "out" / f"shard-{shard}" / "points.jsonl"
        return journal.read_text(encoding="utf-8").count("\n") if journal.exists() else 0

    def node_of(self, shard):
        for line in self.cluster.call("squeue", "-h", "-r", "-o", "%K %T %N").splitlines():
            parts = line.split()
            if parts[:2] == [str(shard), "RUNNING"]:
                return parts[2]
        return None

    def test_an_array_whose_node_dies_ends_as_an_undisturbed_run(self):
        config = self.config(repetitions=100)
        calm = sweep.run(config, self.base / "calm")
        self.assertEqual(calm.returncode, 0, calm.stderr)
        said = self.cluster.call(SUBMIT, config, self.base / "out", "2", env=self.env)
        self.assertRegex(said, r"array \d+, merge \d+")
        # Shard 1 has a point and is not done: its node dies with everything on it.
        total = len(sweep.outcome(self.base / "calm"))
        self.cluster.wait(lambda: self.points(1) >= 1, "the first point of shard 1", 60)
        node = self.node_of(1)
        self.assertIsNotNone(node, "shard 1 had ended before its node could die")
        self.cluster.kill_node(node)
        before = self.points(1)
        self.cluster.wait(lambda: not self.cluster.states()[node].startswith("alloc") and self.node_of(1) != node,
                          "Slurm to notice", 90)
        self.cluster.start_node(node)
        # Slurm holds back for two minutes what it takes back from a dead node.
        array = said.split()[1].rstrip(",")
        self.cluster.call("scontrol", "update", f"JobId={array}_1", "StartTime=now")
        merged = self.base / "out" / "merged" / "results.json"
        self.cluster.wait(merged.exists, "the merge", 150)
        self.assertEqual(sweep.outcome(self.base / "out" / "merged"), sweep.outcome(self.base / "calm"))
        self.assertGreater(self.points(1), before)
        self.assertEqual(self.points(1) + self.points(2), total)  # what was finished was not run again
        log = self.base / "out" / "log" / "merge.log"
        self.cluster.wait(lambda: f"{total} points of 2 runs" in log.read_text(encoding="utf-8"), "the merge's end", 60)

    def test_wrong_arguments_queue_nothing(self):
        bad = self.base / "bad.json"
        bad.write_text('{"scene": "nowhere"}', encoding="utf-8")
        env = {**self.cluster.env, **self.env}
        for arguments in ((bad, self.base / "o", "2"), (self.config(1), self.base / "o", "none"), ()):
            result = subprocess.run([SUBMIT, *map(str, arguments)], capture_output=True, text=True, check=False, env=env)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertTrue(result.stderr)
        self.assertEqual(self.cluster.call("squeue", "-h"), "")


if __name__ == "__main__":
    if os.geteuid() != 0:
        print("Slurm's daemons need root: skipped")
        sys.exit(77)
    unittest.main()
