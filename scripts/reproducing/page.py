"""Writes a paper's page: one HTML file that needs nothing beside it."""
import html
import json
import os

from reproducing import claims, parts, pictures
from reproducing.cells import Grid
from reproducing.paper import ROOT
from reproducing.runs import Mode
from reproducing.svg import number

e = html.escape
MODES = {"full": "full size", "short": "short: every row, at small sizes", "ci": "a check that it works: one row of each table, tiny; figures mean nothing"}


class Section:
    """One table with its run."""

    def __init__(self, paper, table, run):
        self.table, self.run = table, run
        self.results = run.results() if run else None
        self.grid = Grid(paper, table, self.results, run.mode if run else Mode())
        self.verdicts = [claims.judge(self.grid, claim) for claim in table.get("claims", [])]

    def measured(self):
        return bool(self.results) and any(p["status"] == "ok" for p in self.results["points"])

    def html(self, paper, mode):
        table, grid, sources = self.table, self.grid, paper.data["sources"]
        out = [f'<section class="table-section" id="{e(table["id"])}"><div class="table-title"><h2>{e(table["title"])}</h2></div><p>{e(table["caption"])}</p>']
        out.append('<div class="card"><div class="side-by-side">')
        for reported in table.get("reported", []):
            out.append(f'<div class="source-column">{parts.source_table(reported, grid, sources)}</div>')
        for series in grid.series:
            out.append(f"<div>{parts.our_table(series, grid)}</div>")
        out.append("</div>")
        out += [f'<p class="note">{e(note)}</p>' for note in table.get("notes", [])] + ["</div>"]
        if drawn := parts.plots(grid, sources):
            out.append(f'<div class="card">{drawn}</div>')
        if "pictures" in table and self.run and (strips := pictures.shots(grid, self.run)):
            out.append(f'<div class="card">{strips}</div>')
        if "heat_map" in table and (strip := pictures.heat_maps(grid)):
            out.append(f'<div class="card">{strip}</div>')
        if self.verdicts:
            out.append('<div class="card"><h3>Claims</h3><div class="claims">' + "".join(parts.claim_html(v) for v in self.verdicts) + "</div></div>")
        flag = "" if mode == "full" else f" --{mode}"
        command = f"scripts/reproduce {paper.name} {table['id']}{flag}"
        out.append(f'<div class="command"><pre>{e(command)}\npenumbra {e(" ".join(shell(a) for a in self.run.command()))}</pre></div></section>')
        return "".join(out)


def shell(argument):
    return argument if argument.replace("/", "").replace("_", "").replace(".", "").replace("-", "").isalnum() else f"'{argument}'"


def author_list(text):
    names = [" ".join(reversed(n.split(", "))) if ", " in n else n for n in text.split(" and ")]
    return ", ".join(names)


def citation_text(paper):
    entry = paper.citation
    where = [entry.get(k) for k in ("journal", "booktitle", "institution", "howpublished")]
    tail = [next((w for w in where if w), ""), f"{entry['volume']}({entry['number']})" if "volume" in entry and "number" in entry else "", entry.get("year", ""), entry.get("note", "")]
    return f"{author_list(entry.get('author', ''))}: {entry.get('title', '')}. " + ", ".join(t for t in tail if t) + "."


def counts(sections):
    told = {}
    for section in sections:
        for verdict in section.verdicts:
            told[verdict.verdict] = told.get(verdict.verdict, 0) + 1
    order = [claims.HOLDS, claims.PART, claims.OPEN, claims.FAILS, claims.MISSING]
    return "".join(f'<li><span class="badge {parts.BADGES[v]}">{told[v]}</span>{e(v)}</li>' for v in order if v in told)


def overview(sections):
    out = ['<div class="scroll-x"><table class="overview"><thead><tr><th>where</th><th>claim</th><th></th></tr></thead><tbody>']
    for section in sections:
        for verdict in section.verdicts:
            out.append(f'<tr><td><a href="#{e(section.table["id"])}">{e(section.table["title"])}</a></td><td>{e(verdict.claim["text"])}</td><td>{parts.badge(verdict)}</td></tr>')
    return "".join(out) + "</tbody></table></div>"


def scenes_html(paper, sections):
    known = {}
    for section in sections:
        for scene in section.results["run"].get("scenes", []) if section.results else []:
            known[scene["name"]] = scene
    out = ['<div class="scroll-x"><table class="overview plain-scenes"><thead><tr><th>the source</th><th class="num">triangles</th><th>ours</th><th class="num">triangles</th><th>what it is</th></tr></thead><tbody>']
    for scene in paper.data["scenes"].values():
        ours, run = scene.get("scene"), known.get(scene.get("scene"), {})
        about = "; ".join(t for t in (run.get("fidelity", ""), scene.get("note", "")) if t)
        out.append(f'<tr><td>{e(scene["label"])}</td><td class="num">{number(scene.get("triangles"))}</td><td>{e(ours or "none")}</td>'
                   f'<td class="num">{number(run.get("triangles"))}</td><td>{e(about)}</td></tr>')
    return "".join(out) + "</tbody></table></div>"


