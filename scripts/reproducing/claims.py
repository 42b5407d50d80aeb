"""Judges a paper's claims by the cells of a table: for each line of it what the source says, what was measured, with its
bootstrap interval, and whether the claim holds there; and of all lines one verdict.

A line *holds* when its figure and its whole interval meet the condition, *fails* when none of it does, and is *open* when the
interval reaches to both sides. A claim holds when all its lines do, fails when all do, and else holds in part."""
import dataclasses
import math

import numpy

from reproducing.cells import DRAWS
from reproducing.paper import shown

HOLDS, FAILS, OPEN, PART, MISSING = "holds", "fails", "undecided", "holds in part", "not measured"


@dataclasses.dataclass
class Line:
    label: str
    paper: float = None
    ours: float = None
    interval: tuple = None
    verdict: str = MISSING
    reason: str = ""


@dataclasses.dataclass
class Verdict:
    claim: dict
    verdict: str
    lines: list
    condition: str
    why: str = ""

    def summary(self):
        measured = [l for l in self.lines if l.verdict != MISSING]
        if self.verdict == PART:
            return f"holds in {sum(l.verdict == HOLDS for l in measured)} of {len(measured)}"
        return self.verdict


def judged(label, paper, value, draws, meets):
    """A line from a figure, its draws, and the condition on a figure."""
    if value is None or not math.isfinite(value):
        return Line(label, paper, reason="no figure")
    draws = draws[numpy.isfinite(draws)] if draws is not None else numpy.full(1, value)
    if not len(draws):
        return Line(label, paper, reason="no figure")
    low, high = numpy.percentile(draws, [2.5, 97.5])
    inside = {bool(meets(v)) for v in (float(low), float(high), value)}
    verdict = HOLDS if inside == {True} else FAILS if inside == {False} else OPEN
    return Line(label, paper, value, (float(low), float(high)), verdict)


def overall(lines):
    verdicts = [l.verdict for l in lines if l.verdict != MISSING]
    if not verdicts:
        return MISSING
    if all(v == HOLDS for v in verdicts):
        return HOLDS
    if all(v == FAILS for v in verdicts):
        return FAILS
    return PART if HOLDS in verdicts else OPEN


def ranks(values):
    """Ranks along the last axis; equal values share their mean rank."""
    values = numpy.asarray(values, float)
    less = (values[..., None, :] < values[..., :, None]).sum(-1)
    equal = (values[..., None, :] == values[..., :, None]).sum(-1)
    return less + (equal - 1) / 2


def rank_correlation(x, y):
    """Spearman's, along the last axis; 0 where one side does not vary."""
    a, b = ranks(x), ranks(y)
    a, b = a - a.mean(-1, keepdims=True), b - b.mean(-1, keepdims=True)
    scale = numpy.sqrt((a * a).sum(-1) * (b * b).sum(-1))
    return (a * b).sum(-1) / numpy.where(scale > 0, scale, 1)


def slope(x, y, fit):
    """Of the last axis: the exponent of y ~ x^k, or the change of y for the whole span of x, as a share of y's mean."""
    x, y = numpy.asarray(x, float), numpy.asarray(y, float)
    if fit == "power":
        x, y = numpy.log(x), numpy.log(y)
    c = x - x.mean()
    k = (y * c).sum(-1) / (c * c).sum()
    return k if fit == "power" else k * (x.max() - x.min()) / y.mean(-1)


