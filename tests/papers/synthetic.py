"""Made-up papers and results whose claims have known answers."""
import json
import pathlib
import sys

sys.dont_write_bytecode = True
SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "scripts"))
from reproducing import paper  # noqa: E402
from reproducing.cells import Grid  # noqa: E402
from reproducing.runs import Mode  # noqa: E402

SCENES = {"a": {"label": "A", "scene": "bunny"}, "b": {"label": "B", "scene": "dragon"}, "c": {"label": "C"}}


def point(scene, samples=(10.0,), technique="gears", status="ok", counters=None, **params):
    samples = list(samples)
    params = {"camera": "front", **params}
    return {"id": json.dumps([scene, technique, params]), "technique": technique, "scene": scene, "frame": 0, "status": status,
            "message": "" if status == "ok" else "a reason", "params": params, "counters": counters or {}, "images": {},
            "timing": {"frame_ms": {"median": sorted(samples)[len(samples) // 2], "samples": samples}}}


def steady(value, spread=0.01, count=9):
    """Times about a value, none of them the same."""
    return [value * (1 + spread * (i - count // 2) / count) for i in range(count)]


def table(**keys):
    return {"id": "t", "title": "Table", "caption": "A table.", "config": "t.json", "figure": "fps", "rows": ["a", "b"],
            "columns": {"axis": "mask_size", "values": [4, 8, 16, 32]}, **keys}


def paper_of(*tables):
    return paper.Paper("made_up", pathlib.Path("made_up"), {"key": "GEARS", "title": "T", "sources": {"s": "slides"}, "scenes": SCENES,
                                                          "tables": list(tables)}, {})


def grid(the_table, points, mode=None):
    return Grid(paper_of(the_table), the_table, {"points": points, "run": {}}, mode or Mode())