def provenance(sections):
    runs = [s.results["run"] for s in sections if s.results]
    if not runs:
        return "<p>Nothing has been run.</p>"
    told, all_of = [], lambda get: ", ".join(dict.fromkeys(str(get(r)) for r in runs))
    told.append(("processor", all_of(lambda r: f"{r['cpu']['model']}, {r['cpu']['usable_cores']} cores, {r['cpu'].get('instruction_set', '')}; {r.get('threads')} threads")))
    told.append(("device", all_of(lambda r: f"{r['vulkan']['name']}, {r['vulkan']['driver']} {r['vulkan']['driver_version']}")))
    told.append(("Embree", all_of(lambda r: r["embree"])))
    told.append(("program", all_of(lambda r: f"{r['program']['version']}, {r['program']['commit']}, {r['program']['compiler']} {r['program']['build_type']}")))
    told.append(("clock", all_of(lambda r: r["clock"])))
    told.append(("load at start", f"{min(r['load'][0] for r in runs):.1f} to {max(r['load'][0] for r in runs):.1f}"))
    told.append(("run", f"{min(r['started'] for r in runs)} to {max(r.get('ended', r['started']) for r in runs)}"))
    return '<dl class="pairs">' + "".join(f"<dt>{e(k)}</dt><dd>{e(v)}</dd>" for k, v in told) + "</dl>"


def load_notice(sections):
    busy = [s for s in sections if s.results and s.results["run"]["load"][0] > 1.5 * s.results["run"]["cpu"]["usable_cores"]]
    if not busy:
        return ""
    return f'<p class="notice">The machine was busy with other work in {len(busy)} of {len(sections)} tables (load above 1.5 a core at their start): times wander more than their intervals say.</p>'


def document(paper, sections, mode):
    css = (ROOT / "harness/report/assets/report.css").read_text(encoding="utf-8") + (ROOT / "scripts/reproducing/page.css").read_text(encoding="utf-8")
    links = "".join(f'<a href="#{e(s.table["id"])}">{e(s.table["title"])}</a>' for s in sections)
    about = f"<p>{e(paper.data['about'])}</p>" if "about" in paper.data else ""
    body = "".join(s.html(paper, mode) for s in sections)
    return f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="penumbra reproduce">
<meta name="color-scheme" content="light dark">
<title>{e(paper.data["title"])} · reproduced by Penumbra</title>
<link rel="icon" href="data:,">
<style>{css}</style>
</head>
<body>
<header class="top"><div class="wrap">
<p class="brand">Penumbra <span>the papers, reproduced</span></p>
<h1>{e(paper.data["title"])}</h1>
<p class="machine">{e(citation_text(paper))}</p>
<p class="machine">Run: {e(MODES[mode])}.</p>
<ul class="counts" aria-label="Claims by verdict">{counts(sections)}</ul>
</div></header>
<nav aria-label="Sections"><div class="wrap"><a href="#claims">Claims</a>{links}<a href="#scenes">Scenes</a><a href="#provenance">Provenance</a></div></nav>
<main class="wrap">
{load_notice(sections)}
<section id="claims"><h2>Claims</h2>{about}
<p class="note">A claim holds where its figure and the figure's whole 95 % interval meet the condition. Intervals are bootstraps of the repetitions' times; counters and errors have none. Frame rates are of different machines: plots show both divided by their mean (or by the named column), so that their trends can be compared.</p>
<div class="card">{overview(sections)}</div></section>
{body}
<section id="scenes"><h2>Scenes</h2><div class="card">{scenes_html(paper, sections)}</div></section>
<section id="provenance"><h2>Provenance</h2><div class="card">{provenance(sections)}</div></section>
</main>
</body>
</html>
"""


def summary(sections):
    """What the page says, for other programs."""
    tables = []
    for s in sections:
        cells = {x["id"]: {r["id"]: {c["id"]: s.grid.cell(x, r, c).value for c in s.grid.columns} for r in s.grid.rows} for x in s.grid.series}
        verdicts = [{"id": v.claim["id"], "verdict": v.verdict, "condition": v.condition,
                     "lines": [{"label": l.label, "source": l.paper, "ours": l.ours, "interval": l.interval, "verdict": l.verdict} for l in v.lines]} for v in s.verdicts]
        tables.append({"id": s.table["id"], "figures": cells, "claims": verdicts})
    return {"tables": tables}


def write(paper, planned, mode, out):
    """Writes index.html and summary.json into `out`; returns the page's path and whether anything was measured."""
    by_table = {t: run for run in planned for t in run.tables}
    sections = [Section(paper, table, by_table.get(table["id"])) for table in paper.data["tables"]]
    out.mkdir(parents=True, exist_ok=True)
    for name, content in (("index.html", document(paper, sections, mode)), ("summary.json", json.dumps(summary(sections), indent=1))):
        (out / (name + ".new")).write_text(content, encoding="utf-8")
        os.replace(out / (name + ".new"), out / name)
    return out / "index.html", any(s.measured() for s in sections)