class Judge:
    def __init__(self, grid, claim):
        self.grid, self.claim = grid, claim
        self.series = grid.by_id("series", claim["series"]) if "series" in claim else grid.series[0]
        self.rows = [r for r in grid.rows if r["id"] in claim.get("rows", [i["id"] for i in grid.rows])]
        self.columns = [c for c in grid.columns if c["id"] in claim.get("columns", [i["id"] for i in grid.columns])]
        reported = grid.table.get("reported", [])
        wanted = claim.get("source") or (reported[0]["source"] if reported else None)
        self.reported = [r for r in reported if r["source"] == wanted]

    def paper(self, row, column):
        told = [c["id"] for c in shown(self.grid.columns)]
        if column["id"] not in told:
            return None
        figures = [r["rows"][row["id"]][told.index(column["id"])] for r in self.reported if row["id"] in r["rows"]]
        return next((f for f in figures if f is not None), None)

    def cell(self, row, column, series=None):
        return self.grid.cell(series or self.series, row, column)

    def lines(self):
        """The table's lines along the claim's direction: (heading, x of each cell, the source's figures, cells)."""
        along = self.claim["along"]
        lines, cells = (self.rows, self.columns) if along == "columns" else (self.columns, self.rows)
        for line in lines:
            pairs = [(line, c) if along == "columns" else (c, line) for c in cells]
            yield line["label"], cells, [self.paper(*p) for p in pairs], [self.cell(*p) for p in pairs]

    def measured(self, items, paper, cells):
        """What is there of a line; the source's figures only where all are."""
        kept = [(i, p, c) for i, p, c in zip(items, paper, cells) if c.value is not None]
        items, paper, cells = map(list, zip(*kept)) if kept else ([], [], [])
        draws = numpy.array([c.draws for c in cells]).T if cells else None
        return items, paper if all(p is not None for p in paper) else None, [c.value for c in cells], draws

    def trend(self):
        sign = 1 if self.claim["direction"] == "rises" else -1
        least = self.claim.get("min", 0.8)
        for label, items, paper, cells in self.lines():
            items, paper, values, draws = self.measured(items, paper, cells)
            if len(values) < 3:
                yield Line(label, reason="fewer than three figures along the line")
                continue
            order = numpy.arange(len(values), dtype=float)
            yield judged(
                label,
                float(rank_correlation(order, paper)) if paper else None,
                float(rank_correlation(order, values)),
                rank_correlation(numpy.broadcast_to(order, draws.shape), draws),
                lambda v: sign * v >= least - 1e-9,
            )
        self.condition = f"rank correlation along the {self.claim['along']} {'≥ ' if sign > 0 else '≤ −'}{least:g}"

    def rank(self):
        least = self.claim.get("min", 0.5)
        self.condition = f"rank correlation of the source's figures with ours ≥ {least:g}"
        pairs = [(self.paper(r, c), self.cell(r, c)) for r in self.rows for c in self.columns]
        pairs = [(p, c) for p, c in pairs if p is not None and c.value is not None]
        if len(pairs) < 4:
            yield Line("all figures", reason="fewer than four figures on both sides")
            return
        paper = numpy.array([p for p, _ in pairs])
        draws = numpy.array([c.draws for _, c in pairs]).T
        # What stands in the table is a choice too: the cells are drawn anew together with their times.
        random = numpy.random.default_rng(1)
        chosen = random.integers(0, len(pairs), (DRAWS, len(pairs)))
        drawn = rank_correlation(paper[chosen], numpy.take_along_axis(draws, chosen, 1))
        yield judged(
            f"{len(pairs)} figures", 1.0, float(rank_correlation(paper, [c.value for _, c in pairs])), drawn, lambda v: v >= least
        )

    def near(self):
        factor = max(self.claim.get("within", 2), 1)
        self.condition = f"within a factor of {factor:g} of the source's figure"
        for row in self.rows:
            for column in self.columns:
                said, cell = self.paper(row, column), self.cell(row, column)
                label = f"{row['label']}, {column['label']}"
                if said is None or cell.value is None:
                    yield Line(label, said, reason=cell.reason or "the source has no figure for it")
                    continue
                low, high = sorted((said / factor, said * factor))
                yield judged(label, said, cell.value, cell.draws, lambda v, low=low, high=high: low <= v <= high)

    def slope(self):
        factor = max(self.claim.get("within", 2), 1)
        power = self.claim["fit"] == "power"
        self.condition = f"within a factor of {factor:g} of the source's {'exponent' if power else 'relative change'}"
        for label, items, paper, cells in self.lines():
            items, paper, values, draws = self.measured(items, paper, cells)
            x = [i.get("x") for i in items]
            if len(values) < 2 or any(v is None for v in x):
                yield Line(label, reason="fewer than two figures with a place along the line")
                continue
            said = self.claim.get("paper")
            said = float(slope(x, paper, self.claim["fit"])) if said is None and paper else said
            if said is None:
                yield Line(label, reason="the source has no figures for it")
                continue
            low, high = sorted((said / factor, said * factor))
            yield judged(label, said, float(slope(x, values, self.claim["fit"])), slope(x, draws, self.claim["fit"]),
                         lambda v, low=low, high=high: low <= v <= high)

    def limits(self):
        low, high = self.claim.get("at_least", -math.inf), self.claim.get("at_most", math.inf)
        parts = [f"≥ {low:g}" if low > -math.inf else "", f"≤ {high:g}" if high < math.inf else ""]
        return (lambda v: low <= v <= high), " and ".join(p for p in parts if p)

    def picked(self, cells):
        """The cells of one line that references mean: for each (row, column) that they leave open."""
        free_rows = self.rows if any("row" not in c for c in cells) else [None]
        free_columns = self.columns if any("column" not in c for c in cells) else [None]
        for row in free_rows:
            for column in free_columns:
                found = []
                for c in cells:
                    r = self.grid.by_id("rows", c["row"]) if "row" in c else row
                    k = self.grid.by_id("columns", c["column"]) if "column" in c else column
                    s = self.grid.by_id("series", c["series"]) if "series" in c else self.series
                    found.append((self.paper(r, k), self.cell(r, k, s)))
                label = ", ".join(i["label"] for i in (row, column) if i) or "the figure"
                yield label, found

    def ratio(self):
        meets, text = self.limits()
        self.condition = f"ratio {text}"
        for label, ((pa, a), (pb, b)) in self.picked(self.claim["of"]):
            said = self.claim.get("paper", pa / pb if pa is not None and pb else None)
            if a.value is None or not b.value:
                yield Line(label, said, reason=a.reason or b.reason)
            else:
                yield judged(label, said, a.value / b.value, a.draws / b.draws, meets)

    def bound(self):
        meets, text = self.limits()
        self.condition = text
        for label, ((paper, cell),) in self.picked([self.claim["cell"]]):
            if cell.value is None:
                yield Line(label, self.claim.get("paper", paper), reason=cell.reason)
            else:
                yield judged(label, self.claim.get("paper", paper), cell.value, cell.draws, meets)

    def optimum(self):
        best = numpy.argmax if self.claim["best"] == "highest" else numpy.argmin
        within = self.claim.get("within", 0)
        self.condition = f"the {self.claim['best']} at most {within:g} places from the source's" if within else f"the {self.claim['best']} in the source's place"
        for label, items, paper, cells in self.lines():
            items, paper, values, draws = self.measured(items, paper, cells)
            if len(values) < 3 or not paper:
                yield Line(label, reason="fewer than three figures along the line, or none of the source's")
                continue
            said, ours, drawn = int(best(paper)), int(best(values)), best(draws, axis=1)
            share = float((abs(drawn - said) <= within).mean())
            verdict = HOLDS if share >= 0.95 else FAILS if share <= 0.05 else OPEN
            place = lambda i: items[i]["label"]
            yield Line(label, place(said), place(ours), (place(int(drawn.min())), place(int(drawn.max()))), verdict)


def explanation(grid, claim):
    """The claim's why with its figures filled in, or a sentence that says which is missing."""
    why, figures = claim["why"], {}
    for name, ref in why["figures"].items():
        series = grid.by_id("series", ref.get("series", claim.get("series", grid.series[0]["id"])))
        cell = grid.cell(series, grid.by_id("rows", ref["row"]), grid.by_id("columns", ref["column"]))
        if cell.value is None:
            return f"Not explained here: its figure '{name}' was not measured ({cell.reason})."
        figures[name] = cell.value
    return why["text"].format(**figures)


def judge(grid, claim):
    work = Judge(grid, claim)
    work.condition = ""
    lines = list(getattr(work, claim["kind"])())
    verdict = overall(lines)
    why = explanation(grid, claim) if "why" in claim and verdict not in (HOLDS, MISSING) else ""
    return Verdict(claim, verdict, lines, work.condition, why)
