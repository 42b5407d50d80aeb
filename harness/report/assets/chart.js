// One panel: points with confidence intervals, the lines that join a series, and a front. Drawn as SVG.
//   options: { title, x, y: { label, scale }, series: [{ technique, points: [{ x, y, lo, hi, point }], line }], front: [{x, y}] }
(() => {
  const W = 460,
    H = 330,
    left = 66,
    right = 14,
    top = 30,
    bottom = 46;
  const px = (t) => left + t * (W - left - right);
  const py = (t) => H - bottom - t * (H - top - bottom);
  const text = (x, y, content, more = {}) => P.svg("text", { x, y, ...more }, content);

  const axes = (x, y) => {
    const group = P.svg("g", { class: "axes" });
    for (const [value, label] of y.scale.ticks) {
      const at = py(y.scale.position(value));
      group.append(
        P.svg("line", { x1: left, x2: W - right, y1: at, y2: at, class: "grid" }),
        text(left - 7, at + 4, label, { class: "tick", "text-anchor": "end" }),
      );
    }
    let last_end = -Infinity;
    for (const [value, label] of x.scale.ticks) {
      const at = px(x.scale.position(value)),
        half = label.length * 3.4;
      group.append(P.svg("line", { x1: at, x2: at, y1: H - bottom, y2: H - bottom + 4, class: "axis" }));
      if (at - half < last_end + 4) continue; // labels that would touch
      last_end = at + half;
      group.append(text(at, H - bottom + 18, label, { class: "tick", "text-anchor": "middle" }));
    }
    group.append(
      P.svg("line", { x1: left, x2: W - right, y1: H - bottom, y2: H - bottom, class: "axis" }),
      text((left + W - right) / 2, H - 8, x.label, { class: "axis-label", "text-anchor": "middle" }),
      text(0, 0, y.label, {
        class: "axis-label",
        "text-anchor": "middle",
        transform: `translate(13 ${(top + H - bottom) / 2}) rotate(-90)`,
      }),
    );
    return group;
  };

  // Lines of one technique are told apart by their dashes.
  P.dashes = [null, "7 4", "2 3", "9 3 2 3", "14 4"];

  P.chart = ({ title, x, y, series, front }) => {
    const at = (p) => [px(x.scale.position(p.x)), py(y.scale.position(p.y))];
    const visible = (p) => at(p).every(Number.isFinite);
    const y_of = (value, fallback) => {
      const t = y.scale.position(value);
      return py(Number.isFinite(t) ? Math.min(1.02, Math.max(-0.02, t)) : fallback);
    };
    const root = P.svg("svg", {
      viewBox: `0 0 ${W} ${H}`,
      class: "chart",
      role: "img",
      "aria-label": `${title}: ${y.label} against ${x.label}`,
    });
    root.append(text(left, 17, title, { class: "chart-title" }), axes(x, y));
    const drawn = series
      .map((s) => ({ ...s, points: s.points.filter(visible) }))
      .filter((s) => s.points.length);
    if (!drawn.length)
      root.append(
        text((left + W - right) / 2, H / 2, "no such values here", {
          class: "tick",
          "text-anchor": "middle",
        }),
      );
    const faint = drawn.length > 24 ? 0.35 : 0.9;
    if (front?.length > 1) {
      const steps = front.filter(visible).map(at);
      root.append(
        P.svg("path", {
          class: "front",
          d:
            "M" + steps.map(([a, b], i) => (i ? `${a},${steps[i - 1][1]}L${a},${b}` : `${a},${b}`)).join("L"),
        }),
      );
    }
    // Equal masks give equal errors: what lies below is drawn larger, so that it still shows round what lies on it.
    const order = P.unique(drawn.map((s) => s.technique)),
      above = (s) => Math.min(3, order.length - 1 - order.indexOf(s.technique));
    for (const s of drawn) {
      const colour = P.colour(s.technique);
      const line = s.line && s.points.length > 1;
      if (line && s.points.every((p) => Number.isFinite(p.lo) && Number.isFinite(p.hi))) {
        const upper = s.points.map((p) => `${at(p)[0]},${y_of(p.hi, 1)}`);
        const lower = s.points.map((p) => `${at(p)[0]},${y_of(p.lo, 0)}`).reverse();
        root.append(P.svg("path", { d: `M${[...upper, ...lower].join("L")}Z`, fill: colour, class: "band" }));
      }
      if (line)
        root.append(
          P.svg("path", {
            d: "M" + s.points.map((p) => at(p).join(",")).join("L"),
            stroke: colour,
            class: "line",
            "stroke-width": 1.7 + 0.9 * above(s),
            opacity: faint,
            "stroke-dasharray": P.dashes[s.variant % P.dashes.length],
          }),
        );
      for (const p of s.points) {
        const [cx, cy] = at(p);
        if (!line && Number.isFinite(p.lo) && Number.isFinite(p.hi))
          root.append(
            P.svg(
              "line",
              p.interval_on_x
                ? {
                    x1: px(x.scale.position(p.lo)),
                    x2: px(x.scale.position(p.hi)),
                    y1: cy,
                    y2: cy,
                    stroke: colour,
                    class: "interval",
                  }
                : { x1: cx, x2: cx, y1: y_of(p.lo, 0), y2: y_of(p.hi, 1), stroke: colour, class: "interval" },
            ),
          );
        const mark = P.svg("path", {
          d: P.marker_path(s.technique),
          transform: `translate(${cx} ${cy}) scale(${4.3 + 0.9 * above(s)})`,
          fill: colour,
          class: "mark",
          "data-point": p.point.index,
        });
        root.append(mark);
      }
    }
    return root;
  };

  // Points that no other beats in both: least time and least error.
  P.pareto_front = (points) => {
    const front = [];
    for (const p of [...points].sort((a, b) => a.x - b.x || a.y - b.y))
      if (!front.length || p.y < front[front.length - 1].y) front.push(p);
    return front;
  };

  const tip = () => document.getElementById("tip");
  const show_tip = (mark, describe) => {
    const box = tip();
    box.replaceChildren(...describe(P.points[Number(mark.dataset.point)]));
    box.hidden = false;
    const r = mark.getBoundingClientRect();
    const x = Math.min(
      Math.max(8, r.left + r.width / 2 - box.offsetWidth / 2),
      innerWidth - box.offsetWidth - 8,
    );
    const above = r.top - box.offsetHeight - 8;
    box.style.left = `${x + scrollX}px`;
    box.style.top = `${(above > 0 ? above : r.bottom + 8) + scrollY}px`;
  };
  // Tooltips and clicks of all marks within `host`.
  P.make_marks_live = (host, describe) => {
    host.addEventListener("pointerover", (event) => {
      const mark = event.target.closest?.(".mark");
      if (mark) show_tip(mark, describe);
      else tip().hidden = true;
    });
    host.addEventListener("pointerleave", () => {
      tip().hidden = true;
    });
    host.addEventListener("click", (event) => {
      const mark = event.target.closest?.(".mark");
      if (mark) ((tip().hidden = true), P.show_details(P.points[Number(mark.dataset.point)]));
    });
  };
})();
