"""A paper's file, configs/papers/PAPER/paper.json: its grammar, its checks, and what the other modules read of it."""
import dataclasses
import pathlib
import re

from reproducing.grammar import Any, Either, List, Map, Number, Object, Text
from reproducing.reading import BadInput, nearest, one_of, read_nodes, read_plain

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAPERS = ROOT / "configs" / "papers"
KINDS = ("trend", "rank", "near", "slope", "ratio", "bound", "optimum")

CELL = Object(
    {
        "row": Text("a row's id; without it each row in turn"),
        "column": Text("a column's id; without it each column in turn"),
        "series": Text("a series' id (default: the claim's)"),
    },
    about="which figure of the table",
)
ITEM_KEYS = {
    "id": Text("the name by which claims and reported numbers mean it"),
    "label": Text("its heading (default: the id)"),
    "scene": Text("a key of /scenes: the points of that scene"),
    "where": Map(Any(), "what its points have: technique, light, camera, or any parameter"),
    "figure": Text("what is shown of a point: fps, or a path in its record such as counters.rays"),
    "scale": Number("the figure is multiplied by this"),
    "ratio": List(Text(), "two columns: the first divided by the second, in the same row and series", 2, 2),
    "equal": Object(
        {
            "vary": Text("the parameter whose value is sought, by its size ([8, 6] counts as 48)"),
            "figure": Text("the figure that shall be equal, such as timing.frame_ms or metrics.rmse"),
            "to": Map(Any(), "where the points are whose figure is to be met"),
        },
        ("vary", "figure", "to"),
        "the value at which the figure equals another's, between measured ones by straight lines of the logarithms",
    ),
    "best_over": List(Text(), "parameters: of points that differ in them alone the fastest one counts"),
    "shown": Text("no: for ratios and explanations alone; such columns stand last", ("yes", "no")),
    "unit": Text("the figure's unit"),
    "x": Number("its place on an axis (default: its value on the layout's axis)"),
}
ITEM = Object(ITEM_KEYS, ("id",), title="an object with an 'id'")
CLAIM = Object(
    {
        "id": Text("unique in its table"),
        "text": Text("the claim, in a sentence"),
        "place": Text("where the source makes it"),
        "kind": Text("how it is judged", KINDS),
        "series": Text("whose figures are judged (default: the first series)"),
        "source": Text("which reported set it is held against (default: the first)"),
        "rows": List(Text(), "rows that it is about (default: all)"),
        "columns": List(Text(), "columns that it is about (default: all)"),
        "along": Text("trend, slope, optimum: in which direction", ("rows", "columns")),
        "direction": Text("trend: the figure rises or falls along", ("rises", "falls")),
        "min": Number("trend, rank: least rank correlation (default 0.8, 0.5)", -1, 1),
        "fit": Text("slope: exponent of a power law, or a straight line's change per unit, relative to its middle", ("power", "line")),
        "within": Number("near, slope: factor between the source's and ours (default 2); optimum: columns aside (default 0)", 0),
        "of": List(CELL, "ratio: the first divided by the second", 2, 2),
        "cell": CELL,
        "at_least": Number("ratio, bound"),
        "at_most": Number("ratio, bound"),
        "paper": Number("what the source says, where it says it in its text and not in the table"),
        "best": Text("optimum: which end of the figure is best", ("highest", "lowest")),
        "why": Object(
            {
                "text": Text("shown when the claim does not hold; {name} stands for a figure, {name:.1f} sets its digits"),
                "figures": Map(CELL, "measured figures of the run that the text rests on"),
            },
            ("text", "figures"),
            "why it may not hold here, with the figures that back it",
        ),
    },
    ("id", "text", "kind"),
)
MODE = Object(
    {
        "scale": Map(Number(low=0, high=1), "axis or parameter: its values are multiplied by this"),
        "set": Map(Any(), "JSON pointer into the config: its value instead"),
        "rows": List(Text(), "only rows of these scenes"),
        "filter": Text("only points whose key matches, as --filter of penumbra run"),
    }
)
AXIS = Object(
    {
        "axis": Text("a parameter of the points"),
        "values": List(Any(), "its values, one column each; column ids are the values as text"),
        "label": Text("the axis' name"),
    },
    ("axis", "values"),
)
TABLE = Object(
    {
        "id": Text("unique; `scripts/reproduce PAPER ID` runs it"),
        "title": Text("its name in the source"),
        "caption": Text("what it shows"),
        "config": Text("the sweep, a file beside paper.json"),
        "filter": Text("only points whose key matches, as --filter of penumbra run; a mode's own filter goes before it"),
        "figure": Text(ITEM_KEYS["figure"].about),
        "scale": ITEM_KEYS["scale"],
        "unit": ITEM_KEYS["unit"],
        "better": Text("which figures are better", ("higher", "lower")),
        "where": ITEM_KEYS["where"],
        "average_over": List(Text(), "parameters whose values are averaged, such as camera; times are averaged before fps"),
        "series": List(
            Object(
                {
                    "id": Text(),
                    "label": Text(),
                    "where": Map(Any(), "as elsewhere, for the techniques that have these parameters"),
                    "best_over": ITEM_KEYS["best_over"],
                },
                ("id", "label"),
            ),
            "tables of ours beside the source's, when there is more than one",
        ),
        "rows": List(Either((Text(), ITEM), "a key of /scenes, or an object"), "the table's rows"),
        "row_label": Text("what the rows are"),
        "columns": Either((List(ITEM), AXIS), "a list of columns, or an axis with values"),
        "reported": List(
            Object(
                {
                    "source": Text("a key of /sources"),
                    "place": Text("where in the source"),
                    "note": Text("how it was read, where that was not plain"),
                    "rows": Map(List(Number(null=True)), "row id: figures in the order of the columns"),
                },
                ("source", "place", "rows"),
            ),
            "the source's figures",
            0,
        ),
        "plot": Object(
            {
                "kind": Text("lines: along the columns, a panel for each row; rows: along the rows, a panel for each column", ("lines", "rows", "none")),
                "normalise": Text("both divided by their figure in this column (lines) or by their rows' mean (rows)"),
                "x_log": Text("", ("yes", "no")),
                "y_log": Text("", ("yes", "no")),
            }
        ),
        "pictures": Object(
            {
                "images": List(Text(), "names of images: shaded, error, reference/shaded, diagnostic_NAME"),
                "figures": List(Object({"label": Text(), "figure": Text(), "scale": Number()}, ("label", "figure")), "below each picture", 0),
            },
            ("images",),
            "pictures of the cells' points",
        ),
        "heat_map": Text("a counter that lists figures of a square grid row by row: drawn for each row"),
        "notes": List(Text(), "what a reader has to know of our side"),
        "claims": List(CLAIM, "what the source says that the table shows", 0),
        "short": MODE,
        "ci": MODE,
    },
    ("id", "title", "caption", "config", "rows", "columns"),
)
PAPER = Object(
    {
        "$schema": Text(),
        "key": Text("key in techniques/references.bib"),
        "title": Text("the paper's title"),
        "about": Text("hardware and setting of the source's figures"),
        "sources": Map(Text(), "what was read: an id and its description; numbers of one never stand under another"),
        "scenes": Map(
            Object(
                {
                    "label": Text("the source's name"),
                    "scene": Text("ours, a name under configs/scenes; without it there is none"),
                    "triangles": Number("in the source, where it says so", 1),
                    "note": Text("what stands for what, and what differs"),
                },
                ("label",),
            ),
            "the source's scenes and ours",
        ),
        "short": MODE,
        "ci": MODE,
        "tables": List(TABLE),
    },
    ("key", "title", "sources", "scenes", "tables"),
    title="a paper",
)


