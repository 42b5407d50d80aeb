"""Time or error along a swept axis."""
import collections
import json

from matplotlib import ticker

from plotting.drawing import DASHES, MARKERS, legend_fits, new_figure, style_of, wants_log
from plotting.results import param, size, text, values_of


def short_name(point, keys, usual):
    """What tells a line from the others: of many parameters only those that are not as usual."""
    told = [k for k in keys if param(point, k) is not None]
    if len(told) > 2:
        told = [k for k in told if json.dumps(param(point, k)) != usual[k]] or told
    return ", ".join(f"{k.replace('_', ' ')} {text(param(point, k))}" for k in told)


def series_along(points, axis, swept):
    """[(technique, variant text, number of the variant, its points)]: lines whose points differ in `axis` alone."""
    lines = []
    for technique in dict.fromkeys(p["technique"] for p in points):
        own = [p for p in points if p["technique"] == technique]
        keys = [k for k in swept if k != axis and len(values_of(own, k)) > 1]
        counts = {k: collections.Counter(json.dumps(param(p, k)) for p in own) for k in keys}
        usual = {k: counts[k].most_common(1)[0][0] for k in keys}
        groups = {}
        for p in own:
            groups.setdefault(json.dumps([param(p, k) for k in keys]), []).append(p)
        lines += [
            (technique, short_name(group[0], keys, usual), number, group)
            for number, group in enumerate(groups.values())
        ]
    return lines


def style_of_line(technique, number, order, styles):
    """Colour and marker, width and size: a technique's own, or where it is alone, its variants'."""
    style = style_of(technique, styles)
    if len(order) == 1:
        spare = styles[""]
        marker = spare["markers"][number % len(spare["markers"])]
        return {**style, "colour": spare["colours"][number % len(spare["colours"])], "marker": marker}, 1.2, 4
    # Equal masks give equal errors: what lies below is drawn larger, so that it still shows.
    above = min(3, len(order) - 1 - order.index(technique))
    return style, 1.2 + 0.6 * above, 4 + 0.9 * above


def plot_axis(options, points, axis, swept, value, spread, label, styles):
    """Returns a figure, or None when there is nothing to draw."""
    points = [p for p in points if param(p, axis) is not None and isinstance(value(p), (int, float))]
    values = values_of(points, axis)
    if len(values) < 2:
        return None
    numbers = [size(v) for v in values]
    ordinal = any(n is None for n in numbers) or len(set(numbers)) < len(numbers)
    place = {json.dumps(v): i if ordinal else n for i, (v, n) in enumerate(zip(values, numbers))}
    figure, axes = new_figure(options)
    lines, entries = series_along(points, axis, swept), []
    order = list(dict.fromkeys(technique for technique, *_ in lines))
    for technique, name, number, group in lines:
        style, line_width, marker_size = style_of_line(technique, number, order, styles)
        group = sorted(group, key=lambda p: place[json.dumps(param(p, axis))])
        x = [place[json.dumps(param(p, axis))] for p in group]
        named = legend_fits(lines)
        label_of_line = (
            name
            if named and name and len(order) == 1
            else style["label"] + (f", {name}" if named and name else "")
        )
        (line,) = axes.plot(
            x,
            [value(p) for p in group],
            linestyle=DASHES[number % len(DASHES)],
            color=style["colour"],
            marker=MARKERS[style["marker"]],
            linewidth=line_width,
            markersize=marker_size,
            label=label_of_line,
        )
        low, high = zip(*(spread(p) for p in group))
        axes.fill_between(x, low, high, color=style["colour"], alpha=0.18, linewidth=0)
        if named or number == 0:
            entries.append(line)
    if not ordinal and wants_log(numbers):
        axes.set_xscale("log")
    if ordinal or len(values) <= 8:
        axes.set_xticks(list(place.values()), [text(v) for v in values])
        axes.xaxis.set_minor_locator(ticker.NullLocator())
    axes.set(xlabel=axis.replace("_", " "), ylabel=label)
    return figure, axes, entries, [value(p) for p in points]
