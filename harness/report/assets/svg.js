// SVG elements, the techniques' markers, and ticks.
(() => {
  P.svg = (tag, attributes = {}, ...children) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes))
      if (value !== null && value !== undefined) made.setAttribute(name, value);
    made.append(...children);
    return made;
  };

  const polygon = (corners, turn, radius = 1) =>
    Array.from({ length: corners }, (_, i) => {
      const angle = turn + (2 * Math.PI * i) / corners;
      return [radius * Math.sin(angle), -radius * Math.cos(angle)];
    });
  const path = (points) => "M" + points.map(([x, y]) => `${x.toFixed(3)},${y.toFixed(3)}`).join("L") + "Z";
  const star = polygon(5, 0, 1.25).flatMap((tip, i) => [tip, polygon(5, Math.PI / 5, 0.55)[i]]);
  const plus = [
    [-0.35, -1.1],
    [0.35, -1.1],
    [0.35, -0.35],
    [1.1, -0.35],
    [1.1, 0.35],
    [0.35, 0.35],
    [0.35, 1.1],
    [-0.35, 1.1],
    [-0.35, 0.35],
    [-1.1, 0.35],
    [-1.1, -0.35],
    [-0.35, -0.35],
  ];
  const turned = plus.map(([x, y]) => [(x - y) * Math.SQRT1_2, (x + y) * Math.SQRT1_2]);
  const shapes = {
    circle: "M1,0A1,1 0 1 1 -1,0A1,1 0 1 1 1,0Z",
    square: path([
      [-0.88, -0.88],
      [0.88, -0.88],
      [0.88, 0.88],
      [-0.88, 0.88],
    ]),
    diamond: path(polygon(4, 0, 1.22)),
    triangle: path(polygon(3, 0, 1.22)),
    triangle_down: path(polygon(3, Math.PI, 1.22)),
    pentagon: path(polygon(5, 0, 1.08)),
    hexagon: path(polygon(6, Math.PI / 6, 1.08)),
    star: path(star),
    plus: path(plus),
    cross: path(turned),
    bowtie: path([
      [-1, -1],
      [0, -0.15],
      [1, -1],
      [1, 1],
      [0, 0.15],
      [-1, 1],
    ]),
  };
  // The marker's outline with unit radius, to be placed by a transform.
  P.marker_path = (technique) => shapes[P.style(technique).marker] ?? shapes.circle;
  P.marker_icon = (technique) =>
    P.svg(
      "svg",
      { viewBox: "-1.5 -1.5 3 3", class: "marker", "aria-hidden": "true" },
      P.svg("path", { d: P.marker_path(technique), fill: P.colour(technique) }),
    );

  const linear_ticks = (lo, hi, count) => {
    const raw = (hi - lo) / count,
      power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw);
    const ticks = [];
    for (let i = Math.ceil(lo / step - 1e-9); i * step <= hi + step * 1e-9; ++i)
      ticks.push(Number((i * step).toPrecision(12)));
    return ticks;
  };
  const log_ticks = (lo, hi) => {
    const decades = Math.log10(hi / lo);
    const steps = decades > 3 ? [1] : decades > 1.2 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 7];
    const stride = Math.max(1, Math.ceil(decades / 7));
    const ticks = [];
    for (let e = Math.floor(Math.log10(lo)) - 1; e <= Math.log10(hi) + 1; ++e) {
      if (steps.length === 1 && ((e % stride) + stride) % stride !== 0) continue;
      for (const m of steps) {
        const tick = Number(`${m}e${e}`);
        if (tick >= lo * (1 - 1e-9) && tick <= hi * (1 + 1e-9)) ticks.push(tick);
      }
    }
    return ticks;
  };

  // A scale: position(value) in [0, 1], ticks [[value, text]]. `exact`: few values that are ticks themselves.
  P.scale = (kind, values, exact = null) => {
    if (kind === "ordinal") {
      const at = new Map(exact.map((value, i) => [JSON.stringify(value), (i + 0.5) / exact.length]));
      return {
        position: (v) => at.get(JSON.stringify(v)) ?? NaN,
        ticks: exact.map((v) => [v, P.value_text(v)]),
      };
    }
    const log = kind === "log";
    const finite = values.filter((v) => Number.isFinite(v) && (!log || v > 0));
    let lo = Math.min(...finite),
      hi = Math.max(...finite);
    if (!finite.length) [lo, hi] = log ? [1, 10] : [0, 1];
    if (log) {
      const pad = Math.max((hi / lo) ** 0.06, hi === lo ? 2 : 1.04);
      [lo, hi] = [lo / pad, hi * pad];
      const span = Math.log(hi / lo);
      const ticks = (exact?.length <= 8 ? exact : log_ticks(lo, hi)).map((t) => [t, P.number(t, 3)]);
      return { position: (v) => (v > 0 ? Math.log(v / lo) / span : NaN), ticks };
    }
    const pad = (hi - lo || Math.abs(hi) || 1) * 0.06;
    lo = lo >= 0 && lo - pad < 0 ? 0 : lo - pad;
    hi += pad;
    const ticks = (exact?.length <= 8 ? exact : linear_ticks(lo, hi, 5)).map((t) => [t, P.number(t, 3)]);
    return { position: (v) => (v - lo) / (hi - lo), ticks };
  };
})();
