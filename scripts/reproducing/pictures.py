"""Pictures of a table's cells, and heat maps of its counters, as data inside the page."""
import base64
import html
import io
import math

from reproducing.cells import figure_of
from reproducing.paper import shown
from reproducing.svg import number

NAMES = {"shaded": "", "error": "error (test − reference, full colour at 0.25)", "visibility": "visibility", "reference_shaded": "reference"}


def inlined(path):
    try:
        return "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode("ascii")
    except OSError:
        return None


def picture(run, point, image):
    """The picture's data, or None; results may come from elsewhere, and name no file outside of their run."""
    name = (point.get("images") or {}).get(image)
    if not name:
        return None
    path = (run.folder / name).resolve()
    return inlined(path) if path.suffix == ".png" and path.is_relative_to(run.folder.resolve()) else None


def caption_of(point, figures):
    told = []
    for figure in figures:
        value, _ = figure_of(point, "timing.frame_ms" if figure["figure"] == "fps" else figure["figure"])
        value = 1000 / value if figure["figure"] == "fps" and value else value
        told.append(f"{figure['label']} {number(value * figure.get('scale', 1) if value is not None else None)}")
    return ", ".join(told)


def shot(data, title, small, alt):
    return (
        f'<figure><img src="{data}" alt="{html.escape(alt)}" loading="lazy"><figcaption>{html.escape(title)}'
        f"<small>{html.escape(small)}</small></figcaption></figure>"
    )


def shots(grid, run):
    """A strip of pictures for each row, series and kind of picture."""
    wanted, out = grid.table["pictures"], []
    for row in grid.rows:
        for series in grid.series:
            for image in wanted["images"]:
                strip = []
                for column in shown(grid.columns):
                    points = grid.cell(series, row, column).points
                    data = picture(run, points[0], image) if points else None
                    if data:
                        caption = caption_of(points[0], wanted.get("figures", []))
                        strip.append(shot(data, column["label"], caption, f"{row['label']}, {column['label']}, {image}"))
                    if image.startswith("reference") and strip:
                        break
                if strip:
                    names = [row["label"], series["label"] if len(grid.series) > 1 else "", NAMES.get(image, image)]
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
