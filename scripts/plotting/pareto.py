"""Error against time, with the front of what nothing else beats in both."""
from plotting.drawing import MARKERS, new_figure, style_of
from plotting.results import HIGHER_IS_BETTER, LINEAR, error_of, interval, label_of, median


def plot_pareto(options, points, metric, time, styles):
    points = [
        p
        for p in points
        if isinstance(error_of(p, metric), (int, float))
        and isinstance(median(p, time), (int, float))
        and median(p, time) > 0
    ]
    if not points:
        return None
    figure, axes = new_figure(options)
    entries = []
    for technique in dict.fromkeys(p["technique"] for p in points):
        own, style = [p for p in points if p["technique"] == technique], style_of(technique, styles)
        x = [median(p, time) for p in own]
        low, high = zip(*(interval(p, time) for p in own))
        spread = [
            [max(0, m - l) if l == l else 0 for m, l in zip(x, low)],
            [max(0, h - m) if h == h else 0 for m, h in zip(x, high)],
        ]
        bars = axes.errorbar(
            x,
            [error_of(p, metric) for p in own],
            xerr=spread,
            fmt=MARKERS[style["marker"]],
            color=style["colour"],
            elinewidth=0.8,
            label=style["label"],
        )
        entries.append(bars.lines[0])
        entries[-1].set_label(style["label"])
    if metric not in LINEAR or metric in HIGHER_IS_BETTER:
        sign, front = -1 if metric in HIGHER_IS_BETTER else 1, []
        for p in sorted(points, key=lambda p: (median(p, time), sign * error_of(p, metric))):
            if not front or sign * error_of(p, metric) < sign * error_of(front[-1], metric):
                front.append(p)
        axes.plot(
            [median(p, time) for p in front],
            [error_of(p, metric) for p in front],
            drawstyle="steps-post",
            color="0.6",
            linestyle=(0, (4, 3)),
            linewidth=0.9,
            zorder=0,
        )
    axes.set_xscale("log")
    axes.set(xlabel=label_of(time), ylabel=label_of(metric))
    return figure, axes, entries, [error_of(p, metric) for p in points]
