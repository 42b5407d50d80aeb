"""scripts/new_technique: what it writes and edits in a checkout, and what it refuses."""
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["PENUMBRA_SOURCE"])
EDITED = ("techniques/CMakeLists.txt", "techniques/registry.cpp")


class NewTechnique(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        for name in EDITED:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, self.root / name)

    def call(self, *arguments):
        return subprocess.run([SOURCE / "scripts/new_technique", "--root", self.root, *arguments], capture_output=True, text=True, check=False)

    def changed_lines(self, name):
        before = (SOURCE / name).read_text(encoding="utf-8").split("\n")
        after = (self.root / name).read_text(encoding="utf-8").split("\n")
        return [line for line in after if line not in before], [line for line in before if line not in after]

    def test_the_room_is_whole_and_registered(self):
        result = self.call("edge_walk", "--title", "Edge walk")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.changed_lines(EDITED[1]), (['#include "techniques/edge_walk/edge_walk.h"', "      edge_walk_technique(),"], []))
        added, removed = self.changed_lines(EDITED[0])
        self.assertEqual((len(added), len(removed)), (1, 1))
        self.assertEqual(added[0], removed[0][:-1] + " edge_walk)")
        includes = [l for l in (self.root / EDITED[1]).read_text().split("\n") if l.startswith('#include "techniques/') and "registry" not in l]
        self.assertEqual(includes, sorted(includes))
        made = sorted(str(p.relative_to(self.root)) for p in self.root.rglob("*") if p.is_file() and str(p.relative_to(self.root)) not in EDITED)
        self.assertEqual(made, ["techniques/edge_walk/CMakeLists.txt", "techniques/edge_walk/README.md", "techniques/edge_walk/edge_walk.cpp",
                                "techniques/edge_walk/edge_walk.h", "techniques/edge_walk/params.cpp", "techniques/edge_walk/params.h",
                                "techniques/edge_walk/shaders/occlude.comp", "techniques/edge_walk/shaders/shared.h",
                                "tests/techniques/edge_walk_test.cpp"])
        for name in made:
            text = (self.root / name).read_text(encoding="utf-8")
            for mark in ("@name@", "@Name@", "@NAME@", "@title@"):
                self.assertNotIn(mark, text, name)

    def test_bad_names_change_nothing(self):
        for arguments, says in ((["Edge"], "expected snake_case"), (["common"], "is there already"), (["x", "--title", 'a"b'], "without quotes")):
            result = self.call(*arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn(says, result.stderr)
        self.assertEqual(self.call("edge_walk").returncode, 0)
        self.assertIn("is there already", self.call("edge_walk").stderr)
        for name in EDITED:
            self.assertLessEqual(len(self.changed_lines(name)[0]), 2)


if __name__ == "__main__":
    unittest.main()
