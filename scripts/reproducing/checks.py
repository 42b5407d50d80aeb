"""What the grammar cannot say: ids that are unique and names that exist."""
import string

from reproducing.paper import columns_of, rows_of, series_of, shown
from reproducing.reading import nearest, one_of

NEEDS = {
    "trend": ("along", "direction"),
    "rank": (),
    "near": (),
    "slope": ("along", "fit"),
    "ratio": ("of",),
    "bound": ("cell",),
    "optimum": ("along", "best"),
}
OWN = {  # keys that only these kinds have
    "direction": ("trend",),
    "along": ("trend", "slope", "optimum"),
    "min": ("trend", "rank"),
    "fit": ("slope",),
    "within": ("near", "slope", "optimum"),
    "of": ("ratio",),
    "cell": ("bound",),
    "at_least": ("ratio", "bound"),
    "at_most": ("ratio", "bound"),
    "best": ("optimum",),
}


class Checker:
    def __init__(self, errors):
        self.errors = errors

    def name(self, node, names, what):
        if node.value not in names:
            known = one_of(names) if len(names) <= 12 else f"the name of {what}"
            self.errors.append(
                f"{node.place}: {node.pointer}: unknown {what} '{node.value}', expected {known}.{nearest(node.value, names)}"
            )

    def unique(self, nodes, key):
        seen = set()
        for node in nodes:
            child = node.value[key]
            if child.value in seen:
                self.errors.append(f"{child.place}: {child.pointer}: '{child.value}' stands here twice")
            seen.add(child.value)

    def say(self, node, message):
        self.errors.append(f"{node.place}: {node.pointer}: {message}")


def check_meaning(root, folder, errors):
    from reproducing.paper import ROOT, citation
    from reproducing.reading import BadInput

    check, scenes = Checker(errors), root.value["scenes"]
    try:
        citation(root.value["key"].value)
    except BadInput as error:
        check.say(root.value["key"], str(error))
    for scene in scenes.value.values():
        if "scene" in scene.value:
            known = sorted(p.stem for p in (ROOT / "configs" / "scenes").glob("*.json"))
            check.name(scene.value["scene"], known, "scene")
    check.unique(root.value["tables"].value, "id")
    for table in root.value["tables"].value:
        check_table(table, root, folder, check)


def check_table(table, root, folder, check):
    scenes, keys = root.value["scenes"].value, table.value
    if not (folder / keys["config"].value).is_file():
        known = sorted(p.name for p in folder.glob("*.json") if p.name != "paper.json")
        check.name(keys["config"], known, "config beside paper.json")
    lists = [keys["rows"]] + ([keys["columns"]] if isinstance(keys["columns"].value, list) else [])
    for entries in lists:
        for entry in entries.value:
            node = entry if isinstance(entry.value, str) else entry.value.get("scene")
            if node is not None and node.value not in scenes:
                check.name(node, list(scenes), "scene of this paper")
                return
    plain, plain_scenes = table.plain(), root.value["scenes"].plain()
    rows, columns = ([i["id"] for i in of(plain, plain_scenes)] for of in (rows_of, columns_of))
    names = {"row": rows, "column": columns, "series": [s["id"] for s in series_of(plain)]}
    for what in ("row", "column"):
        for name in {n for n in names[what] if names[what].count(n) > 1}:
            check.say(keys[what + "s"], f"the {what} '{name}' stands here twice")
    if isinstance(keys["columns"].value, list):
        for column in keys["columns"].value:
            for other in column.value["ratio"].value if "ratio" in column.value else []:
                check.name(other, columns, "column")
    told = len(shown(columns_of(plain, plain_scenes)))
    for reported in keys["reported"].value if "reported" in keys else []:
        check.name(reported.value["source"], list(root.value["sources"].value), "source")
        for row, figures in reported.value["rows"].value.items():
            if row not in rows:
                check.say(figures, f"unknown row '{row}', expected {one_of(rows)}.{nearest(row, rows)}")
            elif len(figures.value) != told:
                check.say(figures, f"found {len(figures.value)} figures, expected {told}, one for each column that is shown")
    if "claims" in keys:
        check.unique(keys["claims"].value, "id")
        sources = [r["source"] for r in plain.get("reported", [])]
        for claim in keys["claims"].value:
            check_claim(claim, names, sources, check)


def check_cell(cell, names, check):
    for what, known in names.items():
        if what in cell.value:
            check.name(cell.value[what], known, what)


def check_claim(claim, names, sources, check):
    keys, kind = claim.value, claim.value["kind"].value
    for key in NEEDS[kind]:
        if key not in keys:
            check.say(claim, f"a claim of kind '{kind}' needs '{key}'")
    for key, kinds in OWN.items():
        if key in keys and kind not in kinds:
            check.say(keys[key], f"a claim of kind '{kind}' has no '{key}'; expected with {one_of(kinds)}")
    if kind in ("ratio", "bound") and not {"at_least", "at_most"} & set(keys):
        check.say(claim, f"a claim of kind '{kind}' needs 'at_least' or 'at_most'")
    for what in ("row", "column"):
        for name in keys[what + "s"].value if what + "s" in keys else []:
            check.name(name, names[what], what)
    if "series" in keys:
        check.name(keys["series"], names["series"], "series")
    if "source" in keys:
        check.name(keys["source"], sources, "source with figures in this table")
    cells = list(keys["of"].value) if "of" in keys else []
    cells += [keys["cell"]] if "cell" in keys else []
    if "why" in keys:
        if not keys["why"].value["figures"].value:
            check.say(keys["why"], "needs at least one measured figure that backs it")
        known = list(keys["why"].value["figures"].value)
        for part in string.Formatter().parse(keys["why"].value["text"].value):
            if part[1] is not None and part[1] not in known:
                check.say(keys["why"].value["text"], f"unknown figure '{part[1]}', expected {one_of(known)}.{nearest(part[1], known)}")
        for name, cell in keys["why"].value["figures"].value.items():
            check_cell(cell, names, check)
            for what in ("row", "column"):
                if what not in cell.value:
                    check.say(cell, f"the figure '{name}' needs a '{what}'")
    for cell in cells:
        check_cell(cell, names, check)
