"""From the points of a run to the cells of a table: which points a cell means, its figure, and how sure it is.

The uncertainty is a bootstrap: the repetitions' times are drawn anew with replacement, and all that is made of them (medians,
means over cameras, frame rates, ratios, correlations, slopes) is made of each draw. Counters and errors have none."""
import dataclasses
import hashlib
import math

import numpy

from reproducing.paper import columns_of, rows_of, series_of, size_of

DRAWS = 1000


@dataclasses.dataclass
class Cell:
    value: float = None
    draws: numpy.ndarray = None  # as many as DRAWS
    points: list = dataclasses.field(default_factory=list)
    reason: str = ""  # why there is no value

    def interval(self):
        if self.draws is None or not numpy.isfinite(self.draws).all():
            return None
        low, high = numpy.percentile(self.draws, [2.5, 97.5])
        return float(low), float(high)


def same(axis, wanted, found):
    if axis == "resolution":
        side = lambda v: v if isinstance(v, list) else [v, v]
        return found is not None and side(wanted) == side(found)
    if isinstance(wanted, list) != isinstance(found, list):
        square = lambda v: v if isinstance(v, list) else [v, v]
        return found is not None and square(wanted) == square(found)
    if isinstance(wanted, (int, float)) and isinstance(found, (int, float)) and not isinstance(wanted, bool):
        return math.isclose(wanted, found, rel_tol=1e-6)
    return wanted == found


def value_of(point, axis):
    return point.get(axis) if axis in ("technique", "scene", "frame") else point["params"].get(axis)


def select(points, where, mode):
    """Points that have these values; what a technique does not have as a parameter does not tell its points apart."""
    fits = lambda p, k, v: same(k, mode.scaled(k, v), value_of(p, k)) or (k not in ("technique", "scene") and value_of(p, k) is None)
    return [p for p in points if all(fits(p, k, v) for k, v in where.items())]


def fastest(points, axes):
    """Of points that differ in these parameters alone, the one with the shortest frame."""
    best = {}
    for point in points:
        key = str(sorted((k, v) for k, v in point["params"].items() if k not in axes)) + point["technique"]
        time = (figure_of(point, "timing.frame_ms")[0] if point["status"] == "ok" else None) or math.inf
        if key not in best or time < best[key][0]:
            best[key] = (time, point)
    return [point for _, point in best.values()]


def figure_of(point, path):
    """(value, samples or None) of a path; a STAT gives its median and its samples."""
    value = point
    for part in path.split("."):
        value = value.get(part) if isinstance(value, dict) else None
    if isinstance(value, dict):
        return value.get("median"), value.get("samples")
    return (value, None) if isinstance(value, (int, float)) and not isinstance(value, bool) else (None, None)


def median_draws(samples, seed):
    """Medians of samples drawn anew. The seed is the point's, so that equal results give equal pages."""
    random = numpy.random.default_rng(int.from_bytes(hashlib.sha256(seed.encode()).digest()[:8], "little"))
    values = numpy.asarray(samples, float)
    return numpy.median(values[random.integers(0, len(values), (DRAWS, len(values)))], axis=1)


def measure(points, figure):
    """The mean of a figure over points, and its draws; (None, None) when a point lacks it."""
    path = "timing.frame_ms" if figure == "fps" else figure
    values, draws = [], []
    for point in points:
        value, samples = figure_of(point, path)
        if value is None:
            return None, None
        values.append(value)
        draws.append(median_draws(samples, f"{point['id']}/{path}") if samples else numpy.full(DRAWS, float(value)))
    value, drawn = sum(values) / len(values), sum(draws) / len(draws)
    if figure == "fps":
        return (1000 / value, 1000 / drawn) if value > 0 and (drawn > 0).all() else (None, None)
    return value, drawn


def reason_of(points):
    """Why none of them has a figure."""
    bad = [p for p in points if p["status"] != "ok"]
    return f"{bad[0]['status']}: {bad[0].get('message') or 'no reason given'}" if bad else "not run"


def group_mean(points, axes):
    """Checks that the points of one cell differ in nothing but the axes that are averaged over."""
    extra = set()
    for point in points[1:]:
        for key in set(point["params"]) | set(points[0]["params"]):
            if point["params"].get(key) != points[0]["params"].get(key) and key not in axes:
                extra.add(key)
        for key in ("technique", "scene", "frame"):
            if point.get(key) != points[0].get(key) and key not in axes:
                extra.add(key)
    return sorted(extra)


