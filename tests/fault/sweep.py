"""A small sweep that is disturbed, and how its results are held against those of an undisturbed one."""
import json
import os
import pathlib
import subprocess

PROGRAM = os.environ.get("PENUMBRA_PROGRAM", str(pathlib.Path(__file__).parents[2] / "build" / "penumbra"))

CONFIG = {"name": "disturbed", "scene": ["torus_knot", "columns"], "resolution": 32, "mask_size": [2, 4],
          "techniques": ["ray_tracing", {"technique": "shadow_map", "params": {"map_size": 256, "pcf_kernel": [1, 3]}}],
          "images": ["visibility"], "reference": {"light_samples": 16},
          "measure": {"warmup": 0, "repetitions": 3, "min_time_s": 0, "max_time_s": 600}}


def write_config(folder):
    path = pathlib.Path(folder) / "disturbed.json"
    path.write_text(json.dumps(CONFIG), encoding="utf-8")
    return path


def command(config, out, resume=False):
    return [PROGRAM, "run", str(config), "--out", str(out), "--quiet", "--no-report"] + (["--resume"] if resume else [])


def run(config, out, resume=False, **options):
    return subprocess.run(command(config, out, resume), capture_output=True, text=True, check=False, timeout=900, **options)


def outcome(folder):
    """Every point's result without what a clock or the machine's state has its part in; fails on a point told twice."""
    points = json.loads((pathlib.Path(folder) / "results.json").read_text(encoding="utf-8"))["points"]
    ids = [p["id"] for p in points]
    assert len(set(ids)) == len(ids), "a point is there twice"
    ours = ("id", "key", "status", "message", "metrics", "metrics_matched", "counters", "params", "frame", "images")
    return {p["id"]: json.dumps({k: p.get(k) for k in ours}, sort_keys=True) for p in points}
