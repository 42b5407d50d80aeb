#!/usr/bin/python3
"""Reads every #include and fails on an arrow that the house forbids (harness parts and techniques' rooms)."""
import pathlib
import re
import sys

# part -> parts of harness/ that it may use, besides itself. Arrows are transitive through their targets.
ALLOWED = {
    "core": set(),
    "image": {"core"},
    "scene": {"core"},
    "gpu": {"core", "image"},
    "embree": {"core"},
    "samples": {"core", "image", "scene", "gpu"},
    "technique": {"core", "image", "scene", "gpu", "samples"},
    "reference": {"core", "image", "scene", "gpu", "samples", "embree"},
    "metrics": {"core", "image", "scene", "gpu", "samples"},
    "config": {"core", "scene", "samples", "gpu", "technique"},
    "run": {"core", "image", "scene", "gpu", "samples", "technique", "reference", "metrics", "config", "embree"},
    "compare": {"core", "image", "metrics"},
    "report": {"core", "image"},
}
TECHNIQUE = {"core", "image", "scene", "gpu", "samples", "technique", "embree"}
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
SUFFIXES = {".h", ".cpp", ".comp", ".vert", ".frag", ".geom", ".glsl"}


def forbidden(file, target, root):
    """Why `file` may not include `target`, or None."""
    where = file.relative_to(root).parts
    parts = pathlib.PurePosixPath(target).parts
    head = parts[0]
    if head in ("tests",) and where[0] != "tests":
        return "product code includes tests"
    if where[0] == "harness":
        own = where[1]
        if own == "app":
            return None
        if head == "techniques":
            return "harness includes techniques"
        if head in ALLOWED and head != own and head not in ALLOWED[own]:
            return f"{own} may not use {head}"
        if head == "app":
            return f"{own} may not use app"
    if where[0] == "techniques" and len(where) > 2:
        room = where[1]
        if head == "techniques" and len(parts) > 2 and parts[1] not in (room, "common"):
            return f"technique {room} uses technique {parts[1]}"
        if head in ALLOWED and head not in TECHNIQUE or head == "app":
            return f"technique {room} uses {head}"
    return None


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    files = [f for top in ("harness", "techniques") for f in (root / top).rglob("*") if f.suffix in SUFFIXES]
    if len(files) < 20:
        sys.exit(f"only {len(files)} source files found under {root}: measuring nothing")
    bad = [f"{f.relative_to(root)}: #include \"{t}\": {why}"
           for f in sorted(files) for t in INCLUDE.findall(f.read_text(encoding="utf-8"))
           if (why := forbidden(f, t, root))]
    # The judge of this test: a forbidden arrow must be found.
    probe = root / "harness" / "reference" / "probe.cpp"
    assert forbidden(probe, "techniques/common/x.h", root) and forbidden(probe, "technique/technique.h", root)
    assert forbidden(root / "techniques" / "gears" / "x.cpp", "techniques/shadow_map/x.h", root)
    assert not forbidden(root / "techniques" / "gears" / "x.cpp", "techniques/common/x.h", root)
    if bad:
        sys.exit("\n".join(bad))
    print(f"{len(files)} files, no forbidden arrow")


main()
