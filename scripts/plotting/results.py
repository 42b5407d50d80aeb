"""A run's results.json: points, what was swept among them, and their figures."""
import json
import math

SCHEMA_VERSION = 1
LABELS = {
    "frame_ms": "time per frame (ms)",
    "build_ms": "build time (ms)",
    "mae": "MAE",
    "rmse": "RMSE",
    "psnr": "PSNR (dB)",
    "ssim": "SSIM",
    "flip": "FLIP",
}
LINEAR = {"psnr", "ssim", "bias"}
HIGHER_IS_BETTER = {"psnr", "ssim"}


class BadInput(Exception):
    """The results cannot be plotted; exit code 2."""


def read_results(run):
    path = run / "results.json"
    if not run.is_dir():
        raise BadInput(f"{run}: no such folder of results")
    try:
        results = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file; expected a folder that 'penumbra run' has written") from None
    except (ValueError, OSError) as error:
        raise BadInput(f"{path}: {error}") from None
    if not isinstance(results, dict) or not isinstance(results.get("points"), list):
        raise BadInput(f"{path}: /points: missing, or not an array")
    if results.get("schema_version") != SCHEMA_VERSION:
        raise BadInput(
            f"{path}: /schema_version: found {results.get('schema_version')!r}, expected {SCHEMA_VERSION}"
        )
    for index, point in enumerate(results["points"]):
        for key in ("technique", "scene", "status", "params"):
            if not isinstance(point, dict) or key not in point:
                raise BadInput(f"{path}: /points/{index}/{key}: missing")
    return results["points"]


def param(point, key):
    return point.get("frame") if key == "frame" else point["params"].get(key)


def size(value):
    """A parameter's value as a number, or None: [w, h] counts as its product."""
    if isinstance(value, bool):
        return None
    if isinstance(value, (int, float)):
        return value
    if isinstance(value, list) and value and all(isinstance(v, (int, float)) for v in value):
        return math.prod(value)
    return None


def text(value):
    if isinstance(value, list):
        return "×".join(text(v) for v in value)
    if isinstance(value, float):
        return f"{value:g}"
    return str(value).lower() if isinstance(value, bool) else str(value)


def values_of(points, key):
    found = {json.dumps(v): v for v in (param(p, key) for p in points) if v is not None}
    values = list(found.values())
    return sorted(values, key=size) if all(size(v) is not None for v in values) else values


def swept_keys(points):
    techniques = {p["technique"] for p in points}
    keys = ["frame"] + list(dict.fromkeys(key for p in points for key in p["params"]))
    return [
        key
        for key in keys
        if any(len(values_of([p for p in points if p["technique"] == t], key)) > 1 for t in techniques)
    ]


def eligible(points, axis):
    """A sequence has a point per frame and a summary: along the frame the former count, else the latter alone."""
    done = [p for p in points if p["status"] == "ok"]
    if axis == "frame":
        return [p for p in done if p.get("frame") is not None]
    summarised = {(p["scene"], p["technique"]) for p in done if "frame" in p and p["frame"] is None}
    return [p for p in done if p.get("frame") is None or (p["scene"], p["technique"]) not in summarised]


def median(point, time):
    return ((point.get("timing") or {}).get(time) or {}).get("median")


def interval(point, time):
    return ((point.get("timing") or {}).get(time) or {}).get("ci95") or [math.nan, math.nan]


def error_of(point, metric):
    part = "metrics_matched" if metric.startswith("matched.") else "metrics"
    return (point.get(part) or {}).get(metric.removeprefix("matched."))


def label_of(name):
    plain = name.removeprefix("matched.")
    return LABELS.get(plain, plain.replace("_", " ")) + (" (matched)" if name != plain else "")
