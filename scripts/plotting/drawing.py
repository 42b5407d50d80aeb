"""What all figures share: techniques' looks, axes, legends, files."""
import hashlib
import math
import pathlib
import re
import zlib

import matplotlib.pyplot as plt
from matplotlib import ticker

STYLES = pathlib.Path(__file__).resolve().parents[2] / "harness/report/assets/techniques.json"
MARKERS = {
    "circle": "o",
    "square": "s",
    "diamond": "D",
    "plus": "P",
    "triangle_down": "v",
    "cross": "X",
    "pentagon": "p",
    "star": "*",
    "triangle": "^",
    "hexagon": "h",
    "bowtie": "d",
}
DASHES = ["-", "--", ":", "-.", (0, (7, 2, 1, 2, 1, 2))]


def style_of(technique, styles):
    if technique in styles:
        return styles[technique]
    spare, number = styles[""], zlib.crc32(technique.encode())
    return {
        "label": technique.replace("_", " "),
        "colour": spare["colours"][number % len(spare["colours"])],
        "marker": spare["markers"][number // 64 % len(spare["markers"])],
    }


def wants_log(values, at_least=4):
    positive = [v for v in values if v > 0]
    return len(positive) == len(values) and positive and max(positive) / min(positive) >= at_least


def tidy_log(axis):
    """Plain numbers on a logarithmic axis, enough of them when it spans less than two decades."""
    low, high = axis.get_view_interval()
    narrow = high / low < 300
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5) if narrow else (1,), numticks=12))
    axis.set_minor_locator(ticker.NullLocator())
    axis.set_major_formatter(
        ticker.FuncFormatter(lambda v, _: f"{v:g}" if 1e-4 <= v < 1e6 else f"$10^{{{round(math.log10(v))}}}$")
    )


def legend_fits(lines):
    """Whether each line can have an entry of its own."""
    return len(lines) <= 14


def new_figure(options):
    figure, axes = plt.subplots(figsize=(options.width, options.width * 0.72), layout="constrained")
    axes.grid(True, which="major", axis="y")
    return figure, axes


def finish(figure, axes, entries, y_log):
    if y_log:
        axes.set_yscale("log")
        tidy_log(axes.yaxis)
    if axes.get_xscale() == "log" and not axes.xaxis.get_major_locator().__class__.__name__.startswith(
        "Fixed"
    ):
        tidy_log(axes.xaxis)
    if len(entries) > 1:
        figure.legend(
            handles=entries,
            loc="upper center",
            bbox_to_anchor=(0.5, 0),
            ncol=1 if max(len(e.get_label()) for e in entries) > 34 else 2,
        )


def file_name(*parts):
    """Readable where the parts are plain; else with a hash, so that different names stay different files."""
    plain = "-".join(re.sub(r"[^A-Za-z0-9_.]+", "_", part) for part in parts)
    return (
        plain
        if plain == "-".join(parts)
        else f"{plain}-{hashlib.sha256('/'.join(parts).encode()).hexdigest()[:8]}"
    )


def write_whole(path, write):
    """A file whole or not at all: a full disk leaves no torn figure, nor one in place of an older one."""
    temporary = path.with_name(path.name + ".new")
    try:
        write(temporary)
        temporary.replace(path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise OSError(error.errno, error.strerror, str(path)) from error


def save(figure, folder, name):
    paths = []
    for kind, metadata in (
        ("pdf", {"CreationDate": None, "Producer": None, "Creator": None}),
        ("svg", {"Date": None, "Creator": None}),
    ):
        paths.append(folder / f"{name}.{kind}")
        write_whole(paths[-1], lambda path: figure.savefig(path, format=kind, metadata=metadata))
    plt.close(figure)
    return paths
