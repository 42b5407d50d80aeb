"""The parts of a paper's page that show one table: figures, plots, claims."""
import html
import math

from reproducing import claims
from reproducing.paper import shown
from reproducing.svg import MARKERS, chart, number

LOOKS = [("look-0", "circle"), ("look-1", "diamond"), ("look-2", "triangle"), ("look-3", "square"), ("look-4", "cross"), ("look-5", "circle")]
SOURCES = [("look-source", "square"), ("look-source2", "cross")]
BADGES = {
    claims.HOLDS: "holds",
    claims.FAILS: "fails",
    claims.PART: "part",
    claims.OPEN: "undecided",
    claims.MISSING: "missing",
}
e = html.escape


def badge(verdict):
    return f'<span class="badge {BADGES[verdict.verdict]}">{e(verdict.summary())}</span>'


def heading(column, grid):
    """A column's heading; where the mode measured at another value, both."""
    text, axis = e(column["label"]), column.get("axis")
    if axis:
        wanted = column["where"][axis]
        taken = grid.mode.scaled(axis, wanted)
        if taken != wanted:
            text += f" <small>run at {e(number(float(taken)) if isinstance(taken, (int, float)) else str(taken))}</small>"
    unit = column.get("unit")
    return text + (f" <small>{e(unit)}</small>" if unit else "")


def table_html(caption, grid, columns, cell, head=heading):
    out = [f'<div class="scroll-x"><table class="figures"><caption>{caption}</caption><thead><tr><th>{e(grid.table.get("row_label", ""))}</th>']
    out += [f"<th>{head(c, grid)}</th>" for c in columns] + ["</tr></thead><tbody>"]
    for row in grid.rows:
        out.append(f"<tr><th>{e(row['label'])}</th>" + "".join(cell(row, c) for c in columns) + "</tr>")
    return "".join(out) + "</tbody></table></div>"


def source_table(reported, grid, sources):
    columns = shown(grid.columns)
    plain = lambda c, g: e(c["label"]) + (f" <small>{e(c['unit'])}</small>" if c.get("unit") else "")

    def cell(row, column):
        figures = reported["rows"].get(row["id"])
        value = figures[[c["id"] for c in columns].index(column["id"])] if figures else None
        return f"<td>{number(value)}</td>" if value is not None else '<td class="none">–</td>'

    unit = f", {grid.table['unit']}" if "unit" in grid.table else ""
    note = f"<br><small>{e(reported['note'])}</small>" if "note" in reported else ""
    caption = f"The source <small>{e(sources[reported['source']])}, {e(reported['place'])}{e(unit)}</small>{note}"
    return table_html(caption, grid, columns, cell, plain)


def our_table(series, grid):
    def cell(row, column):
        found = grid.cell(series, row, column)
        if found.value is None:
            said = found.reason.split(":")[0]
            short = said if said in ("not run", "unsupported", "failed", "timeout") else "none" if said == "no scene of ours" else "–"
            return f'<td class="none" title="{e(found.reason)}">{e(short)}</td>'
        low_high = found.interval()
        wide = low_high and low_high[1] - low_high[0] > 1e-9 * abs(found.value)
        spread = f"<small>{number(low_high[0])} – {number(low_high[1])}</small>" if wide else ""
        return f"<td>{number(found.value)}{spread}</td>"

    unit = f", {grid.table['unit']}" if "unit" in grid.table else ""
    return table_html(f"{e(series['label'])} <small>this run{e(unit)}</small>", grid, shown(grid.columns), cell)


def short_name(label):
    """A row's heading as it fits under a plot."""
    return label.replace("LS ", "") if "(" in label else label.split(",")[0]


def geometric_mean(values):
    return math.exp(sum(math.log(v) for v in values) / len(values))


def hardware(column, grid):
    """Whether a column's figure depends on the machine, so that only its relations can be held against the source."""
    figure = column.get("figure") or grid.table.get("figure") or ""
    return "ratio" not in column and "equal" not in column and (figure == "fps" or figure.startswith("timing."))


