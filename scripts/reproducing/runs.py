"""Runs a paper's sweeps, at full size or in a smaller mode, each into a folder of its own; resumable."""
import dataclasses
import json
import os
import pathlib
import signal
import subprocess
import sys

from reproducing.paper import ROOT, read_config
from reproducing.reading import BadInput

PROGRAM = os.environ.get("PENUMBRA_PROGRAM", str(ROOT / "build" / "penumbra"))
INTERRUPTED, POINTS_FAILED, NO_DEVICE = 130, 1, 3


@dataclasses.dataclass
class Mode:
    """What a smaller run changes of a config; all empty for the full one."""

    name: str = "full"
    scale: dict = dataclasses.field(default_factory=dict)
    set: dict = dataclasses.field(default_factory=dict)
    rows: list = None
    filter: str = ""

    def scaled(self, axis, value):
        factor = self.scale.get(axis)
        if factor is None or isinstance(value, (str, bool)):
            return value
        if isinstance(value, list):
            return [self.scaled(axis, v) for v in value]
        return max(1, round(value * factor)) if isinstance(value, int) else value * factor


def mode_of(paper, table, name):
    """The table's own mode over the paper's."""
    if name == "full":
        return Mode(filter=table.get("filter", ""))
    whole, own = paper.data.get(name, {}), table.get(name, {})
    mode = {**whole, **own, "set": {**whole.get("set", {}), **own.get("set", {})}}
    return Mode(name, mode.get("scale", {}), mode["set"], mode.get("rows"), mode.get("filter", table.get("filter", "")))


@dataclasses.dataclass
class Run:
    """One sweep that one or more tables take their figures from."""

    config: pathlib.Path
    mode: Mode
    folder: pathlib.Path
    tables: list
    sets: dict
    filter: str

    def results(self):
        """The run's results.json, or None when there is none."""
        try:
            results = json.loads((self.folder / "results.json").read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        return results if isinstance(results.get("points"), list) else None

    def command(self):
        try:
            config = self.config.relative_to(ROOT)
        except ValueError:
            config = self.config
        arguments = ["run", str(config)]
        for pointer, value in self.sets.items():
            arguments += ["--set", f"{pointer}={json.dumps(value)}"]
        return arguments + (["--filter", self.filter] if self.filter else [])


def settings(paper, config, mode):
    """--set values: pointer -> value."""
    sets, as_list = rows_of_mode(paper, config, mode), lambda v: v if isinstance(v, list) else [v]
    for axis in mode.scale:
        if axis in config:
            values = [mode.scaled(axis, v) for v in as_list(config[axis])]
            sets[f"/{axis}"] = [v for i, v in enumerate(values) if v not in values[:i]]
        for number, entry in enumerate(sets.get("/techniques", as_list(config.get("techniques", [])))):
            if isinstance(entry, dict) and axis in entry.get("params", {}):
                values = [mode.scaled(axis, v) for v in as_list(entry["params"][axis])]
                sets[f"/techniques/{number}/params/{axis}"] = [v for i, v in enumerate(values) if v not in values[:i]]
    return {**sets, **mode.set}


def rows_of_mode(paper, config, mode):
    """Only the scenes of the mode's rows: not by a filter, so that the meshes of the others need not be there."""
    if not mode.rows:
        return {}
    wanted, as_list = set(), lambda v: v if isinstance(v, list) else [v]
    for row in mode.rows:
        if row not in paper.data["scenes"]:
            raise BadInput(f"{paper.folder / 'paper.json'}: the mode '{mode.name}' has rows of an unknown scene '{row}'")
        wanted.add(paper.scene_of(row) or row)
    keep = lambda scenes: [s for s in as_list(scenes) if s in wanted]
    sets, entries = {}, as_list(config.get("techniques", []))
    if "scene" in config:
        sets["/scene"] = keep(config["scene"])
    if any(isinstance(e, dict) and "scene" in e for e in entries):
        own = [{**e, "scene": keep(e["scene"])} if isinstance(e, dict) and "scene" in e else e for e in entries]
        sets["/techniques"] = [e for e in own if not isinstance(e, dict) or e.get("scene", True)]
    return sets


def plan(paper, tables, mode_name, out):
    """The runs that the tables need: equal configs in equal modes are one run."""
    runs = {}
    for table in tables:
        config, mode = read_config(paper, table), mode_of(paper, table, mode_name)
        sets, wanted = settings(paper, config, mode), mode.filter
        content = {k: v for k, v in config.items() if k not in ("name", "description", "$schema")}
        key = json.dumps([content, sets, wanted], sort_keys=True)
        if key in runs:
            runs[key].tables.append(table["id"])
            continue
        stem, number = pathlib.PurePath(table["config"]).stem, 1
        folders = {r.folder.name for r in runs.values()}
        while (name := stem if number == 1 else f"{stem}-{number}") in folders:
            number += 1
        runs[key] = Run(paper.folder / table["config"], mode, out / name, [table["id"]], sets, wanted)
    return list(runs.values())


def check(run):
    """Has the program check the sweep as it will be run, so that nothing is run when something is wrong."""
    arguments = ["validate" if a == "run" else a for a in run.command()]
    try:
        # Without the scenes, which each run loads and checks at its own start.
        result = subprocess.run([PROGRAM, *arguments, "--no-scenes"], cwd=ROOT, capture_output=True, text=True, check=False)
    except OSError as error:
        raise BadInput(f"{PROGRAM}: {error.strerror}; build it with scripts/setup") from None
    if result.returncode != 0:
        raise BadInput(result.stderr.strip())


def execute(run, extra, quiet):
    """Runs what is missing; returns the program's exit code."""
    resume = ["--resume"] if (run.folder / "run.json").exists() else []
    command = [PROGRAM, *run.command(), "--out", str(run.folder), "--no-report", *resume, *extra]
    if quiet:
        command.append("--quiet")
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL)
    # A terminal sends Ctrl-C to the program as well; a kill reaches this script alone.
    before = signal.signal(signal.SIGTERM, lambda *_: process.send_signal(signal.SIGINT))
    try:
        while True:
            try:
                return process.wait()
            except KeyboardInterrupt:
                print("reproduce: ending; what is finished is kept", file=sys.stderr)
    finally:
        signal.signal(signal.SIGTERM, before)
