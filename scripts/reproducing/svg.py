"""Charts as SVG text whose colours are the page's (classes), so that they follow light, dark and print."""
import html
import math

WIDTH, HEIGHT = 420, 270
LEFT, RIGHT, TOP, BOTTOM = 56, 12, 30, 44
MARKERS = {
    "circle": '<circle r="4"/>',
    "square": '<rect x="-3.6" y="-3.6" width="7.2" height="7.2"/>',
    "diamond": '<path d="M0-5L5 0 0 5-5 0Z"/>',
    "triangle": '<path d="M0-5L4.8 4H-4.8Z"/>',
    "cross": '<path d="M-4-4L4 4M-4 4L4-4" class="open"/>',
}


def number(value):
    """Three digits, as people write them."""
    if value is None:
        return "–"
    if isinstance(value, str):
        return value
    if not math.isfinite(value):
        return "–"
    size = abs(value)
    if size >= 1000:
        return f"{value:,.0f}"
    if size == 0 or 0.001 <= size:
        return f"{value:.3g}" if size < 100 else f"{value:.0f}"
    return f"{value:.1e}"


def linear_ticks(low, high, most=6):
    span = high - low or abs(high) or 1
    step = 10 ** math.floor(math.log10(span / most))
    step = next(step * k for k in (1, 2, 5, 10) if span / (step * k) <= most)
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def log_ticks(low, high):
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    span = math.log10(high / low)
    steps = (1, 2, 3, 5) if span < 1 else (1, 2, 5) if span < 2.2 else (1, 3) if span < 4 else (1,)
    ticks = lambda subs: [s * 10.0**d for d in decades for s in subs if low * 0.999 <= s * 10.0**d <= high * 1.001]
    return next((t for t in (ticks(steps), ticks((1, 1.5, 2, 3, 4, 5, 7))) if len(t) >= 3), None) or linear_ticks(low, high)


class Scale:
    def __init__(self, values, start, end, log):
        values = [v for v in values if v is not None and math.isfinite(v)]
        self.log = log and values and min(values) > 0
        low, high = (min(values), max(values)) if values else (0, 1)
        if self.log:
            pad = (high / low) ** 0.06 if high > low else 1.3
            low, high = low / pad, high * pad
        else:
            pad = 0.07 * (high - low) or abs(high) * 0.1 or 1
            low, high = (0 if 0 <= low < 0.5 * high else low - pad), high + pad
        self.low, self.high, self.start, self.end = low, high, start, end

    def ticks(self):
        return log_ticks(self.low, self.high) if self.log else linear_ticks(self.low, self.high)

    def __call__(self, value):
        if self.log:
            share = math.log(value / self.low) / math.log(self.high / self.low)
        else:
            share = (value - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)


def text(x, y, content, classes, anchor="middle", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" class="{classes}" text-anchor="{anchor}"{more}>{html.escape(str(content))}</text>'


def chart(title, lines, x_places, x_labels, y_log, y_label, x_label="", x_log=False, joined=True):
    """lines: [{name, look, marker, values: one or None for each place, intervals: (low, high) or None for each}]."""
    every = [v for line in lines for v in line["values"] if v is not None]
    every += [v for line in lines for i in line.get("intervals", []) if i for v in i if not y_log or v > 0]
    if not every:
        return ""
    y = Scale(every, HEIGHT - BOTTOM, TOP, y_log)
    x = Scale(x_places, LEFT + 14, WIDTH - RIGHT - 14, x_log)
    if not x.log:
        x.low, x.high = min(x_places), max(x_places) if max(x_places) > min(x_places) else min(x_places) + 1
    else:
        x.low, x.high = min(x_places), max(x_places) if max(x_places) > min(x_places) else 2 * min(x_places)
    out = [f'<svg class="chart" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{html.escape(title)}">']
    out.append(text(LEFT - 40, 14, title, "chart-title", "start"))
    for tick in y.ticks():
        out.append(f'<path class="grid" d="M{LEFT} {y(tick):.1f}H{WIDTH - RIGHT}"/>')
        out.append(text(LEFT - 7, y(tick) + 4, f"{tick:g}" if tick < 1e5 else f"{tick:.0e}", "tick", "end"))
    out.append(f'<path class="axis" d="M{LEFT} {HEIGHT - BOTTOM}H{WIDTH - RIGHT}"/>')
    ends = [-1e9, -1e9]  # of the labels in two rows: names that do not fit beside each other take turns
    for place, label in sorted(zip(x_places, x_labels)):
        width = 7.2 * len(label)
        left = min(x(place) - width / 2, WIDTH - width)
        row = next((r for r in (0, 1) if left >= ends[r]), None)
        if row is None or (row == 1 and x.log):
            continue
        ends[row] = left + width + 4
        out.append(text(left + width / 2, HEIGHT - BOTTOM + 14 + 12 * row, label, "tick"))
    if x_label:
        out.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, x_label, "axis-label"))
    middle = (TOP + HEIGHT - BOTTOM) / 2
    out.append(text(13, middle, y_label, "axis-label", more=f' transform="rotate(-90 13 {middle:.1f})"'))
    for number_of_line, line in enumerate(lines):
        out += drawn_line(line, x_places, x, y, joined, (number_of_line - (len(lines) - 1) / 2) * (0 if joined else 9))
    return "".join(out) + "</svg>"


def drawn_line(line, x_places, x, y, joined, shift):
    points = [(x(p) + shift, y(v), v, i) for p, v, i in zip(x_places, line["values"], line.get("intervals") or [None] * len(x_places))
              if v is not None and (not y.log or v > 0)]
    points.sort()
    out = [f'<g class="{line["look"]}">']
    if joined and len(points) > 1:
        out.append('<path class="line" d="M' + "L".join(f"{a:.1f} {b:.1f}" for a, b, _, _ in points) + '"/>')
    for a, b, value, interval in points:
        if interval and (not y.log or interval[0] > 0):
            out.append(f'<path class="interval" d="M{a:.1f} {y(interval[0]):.1f}V{y(interval[1]):.1f}"/>')
        tip = f"{line['name']}: {number(value)}" + (f" [{number(interval[0])}, {number(interval[1])}]" if interval else "")
        out.append(f'<g class="mark" transform="translate({a:.1f} {b:.1f})">{MARKERS[line["marker"]]}<title>{html.escape(tip)}</title></g>')
    return out + ["</g>"]
