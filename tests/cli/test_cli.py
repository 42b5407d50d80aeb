"""The program as a user meets it: exit codes, messages, what goes to which stream."""
import json
import struct
import unittest
import zlib

import schema_check
from program import SOURCE, TINY, Folder, penumbra


class Usage(Folder):
    def test_no_command_shows_the_help_and_is_wrong_usage(self):
        result = penumbra()
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        self.assertIn("Subcommands", result.stderr)

    def test_help_and_version_are_data(self):
        self.assertIn("Subcommands", self.accepted("--help"))
        self.assertRegex(self.accepted("--version"), r"^penumbra \d+\.\d+\.\d+")
        self.assertIn("--json", self.accepted("list", "--help"))

    def test_unknown_commands_and_options_name_the_nearest(self):
        self.refused("lits", says=["unknown command 'lits'", "'list'"])
        self.refused("list", "scenes", "--jsno", says=["unknown option '--jsno'", "'--json'"])
        self.refused("--treads", "2", "list", "scenes", says=["unknown option '--treads'", "'--threads'"])
        self.refused("list", "scens", says=["'scens'", "'scenes'"])
        self.refused("describe", "ray_traicng", says=["unknown technique 'ray_traicng'", "'ray_tracing'"])
        self.refused("list", "scenes", "more", says=["no further argument 'more'"])

    def test_missing_and_wrong_values_are_refused(self):
        self.refused("list")
        self.refused("describe")
        self.refused("validate")
        self.refused("metrics", "one.exr")
        self.refused("--threads", "0", "list", "scenes", says=["--threads"])
        self.refused("--threads", "many", "list", "scenes", says=["--threads"])

    def test_output_that_cannot_be_written_is_no_success(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            result = penumbra("list", "scenes", stdout=full)
        self.assertEqual(result.returncode, 4)
        self.assertIn("cannot be written", result.stderr)


class Listings(Folder):
    def test_lists_are_json_arrays_of_named_entries(self):
        for what in ("techniques", "scenes", "configs", "devices"):
            entries = json.loads(self.accepted("list", what, "--json"))
            self.assertTrue(entries, what)
            self.assertTrue(all(entry["name"] for entry in entries), what)

    def test_the_program_finds_its_files_from_any_folder(self):
        self.assertEqual(self.accepted("list", "scenes", cwd=self.folder), self.accepted("list", "scenes", cwd=SOURCE))

    def test_scenes_are_described(self):
        scene = json.loads(self.accepted("describe", "--scene", "columns", "--json"))
        self.assertEqual((scene["triangles"], scene["fidelity"], scene["animated"]), (840, "procedural", False))
        self.assertEqual([light["name"] for light in scene["lights"]], ["key", "lamp", "sun", "spot", "ball", "cloud"])
        self.assertEqual(scene["lights"][0]["sides"], [1.6, 1.6])
        self.assertEqual(scene["cameras"][0]["eye"], [2.0, 6.2, 7.8])
        self.assertEqual(scene["meshes"][0]["open_edges"], 18)
        self.assertIn("840 triangles", self.accepted("describe", "--scene", "columns"))
        self.refused("describe", "--scene", "colums", says=["unknown scene 'colums'", "'columns'"])

    def test_every_technique_is_described(self):
        for entry in json.loads(self.accepted("list", "techniques", "--json")):
            info = json.loads(self.accepted("describe", entry["name"], "--json"))
            self.assertTrue(info["title"] and info["sources"] and info["lights"])
            for parameter in info["parameters"]:
                self.assertTrue(parameter["help"], f"{entry['name']}: {parameter['name']}")
            self.assertIn(entry["name"], self.accepted("describe", entry["name"]))


class Devices(Folder):
    def test_doctor_names_the_device_and_judges_every_technique(self):
        report = json.loads(self.accepted("doctor", "--json"))
        self.assertTrue(report["device"]["name"])
        self.assertIn(report["clock"], ("timestamps", "submit_and_fence"))
        names = [entry["name"] for entry in json.loads(self.accepted("list", "techniques", "--json"))]
        self.assertEqual(sorted(report["techniques"]), sorted(names))
        self.assertIn(report["device"]["name"], self.accepted("doctor"))

    def test_a_device_that_is_not_there_is_exit_code_3(self):
        self.refused("doctor", "--device", "no such device", code=3, says=["no such device"])
        self.refused("doctor", "--device", "99", code=3)

    def test_no_driver_is_exit_code_3(self):
        nowhere = str(self.folder / "none.json")
        self.refused("doctor", code=3, env={"VK_ICD_FILENAMES": nowhere, "VK_DRIVER_FILES": nowhere})


class Validation(Folder):
    GOOD = {"scene": "torus_knot", "mask_size": [2, 4], "techniques": ["ray_tracing"]}

    def test_committed_configs_are_valid(self):
        # By their plans: `validate` loads every scene too, which the tests of scenes do once for all of them.
        self.assertIn(": ok, ", self.accepted("validate", "quick"))
        for name in [entry["name"] for entry in json.loads(self.accepted("list", "configs", "--json"))]:
            text = (SOURCE / "configs" / (name + ".json")).read_text(encoding="utf-8")
            with self.subTest(name):
                if "dragon" not in text:  # fetched apart
                    self.assertIn(" points, ", self.accepted("run", name, "--dry-run"))

    def test_a_good_config_is_counted(self):
        path = self.write("good.json", self.GOOD)
        self.assertEqual(self.accepted("validate", path), f"{path}: ok, 2 points, 1 scenes, 1 techniques\n")
        self.assertIn("3 points", self.accepted("validate", path, "--set", "/mask_size=[1,2,3]"))
        self.assertIn("1 points", self.accepted("validate", path, "--filter", "mask_size=4"))

    def test_every_wrong_file_of_a_call_is_told(self):
        good = self.write("good.json", self.GOOD)
        result = penumbra("validate", self.write("a.json", "[1,"), good, self.write("b.json", dict(self.GOOD, seed="x")))
        self.assertEqual(result.returncode, 2)
        self.assertIn("a.json:1:4:", result.stderr)
        self.assertIn("b.json:1:", result.stderr)
        self.assertIn("good.json: ok", result.stdout)

    def wrong(self, text, *says):
        self.refused("validate", self.write("wrong.json", text), says=["wrong.json:", *says])

    def test_wrong_json(self):
        self.wrong("", "empty file")
        self.wrong("{\n  \"scene\": \"bunny\"\n  \"seed\": 1\n}", ":3:3:", "expected ','")
        self.wrong("{\"scene\": bunny}", "found bunny")
        self.wrong("[" * 100000, "levels of nesting")
        self.wrong("\x00\x01\x02", "found")

    def test_wrong_keys_types_and_ranges(self):
        self.wrong(dict(self.GOOD, mask_sise=4), "/mask_sise", "'mask_size'")
        self.wrong(dict(self.GOOD, techniques=["gaers"]), "/techniques/0", "'gears'")
        self.wrong(dict(self.GOOD, techniques=[{"technique": "ray_tracing", "params": {"robus": True}}]),
                   "/techniques/0/params/robus", "'robust'")
        self.wrong(dict(self.GOOD, techniques=[{"technique": "ray_tracing", "params": {"robust": 1}}]), "true or false")
        self.wrong(dict(self.GOOD, mask_size="four"), "/mask_size", "\"four\"")
        self.wrong(dict(self.GOOD, resolution=[[0, 0]]), "found 0", "from 1 to 16384")
        self.wrong(dict(self.GOOD, resolution=[[100000, 100000]]), "found 100000", "from 1 to 16384")
        self.wrong(dict(self.GOOD, light="no_light"), "/light", "a light of the scene")
        self.wrong(dict(self.GOOD, camera="no_camera"), "/camera", "a camera of the scene")

    def test_missing_files(self):
        self.refused("validate", "quik", says=["quik", "'quick'"])
        self.refused("validate", self.folder / "none.json", says=["none.json"])
        self.wrong(dict(self.GOOD, scene="torus_nkot"), "/scene", "'torus_knot'")
        self.wrong(dict(self.GOOD, scene="./nowhere.json"), "no such scene file")

    def test_a_missing_mesh_is_told_before_anything_runs(self):
        scene = self.write("scene.json", {
            "name": "scene", "meshes": {"m": {"file": "no_such_mesh.obj"}}, "instances": [{"mesh": "m"}],
            "lights": [{"name": "key", "kind": "point", "center": [0, 3, 0]}],
            "cameras": [{"name": "front", "eye": [0, 2, 5], "target": [0, 0, 0]}]})
        self.wrong(dict(self.GOOD, scene=str(scene)), "scene.json:1:", "no_such_mesh.obj")


class BadScenes(Folder):
    """Meshes and lights that cannot be: told before anything runs, with the place in the scene, and no folder is made."""

    def scene(self, mesh, light="[0, 4, 0]", name="scene.json"):
        return self.write(name, f"""{{ "name": "scene",
  "meshes": {{ "m": {mesh} }},
  "instances": [{{"mesh": "m"}}],
  "lights": [{{"name": "key", "kind": "point", "center": {light}}}],
  "cameras": [{{"name": "front", "eye": [0, 2, 5], "target": [0, 0, 0]}}] }}""")

    def told(self, scene, *says):
        config, out = self.write("config.json", dict(TINY, scene=str(scene))), self.folder / "out"
        self.refused("run", config, "--out", out, says=["scene.json:", *says])
        self.refused("validate", config, says=["scene.json:", *says])
        self.refused("render", scene, "ray_tracing", "resolution=8", "-o", self.folder / "a.png", says=["scene.json:", *says])
        self.assertEqual(sorted(p.name for p in self.folder.glob("*") if p.suffix in ("", ".png")), [])

    def test_meshes_without_a_triangle_that_is_left(self):
        point = "v 1 2 3\nv 1 2 3\nv 1 2 3\n"
        for name, text, says in (
                ("empty.obj", "", "empty.obj: cannot be read as obj"),
                ("empty.ply", "", "empty.ply: cannot be read as ply"),
                ("point.obj", point + "f 1 2 3\n", "1 read, 0 with an index out of range, 0 with a corner that is not finite, 1 without"),
                ("points.obj", point, "points.obj"),
                ("nan.obj", "v nan 0 0\nv 1 nan 0\nv 0 0 nan\nf 1 2 3\n", "1 with a corner that is not finite"),
                ("rubbish.stl", "rubbish" * 30, "rubbish.stl"),
                ("rubbish.glb", "rubbish" * 30, "rubbish.glb"),
                ("huge.obj", "v 1e20 0 0\nv 0 1e20 0\nv 0 0 1\nf 1 2 3\n", "expected coordinates from -1000000000")):
            with self.subTest(name):
                self.write(name, text)
                self.told(self.scene(f'{{"file": "{name}"}}'), says)

    def test_the_place_in_the_scene_is_named(self):
        self.write("empty.obj", "")
        self.told(self.scene('{"file": "empty.obj"}'), "scene.json:2:20: /meshes/m: ", "empty.obj")

    def test_a_light_inside_geometry(self):
        self.told(self.scene('{"generator": "box"}', "[0.1, 0.5, 0]"), "/lights/0: ", "'key' lies inside the mesh 'm'")

    def test_every_bad_scene_of_a_sweep_is_told(self):
        self.write("empty.obj", ""), self.write("nan.obj", "v nan 0 0\nv 1 nan 0\nv 0 0 nan\nf 1 2 3\n")
        scenes = [str(self.scene(f'{{"file": "{name}.obj"}}', name=f"{name}.json")) for name in ("empty", "nan")]
        self.refused("validate", self.write("config.json", dict(TINY, scene=[*scenes, "torus_knot"])),
                     says=["empty.obj", "nan.obj"])

    def test_single_vertices_that_are_not_finite_are_left_out_and_told(self):
        self.write("hole.obj", "v nan 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 2 3 4\n")
        config, out = self.write("config.json", dict(TINY, scene=str(self.scene('{"file": "hole.obj"}')))), self.folder / "out"
        result = penumbra("run", config, "--out", out, "--quiet", "--no-report")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 of 2 triangles are left out: 1 with a corner that is not finite", result.stderr)
        mesh, = json.loads((out / "run.json").read_text(encoding="utf-8"))["scenes"][0]["meshes"]
        self.assertEqual((mesh["triangles_in"], mesh["dropped_not_finite"], mesh["dropped_index"], mesh["dropped_degenerate"],
                          mesh["duplicate_vertices"], mesh["open_edges"], mesh["non_manifold_edges"]), (2, 1, 0, 0, 0, 3, 0))


class Rendering(Folder):
    def test_a_picture_is_written_where_asked(self):
        picture = self.folder / "a.png"
        result = penumbra("render", "torus_knot", "ray_tracing", "resolution=32x24", "mask_size=2", "-o", picture)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(struct.unpack(">II", picture.read_bytes()[16:24]), (32, 24))

    def test_wrong_arguments_write_nothing(self):
        picture = self.folder / "a.png"
        for wrong in ("resolution=0", "resolution=100000x100000", "robust=maybe", "robus=true", "robust", "light=none"):
            self.refused("render", "torus_knot", "ray_tracing", wrong, "-o", picture)
        self.refused("render", "torus_nkot", "ray_tracing", "-o", picture, says=["'torus_knot'"])
        self.refused("render", "torus_knot", "ray_tracing", "-o", self.folder / "a.jpg", says=[".png"])
        self.assertFalse(picture.exists())

    def test_a_picture_that_cannot_be_written_is_exit_code_4(self):
        self.refused("render", "torus_knot", "ray_tracing", "resolution=8", "-o", "/proc/a.png", code=4)


class Metrics(Folder):
    def test_files_that_are_missing_or_no_pictures_are_refused(self):
        self.refused("metrics", self.folder / "a.exr", self.folder / "b.exr", says=["a.exr"])
        text = self.write("text.exr", "no picture")
        self.refused("metrics", text, text, says=["text.exr"])
        self.refused("metrics", self.folder, self.folder)


    def png(self, name, width, height, value):
        """A gray picture of one value."""
        def chunk(kind, data):
            body = kind + data
            return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
        rows = (b"\0" + bytes([value] * width)) * height
        path = self.folder / name
        path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
                         + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
        return path

    def test_black_against_white_is_an_error_of_one_and_equal_files_of_none(self):
        black, white = self.png("black.png", 16, 12, 0), self.png("white.png", 16, 12, 255)
        result = json.loads(self.accepted("metrics", black, white, "--json"))
        self.assertEqual((result["mae"], result["rmse"], result["max"], result["width"]), (1, 1, 1, 16))
        result = json.loads(self.accepted("metrics", white, white, "--json"))
        self.assertEqual((result["mae"], result["psnr"], result["ssim"]), (0, None, 1))
        self.assertIn("mae", self.accepted("metrics", black, white))

    def test_different_sizes_are_refused(self):
        self.refused("metrics", self.png("a.png", 16, 12, 0), self.png("b.png", 12, 16, 0), says=["16", "12"])


class Schemas(Folder):
    NAMES = ("sweep", "scene", "thresholds")

    def schema(self, name):
        return json.loads(self.accepted("describe", "--schema", name))

    def test_committed_schemas_are_those_the_program_generates(self):
        for name in self.NAMES:
            path = SOURCE / "configs" / "schema" / f"{name}.schema.json"
            self.assertEqual(path.read_text(encoding="utf-8"), self.accepted("describe", "--schema", name),
                             f"renew it: penumbra describe --schema {name} > {path.relative_to(SOURCE)}")

    def test_every_key_of_a_sweep_is_explained(self):
        text = (SOURCE / "configs" / "README.md").read_text(encoding="utf-8")
        properties = self.schema("sweep")["properties"]
        for key in [*properties, *properties["measure"]["properties"]]:
            if key != "$schema":
                self.assertIn(f"`{key}`", text)

    def test_schemas_are_draft_7(self):
        for name in self.NAMES:
            schema = self.schema(name)
            self.assertEqual(schema["$schema"], "http://json-schema.org/draft-07/schema#")
            try:
                import jsonschema
            except ImportError:
                continue
            jsonschema.Draft7Validator.check_schema(schema)

    def test_committed_configs_and_scenes_fit(self):
        sweep, scene = self.schema("sweep"), self.schema("scene")
        paper = json.loads((SOURCE / "configs" / "schema" / "paper.schema.json").read_text(encoding="utf-8"))
        files = [f for f in (SOURCE / "configs").rglob("*.json") if "schema" not in f.parts]
        self.assertGreater(len(files), 5)
        for path in files:
            with self.subTest(path.name):
                wanted = scene if "scenes" in path.parts else paper if path.name == "paper.json" else sweep
                self.assertEqual(schema_check.errors(schema_check.load(path), wanted), [])

    def test_the_sweep_schema_refuses_what_the_program_refuses(self):
        schema, good = self.schema("sweep"), Validation.GOOD
        self.assertEqual(schema_check.errors(good, schema), [])
        for change in ({"mask_sise": 4}, {"mask_size": 0}, {"mask_size": "4"}, {"mask_size": []}, {"resolution": 16385},
                       {"resolution": [[1, 2, 3]]}, {"light_size": -1}, {"light_pattern": "haltom"}, {"scene": ""},
                       {"techniques": []}, {"techniques": ["gear"]}, {"techniques": [{"technique": "gears", "x": 1}]},
                       {"techniques": [{"technique": "ray_tracing", "params": {"robust": 1}}]}, {"images": "mask"},
                       {"images": ["masks"]}, {"measure": {"repetitions": 0}}, {"reference": {"light_samples": -1}},
                       {"frames": 0}, {"seed": -1}, {"name": "a/b"}):
            with self.subTest(change):
                self.assertNotEqual(schema_check.errors(dict(good, **change), schema), [])
                self.refused("validate", self.write("wrong.json", dict(good, **change)))


if __name__ == "__main__":
    unittest.main()
