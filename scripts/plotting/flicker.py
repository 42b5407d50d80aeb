"""How much the error of moving sequences changes from frame to frame: a bar for each technique and variant."""
import matplotlib.pyplot as plt

from plotting.along_axis import series_along
from plotting.drawing import style_of
from plotting.results import error_of, param, text


def situations(points):
    """[(camera and light, points)]: what moves is in them."""
    groups = {}
    for p in points:
        groups.setdefault((param(p, "camera"), param(p, "light")), []).append(p)
    return list(groups.items())


def label_of_bar(technique, name, styles):
    label = style_of(technique, styles)["label"]
    return f"{label}, {name}" if name else label


def plot_flicker(options, points, swept, styles):
    """Bars of the sequences' summaries; None when no sequence has a flicker."""
    summaries = [
        p
        for p in points
        if p["status"] == "ok"
        and "frame" in p
        and p["frame"] is None
        and isinstance(error_of(p, "flicker"), (int, float))
    ]
    if not summaries:
        return None
    moving = situations(summaries)
    keys = [k for k in swept if k not in ("camera", "light", "frame")]
    bars = {}  # label -> (technique, {situation: flicker})
    for technique, name, _, group in series_along(summaries, None, keys):
        for p in group:
            row = bars.setdefault(label_of_bar(technique, name, styles), (technique, {}))
            row[1][(param(p, "camera"), param(p, "light"))] = error_of(p, "flicker")
    figure, panels = plt.subplots(
        1,
        len(moving),
        sharey=True,
        squeeze=False,
        figsize=(options.width * (0.7 + 0.65 * len(moving)), 0.5 + 0.19 * len(bars)),
        layout="constrained",
    )
    labels = list(bars)[::-1]
    for axes, ((camera, light), _) in zip(panels[0], moving):
        values = [bars[label][1].get((camera, light)) for label in labels]
        colours = [style_of(bars[label][0], styles)["colour"] for label in labels]
        axes.barh(range(len(labels)), [v or 0 for v in values], color=colours, height=0.7)
        for i, v in enumerate(values):
            axes.annotate(
                "–" if v is None else f"{v:.2g}",
                (v or 0, i),
                (3, 0),
                textcoords="offset points",
                va="center",
                fontsize=6,
            )
        axes.set_title(f"camera {text(camera)}, light {text(light)}", fontsize=8)
        axes.set_yticks(range(len(labels)), labels)
        axes.margins(x=0.18)
        axes.grid(True, axis="x")
        axes.set_xlabel("flicker")
    return figure