def sides(grid, sources, pairs):
    """Lines of one panel: [(name, look, marker, values, intervals)] for (row, column) pairs, the source's first."""
    told, columns = [], shown(grid.columns)
    for number_of, reported in enumerate(grid.table.get("reported", [])):
        values = [reported["rows"][r["id"]][[c["id"] for c in columns].index(k["id"])] if r["id"] in reported["rows"] else None for r, k in pairs]
        told.append((f"the source ({sources[reported['source']].split(',')[0]})", *SOURCES[number_of % 2], values, [None] * len(values)))
    for series, (look, marker) in zip(grid.series, LOOKS * (1 + len(grid.series) // len(LOOKS))):
        cells = [grid.cell(series, r, k) for r, k in pairs]
        told.append((series["label"], look, marker, [c.value for c in cells], [c.interval() for c in cells]))
    return [line for line in told if any(v is not None for v in line[3])]


def relative(lines, at):
    """Each divided by its value at one place, or by the geometric mean of the places that all lines have."""
    common = [i for i in range(len(lines[0][3])) if all(line[3][i] for line in lines)]
    if at is not None:
        common = [at] if at in common else []
    if not common:
        return None
    out = []
    for name, look, marker, values, intervals in lines:
        base = geometric_mean([values[i] for i in common])
        out.append((name, look, marker, [v / base if v is not None else None for v in values],
                    [tuple(x / base for x in i) if i else None for i in intervals]))
    return out


def panel(title, lines, places, labels, normalise, at, y_label, x_label, y_log, x_log, joined):
    if not lines or not any(line[1].startswith("look-") and not line[1].startswith("look-source") for line in lines):
        return "", ()
    if normalise and any(line[1].startswith("look-source") for line in lines):
        lines = relative(lines, at) or [line for line in lines if not line[1].startswith("look-source")]
        y_label = "relative" if at is None else f"relative to {labels[at]}"
    drawn = [{"name": n, "look": l, "marker": m, "values": v, "intervals": i} for n, l, m, v, i in lines]
    return chart(title, drawn, places, labels, y_log, y_label, x_label, x_log, joined), [line[:3] for line in lines]


def plots(grid, sources):
    plot, columns = grid.table.get("plot", {}), shown(grid.columns)
    kind = plot.get("kind", "lines" if not isinstance(grid.table["columns"], list) or all("x" in c for c in columns) else "rows")
    if kind == "none":
        return ""
    yes = lambda key, usual: plot.get(key, usual) == "yes"
    panels, key = [], {}
    if kind == "lines":
        x = [c.get("x") for c in columns]
        places = x if all(v is not None for v in x) else list(range(len(columns)))
        at = [c["id"] for c in columns].index(plot["normalise"]) if "normalise" in plot else None
        axis = grid.table["columns"].get("label", "") if isinstance(grid.table["columns"], dict) else ""
        log = yes("x_log", "yes" if min(places) > 0 and max(places) / min(places) >= 4 else "no")
        for row in grid.rows:
            panels.append(panel(row["label"], sides(grid, sources, [(row, c) for c in columns]), places, [c["label"].replace("LS ", "") for c in columns],
                                any(hardware(c, grid) for c in columns), at, grid.table.get("unit", ""), axis, yes("y_log", "yes"), log, True))
    else:
        for column in columns:
            panels.append(panel(column["label"], sides(grid, sources, [(r, column) for r in grid.rows]), list(range(len(grid.rows))),
                                [short_name(r["label"]) for r in grid.rows], hardware(column, grid), None,
                                column.get("unit", grid.table.get("unit", "")), grid.table.get("row_label", ""), yes("y_log", "yes"), False, False))
    for _, lines in panels:
        key.update({name: (look, marker) for name, look, marker in lines})
    drawn = "".join(p for p, _ in panels)
    if not drawn:
        return ""
    marks = "".join(
        f'<li><svg viewBox="0 0 34 12"><g class="{look}"><path class="line" d="M0 6H34"/><g class="mark" transform="translate(17 6)">{MARKERS[marker]}</g></g></svg>{e(name)}</li>'
        for name, (look, marker) in key.items()
    )
    return f'<ul class="key">{marks}</ul><div class="panels">{drawn}</div>'


def interval_text(line):
    if not line.interval:
        return "–"
    low, high = line.interval
    return "–" if low == high else f"{number(low)} – {number(high)}"


def claim_html(verdict):
    claim = verdict.claim
    out = [f'<article class="claim"><h4>{e(claim["text"])} {badge(verdict)}</h4>']
    place = f"{claim['place']}. " if "place" in claim else ""
    out.append(f'<p class="note">{e(place)}Held to: {e(verdict.condition)}.</p>')
    if verdict.why:
        out.append(f'<p class="why">{e(verdict.why)}</p>')
    measured = [line for line in verdict.lines if line.verdict != claims.MISSING]
    if measured:
        out.append('<div class="scroll-x"><table><thead><tr><th></th><th class="num">source</th><th class="num">ours</th><th>95 % interval</th><th></th></tr></thead><tbody>')
        for line in measured:
            out.append(
                f'<tr><th>{e(line.label)}</th><td class="num">{e(number(line.paper))}</td><td class="num">{e(number(line.ours))}</td>'
                f'<td>{e(interval_text(line))}</td><td class="soft">{e(line.verdict)}</td></tr>'
            )
        out.append("</tbody></table></div>")
    reasons = {}
    for line in verdict.lines:
        if line.verdict == claims.MISSING:
            reasons.setdefault(line.reason, []).append(line.label)
    out += [f'<p class="note">Not measured ({e(reason)}): {e(", ".join(labels))}.</p>' for reason, labels in reasons.items()]
    return "".join(out) + "</article>"
