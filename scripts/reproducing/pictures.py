"""Pictures of a table's cells, and heat maps of its counters, as data inside the page."""
import base64
import html
import io
import math

from reproducing.cells import figure_of
from reproducing.paper import shown
from reproducing.svg import number

NAMES = {"shaded": "", "error": "error (test − reference, full colour at 0.25)", "visibility": "visibility", "reference/shaded": "reference"}


def inlined(path):
    try:
        return "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode("ascii")
    except OSError:
        return None


def file_of(run, point, image):
    """The picture's file, or None; results may come from elsewhere, and name no file outside of their run."""
    name = (point.get("images") or {}).get(image.replace("/", "_"))
    if not name:
        return None
    path = (run.folder / name).resolve()
    return path if path.suffix == ".png" and path.is_relative_to(run.folder.resolve()) else None


def caption_of(point, figures):
    told = []
    for figure in figures:
        value, _ = figure_of(point, "timing.frame_ms" if figure["figure"] == "fps" else figure["figure"])
        value = 1000 / value if figure["figure"] == "fps" and value else value
        told.append(f"{figure['label']} {number(value * figure.get('scale', 1) if value is not None else None)}")
    return ", ".join(told)


def diagnostic_of(point, image):
    """The legend of a diagnostic picture, or None."""
    name = image.removeprefix("diagnostic_")
    return next((d for d in point.get("diagnostics") or [] if d.get("name") == name), None) if name != image else None


def legend_text(legend):
    if "high" in legend:
        return f"from none to {number(legend['high'])} (bright; logarithmic), median {number(legend['median'])}"
    return ""


def legend_key(legend):
    """Named colours: of classes, and of lines."""
    colours = legend.get("line_colors") or (legend.get("colors", []) if "names" in legend else [])
    named = zip(legend.get("names", []), colours)
    return "".join(f'<span class="swatch" style="background:{html.escape(colour)}"></span>{html.escape(name)} ' for name, colour in named)


def shot(data, title, small, alt, key=""):
    return (
        f'<figure><img src="{data}" alt="{html.escape(alt)}" loading="lazy"><figcaption>{html.escape(title)}'
        f"<small>{html.escape(small)}</small>{f'<small>{key}</small>' if key else ''}</figcaption></figure>"
    )


def strip_of(grid, run, row, series, image):
    """[(column, point, picture)]; what is the same for several columns stands once."""
    found, seen = [], set()
    for column in shown(grid.columns):
        points = grid.cell(series, row, column).points
        path = file_of(run, points[0], image) if points else None
        data = inlined(path) if path and path not in seen else None
        seen.add(path)
        if data:
            found.append((column, points[0], data))
    return found


def shots(grid, run):
    """A strip of pictures for each row, series and kind of picture."""
    wanted, out = grid.table["pictures"], []
    for row in grid.rows:
        for series in grid.series:
            for image in wanted["images"]:
                strip, title = [], NAMES.get(image, image)
                found = strip_of(grid, run, row, series, image)
                for column, point, data in found:
                    legend, caption, key = diagnostic_of(point, image), "", ""
                    if legend:
                        title, caption, key = legend["title"], legend_text(legend), legend_key(legend)
                    elif not image.startswith("reference"):
                        caption = caption_of(point, wanted.get("figures", []))
                    label = column["label"] if len(found) > 1 else ""
                    strip.append(shot(data, label, caption, f"{row['label']}, {column['label']}, {title or image}", key))
                if strip:
                    names = [row["label"], series["label"] if len(grid.series) > 1 else "", title]
                    out.append(f"<h3>{html.escape(', '.join(n for n in names if n))}</h3><div class='shots'>{''.join(strip)}</div>")
    return "".join(out)


def heat_map(values):
    """A square grid of counts as PNG data: dark is none, the scale is logarithmic."""
    import matplotlib

    matplotlib.use("Agg")
    import numpy
    from matplotlib import image

    side = math.isqrt(len(values))
    if side * side != len(values) or not side:
        return None
    grid = numpy.log1p(numpy.asarray(values, float).reshape(side, side))
    factor = max(1, 256 // side)
    buffer = io.BytesIO()
    image.imsave(buffer, numpy.kron(grid, numpy.ones((factor, factor))), cmap="inferno", format="png", metadata={"Software": None})
    return "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode("ascii")


def heat_maps(grid):
    strip = []
    for row in grid.rows:
        points = grid.cell(grid.series[0], row, grid.columns[0]).points
        values = (points[0].get("counters") or {}).get(grid.table["heat_map"]) if points else None
        data = heat_map(values) if isinstance(values, list) else None
        if data:
            strip.append(shot(data, row["label"], f"fullest cell {number(float(max(values)))}; dark: none; logarithmic", f"{row['label']}: heat map"))
    return f"<div class='shots crisp'>{''.join(strip)}</div>" if strip else ""
