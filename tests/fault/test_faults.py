"""Disks that are full, folders that cannot be written, cache entries and results that are damaged."""
import json
import os
import pathlib
import resource
import shutil
import subprocess
import tempfile
import unittest

import sweep


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.base = pathlib.Path(folder.name)
        cls.config = sweep.write_config(cls.base)
        cls.cache = cls.base / "cache"
        cls.env = dict(os.environ, PENUMBRA_CACHE=str(cls.cache))
        result = sweep.run(cls.config, cls.base / "calm", env=cls.env)
        assert result.returncode == 0, result.stderr
        cls.calm = sweep.outcome(cls.base / "calm")

    def ends_well(self, out):
        """The sweep goes on and ends as if nothing had been."""
        result = sweep.run(self.config, out, resume=True, env=self.env)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sweep.outcome(out), self.calm)
        return result.stderr

    # No file can grow beyond a size: what a full disk does, at every moment that a size can name. A page is the least:
    # the worker's heartbeat is one.
    def test_a_disk_that_is_full_is_exit_code_4_and_loses_nothing(self):
        size = {p.name: p.stat().st_size for p in (self.base / "calm").iterdir() if p.is_file()}
        limits = {4096, size["run.json"] * 9 // 10, size["points.jsonl"] // 2, size["points.jsonl"] * 9 // 10,
                  size["results.json"] * 9 // 10}  # well below: sizes differ a little from run to run, with the times
        self.assertGreater(min(size["run.json"], size["points.jsonl"] // 2), 4096)
        for limit in sorted(limits):
            with self.subTest(limit):
                out = self.base / f"full{limit}"
                result = sweep.run(self.config, out, env=self.env, restore_signals=False,  # SIGXFSZ stays ignored
                                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assertIn("cannot be written", result.stderr)
                self.assertNotIn("internal error", result.stderr)
                self.ends_well(out)

    # A file system of its own that is too small: ENOSPC from the kernel, also for folders and renames, with the report.
    def test_a_real_disk_that_is_full_is_exit_code_4_and_loses_nothing(self):
        apart = ["unshare", "--map-root-user", "--mount"]
        out, copy = self.base / "disk", self.base / "disk_copy"
        out.mkdir()
        if subprocess.run([*apart, "mount", "-t", "tmpfs", "tmpfs", str(out)], capture_output=True, check=False).returncode:
            self.skipTest("this system lets nobody mount a file system; the limit on a file's size stands in for it")
        run = f"'{sweep.PROGRAM}' run '{self.config}' --out '{out}' --quiet"
        for size in ("8k", "24k", "100k", "200k", "320k"):
            script = (f"mount -t tmpfs -o size={size} tmpfs '{out}' && {run} >&2; echo $?; find '{out}' -name '*.tmp' -o -name '*.new';"
                      f" cat '{out}/run.json'; mount -o remount,size=64m '{out}' && {run} --resume --no-report >&2;"
                      f" cp -r '{out}' '{copy}'")
            with self.subTest(size):
                result = subprocess.run([*apart, "sh", "-c", script], capture_output=True, text=True, check=False,
                                        env=self.env, timeout=120)
                code, _, header = result.stdout.partition("\n")
                self.assertEqual(code, "4", result.stderr)
                self.assertIn("No space left on device", result.stderr)
                self.assertNotIn("internal error", result.stderr)
                if header:  # no name of an unfinished file stands before it, and it is whole
                    json.loads(header)
                self.assertEqual(sweep.outcome(copy), self.calm)
                shutil.rmtree(copy)

    def test_a_folder_that_is_read_only_is_exit_code_4(self):
        out = self.base / "readonly"
        out.mkdir()
        out.chmod(0o555)
        self.base.chmod(0o755)
        nobody = {"user": 65534} if os.geteuid() == 0 else {}  # root writes everywhere
        result = sweep.run(self.config, out, env=dict(self.env, HOME="/nonexistent"), **nobody)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertIn(str(out), result.stderr)

    def test_a_file_in_the_folders_place_is_exit_code_4(self):
        out = self.base / "file"
        out.write_text("no folder", encoding="utf-8")
        self.assertEqual(sweep.run(self.config, out, env=self.env).returncode, 4)

    def test_damaged_cache_entries_are_made_again(self):
        entries = [p for p in self.cache.rglob("*") if p.is_file()]
        self.assertTrue(entries)
        for i, damage in enumerate((lambda b: b[:len(b) // 2], lambda b: b"", lambda b: b[:-1] + bytes([b[-1] ^ 1]),
                                    lambda b: bytes([b[0] ^ 255]) + b[1:], lambda b: b + b"more")):
            for path in entries:
                path.write_bytes(damage(path.read_bytes()))
            out = self.base / f"cache{i}"
            result = sweep.run(self.config, out, env=self.env)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(sweep.outcome(out), self.calm, f"damage {i}")

    # Whole, with a good checksum, but of another view: a file that was renamed, or a disk that mixed two up.
    def test_a_cache_entry_of_another_reference_is_not_believed(self):
        result = sweep.run(self.config, self.base / "before-swap", env=self.env)
        self.assertEqual(result.returncode, 0, result.stderr)
        first, second, *_ = sorted(p for p in self.cache.rglob("*") if p.is_file())
        a, b = first.read_bytes(), second.read_bytes()
        self.assertEqual(len(a), len(b))
        self.assertNotEqual(a, b)
        first.write_bytes(b), second.write_bytes(a)
        result = sweep.run(self.config, self.base / "swapped", env=self.env)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sweep.outcome(self.base / "swapped"), self.calm)
        self.assertEqual({first.read_bytes(), second.read_bytes()}, {a, b})

    def test_a_journal_that_is_damaged_anywhere_is_mended(self):
        text = (self.base / "calm" / "points.jsonl").read_bytes()
        third = len(text) // 3
        for i, damaged in enumerate((text[:-7], text[:third] + b"\x00\xff{" + text[third + 3:], b"\n\n" + text, b"rubbish\n",
                                     text + text)):
            out = self.base / f"journal{i}"
            shutil.copytree(self.base / "calm", out)
            (out / "points.jsonl").write_bytes(damaged)
            messages = self.ends_well(out)
            if i == 0:
                self.assertRegex(messages, r"points.jsonl:\d+: the last line is torn")
            if i in (1, 3):
                self.assertRegex(messages, r"points.jsonl:\d+: not a point's record; ignored")

    def test_a_damaged_header_does_not_keep_a_sweep_from_going_on(self):
        out = self.base / "header"
        shutil.copytree(self.base / "calm", out)
        (out / "run.json").write_text("{ torn", encoding="utf-8")
        self.ends_well(out)

    def test_a_second_run_in_a_folder_is_refused_while_the_first_goes_on(self):
        out = self.base / "twice"
        first = subprocess.Popen(sweep.command(self.config, out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                 env=self.env)
        while not (out / "run.json").exists():
            self.assertIsNone(first.poll())
        second = sweep.run(self.config, out, resume=True, env=self.env)
        self.assertEqual(first.wait(), 0)
        self.assertEqual(second.returncode, 2, second.stderr)
        self.assertIn("another run", second.stderr)
        self.assertEqual(sweep.outcome(out), self.calm)


if __name__ == "__main__":
    unittest.main()