def crossing(points, item, where, mode, best_over, scale):
    """The value of a parameter at which a figure equals another's."""
    rule = item["equal"]
    targets = fastest([p for p in select(points, {**where, **rule["to"]}, mode) if p["status"] == "ok"], best_over)
    where = {k: v for k, v in where.items() if k != rule["vary"]}
    target, target_draws = measure(targets, rule["figure"]) if targets else (None, None)
    if target is None:
        return Cell(reason="what is to be equalled was not measured")
    curve = {}
    for point in select(points, where, mode):
        size = size_of(value_of(point, rule["vary"]))
        if rule["vary"] == "mask_size" and not isinstance(value_of(point, rule["vary"]), list) and size:
            size *= size
        if point["status"] == "ok" and size:
            curve.setdefault(size, []).append(point)
    known = [(size, *measure(group, rule["figure"])) for size, group in sorted(curve.items())]
    known = [(size, value, draws) for size, value, draws in known if value is not None and value > 0]
    if len(known) < 2:
        return Cell(reason=f"fewer than two values of {rule['vary']} were measured")
    sizes = numpy.log([k[0] for k in known])
    value = meet(sizes, numpy.array([k[1] for k in known]), target)
    if value is None:
        low, high = min(k[1] for k in known), max(k[1] for k in known)
        return Cell(reason=f"{target:.4g} is not between the measured {low:.4g} and {high:.4g}", points=targets)
    curves = numpy.array([k[2] for k in known])
    draws = [meet(sizes, curves[:, i], target_draws[i]) for i in range(DRAWS)]
    draws = numpy.array([math.nan if d is None else d for d in draws])
    if numpy.isnan(draws).mean() <= 0.02:
        draws = numpy.where(numpy.isnan(draws), value, draws)
    return Cell(value * scale, draws * scale, targets)


def meet(sizes, values, target):
    """Where a curve meets the target: the first crossing, between logarithms; None outside of what was measured."""
    if target is None or target <= 0 or (values <= 0).any():
        return None
    y = numpy.log(values / target)
    y[abs(y) < 1e-6] = 0  # the target may be one of the values, but for rounding
    if y[0] == 0:
        return float(numpy.exp(sizes[0]))
    for i in range(len(y) - 1):
        if y[i] * y[i + 1] <= 0 and y[i] != y[i + 1]:
            return float(numpy.exp(sizes[i] + (sizes[i + 1] - sizes[i]) * y[i] / (y[i] - y[i + 1])))
    return None


class Grid:
    """All cells of one table: cell(series, row, column)."""

    def __init__(self, paper, table, results, mode):
        self.table, self.mode = table, mode
        scenes = paper.data["scenes"]
        self.rows, self.columns, self.series = rows_of(table, scenes), columns_of(table, scenes), series_of(table)
        self.points = results["points"] if results else []
        # A sequence's summary stands beside its frames; a table that does not ask for frames wants the summary alone.
        summarised = {(p["scene"], p["technique"]) for p in self.points if "frame" in p and p["frame"] is None}
        if not any("frame" in entry.get("where", {}) for entry in [table, *self.rows, *self.columns]):
            self.points = [p for p in self.points if (p["scene"], p["technique"]) not in summarised or p.get("frame") is None]
        self.paper, self.cache = paper, {}

    def where(self, series, row, column):
        where = {}
        for part in (self.table, series, row, column):
            where.update(part.get("where", {}))
        for item in (row, column):
            if "scene" in item:
                where["scene"] = self.paper.scene_of(item["scene"])
        return where

    def by_id(self, kind, name):
        return next(i for i in getattr(self, kind) if i["id"] == name)

    def cell(self, series, row, column):
        key = (series["id"], row["id"], column["id"])
        if key not in self.cache:
            self.cache[key] = self.compute(series, row, column)
        return self.cache[key]

    def compute(self, series, row, column):
        if "ratio" in column:
            a, b = (self.cell(series, row, self.by_id("columns", name)) for name in column["ratio"])
            if a.value is None or b.value is None or b.value == 0:
                return Cell(reason=a.reason or b.reason or "a division by zero", points=a.points)
            scale = column.get("scale", 1)
            return Cell(scale * a.value / b.value, scale * a.draws / b.draws, a.points + b.points)
        where = self.where(series, row, column)
        if "scene" in where and where["scene"] is None:
            return Cell(reason="no scene of ours")
        if not self.points:
            return Cell(reason="not run")
        best_over = [key for part in (series, row, column) for key in part.get("best_over", [])]
        scale = column.get("scale", row.get("scale", self.table.get("scale", 1)))
        if "equal" in column:
            return crossing(self.points, column, where, self.mode, best_over, scale)
        return self.plain(where, column.get("figure") or row.get("figure") or self.table.get("figure"), scale, best_over)

    def plain(self, where, figure, scale, best_over):
        matching = fastest(select(self.points, where, self.mode), best_over) if best_over else select(self.points, where, self.mode)
        points = [p for p in matching if p["status"] == "ok"]
        if not points or len(points) < len(matching):
            return Cell(reason=reason_of(matching), points=points)
        if extra := group_mean(points, self.table.get("average_over", [])):
            return Cell(reason=f"more than one point: they differ in {', '.join(extra)}", points=points)
        if figure is None:
            return Cell(points=points)
        value, draws = measure(points, figure)
        if value is None:
            return Cell(reason=f"no {figure}", points=points)
        return Cell(value * scale, draws * scale, points)