def schema():
    return {"$schema": "http://json-schema.org/draft-07/schema#", "title": "A paper to reproduce", **PAPER.schema()}


@dataclasses.dataclass
class Paper:
    name: str
    folder: pathlib.Path
    data: dict
    citation: dict

    def table(self, name):
        for table in self.data["tables"]:
            if table["id"] == name:
                return table
        ids = [t["id"] for t in self.data["tables"]]
        raise BadInput(f"{self.name}: no table '{name}', expected {one_of(ids)}.{nearest(name, ids)}")

    def scene_of(self, key):
        return self.data["scenes"][key].get("scene")


def papers():
    return sorted(p.parent.name for p in PAPERS.glob("*/paper.json"))


def citation(key, bibliography=ROOT / "techniques" / "references.bib"):
    """The fields of one entry of a BibTeX file."""
    text = bibliography.read_text(encoding="utf-8")
    entries = re.findall(r"@\w+\{([^,\s]+),(.*?)\n\}", text, re.S)
    keys = [k for k, _ in entries]
    if key not in keys:
        raise BadInput(f"{bibliography.name} has no entry '{key}'.{nearest(key, keys)}")
    body = dict(entries)[key]
    plain = lambda v: re.sub(r"[{}]", "", re.sub(r'\{\\"([a-z])\}|\\"([a-z])', lambda m: (m[1] or m[2]) + "\u0308", v))
    return {m[0]: " ".join(plain(m[1]).split()) for m in re.findall(r"(\w+)\s*=\s*\{((?:[^{}]|\{[^{}]*\})*)\}", body)}


def load(name, folder=PAPERS):
    path = folder / name / "paper.json"
    if not path.is_file():
        known = papers()
        raise BadInput(f"{name}: no such paper, expected {one_of(known + ['all'])}.{nearest(name, known)}")
    return read_paper(path)


def read_paper(path):
    from reproducing.checks import check_meaning

    node, errors = read_nodes(path), []
    PAPER.check(node, errors)
    if not errors:
        check_meaning(node, path.parent, errors)
    if errors:
        raise BadInput("\n".join(errors))
    data = node.plain()
    return Paper(path.parent.name, path.parent, data, citation(data["key"]))


def read_config(paper, table):
    return read_plain(paper.folder / table["config"])


def as_item(entry, scenes):
    if isinstance(entry, str):
        return {"id": entry, "label": scenes[entry]["label"], "scene": entry}
    return {"label": scenes[entry["scene"]]["label"] if "scene" in entry and "label" not in entry else entry["id"], **entry}


def text_of(value):
    if isinstance(value, list):
        return "x".join(text_of(v) for v in value)
    return f"{value:g}" if isinstance(value, float) else str(value).lower() if isinstance(value, bool) else str(value)


def size_of(value):
    """A value as a number, or None: [w, h] counts as its product (a resolution's own side is taken elsewhere)."""
    if isinstance(value, bool) or not isinstance(value, (int, float, list)):
        return None
    if isinstance(value, list):
        return float(value[0] * value[1]) if len(value) == 2 and all(isinstance(v, (int, float)) for v in value) else None
    return float(value)


def rows_of(table, scenes):
    return [as_item(entry, scenes) for entry in table["rows"]]


def columns_of(table, scenes):
    columns = table["columns"]
    if isinstance(columns, list):
        return [as_item(entry, scenes) for entry in columns]
    axis = columns["axis"]
    return [
        {"id": text_of(v), "label": text_of(v).replace("x", " × "), "where": {axis: v}, "x": size_of(v), "axis": axis}
        for v in columns["values"]
    ]


def shown(columns):
    return [c for c in columns if c.get("shown") != "no"]


def series_of(table):
    return table.get("series") or [{"id": "ours", "label": "Penumbra"}]
