// The plot cards: time against an axis, error against time, error against an axis; one panel per scene.
(() => {
  const quantities = () =>
    P.columns.filter((c) => c.numeric && !c.param && P.points.some((p) => typeof c.get(p) === "number"));
  const times = () => quantities().filter((c) => c.group === "timing");
  const errors = () => quantities().filter((c) => c.group.endsWith("reference"));
  const speed_up = () => ({ key: "speed_up", label: P.label("speed_up"), get: P.speed_up });
  const axis_of = (column) =>
    column.key === "frame_ms" ? "time per frame (ms)" : P.label_with_unit(column.key);

  // A sequence has a point per frame and a summary: against the frame the former count, otherwise the latter alone.
  const eligible = (axis) => {
    const summarised = new Set(P.shown.filter((p) => p.frame === null).map((p) => p.scene + p.technique));
    return P.shown.filter(
      (p) =>
        p.status === "ok" &&
        (axis === "frame"
          ? (p.frame ?? null) !== null
          : (p.frame ?? null) === null || !summarised.has(p.scene + p.technique)),
    );
  };

  // The combinations of the other parameters that each technique has, numbered in the same way for all panels.
  const variants_beside = (points, axis) => {
    const variants = new Map();
    for (const technique of P.techniques) {
      const list = points.filter((p) => p.technique === technique),
        keys = P.variant_keys(list).filter((key) => key !== axis);
      let number = 0;
      for (const p of list) {
        const text = P.variant_text(p, keys);
        if (!variants.has(technique + text))
          variants.set(technique + text, { technique, text, number: number++ });
        p.variant = variants.get(technique + text).number;
      }
    }
    return [...variants.values()];
  };
  // Points of one technique that differ in `axis` alone, in its order.
  const series_along = (points, position) => {
    const groups = new Map();
    for (const p of points) {
      const key = p.technique + p.variant;
      if (!groups.has(key))
        groups.set(key, { technique: p.technique, variant: p.variant, line: true, points: [] });
      groups.get(key).points.push(position(p));
    }
    return [...groups.values()].map((s) => ({ ...s, points: s.points.sort((a, b) => a.order - b.order) }));
  };
  const variant_key = (variants) => {
    const several = variants.filter((v) => variants.some((w) => w.technique === v.technique && w !== v));
    if (!several.length || several.length > 16) return [];
    return several.map((v) =>
      P.element(
        "li",
        {},
        P.svg(
          "svg",
          { viewBox: "0 0 34 10", class: "dash", "aria-hidden": "true" },
          P.svg("line", {
            x1: 0,
            x2: 34,
            y1: 5,
            y2: 5,
            class: "line",
            stroke: P.colour(v.technique),
            "stroke-dasharray": P.dashes[v.number % P.dashes.length],
          }),
        ),
        P.marker_icon(v.technique),
        v.text,
      ),
    );
  };

  const panels = (points, draw) => {
    const scenes = P.scenes.filter((scene) => points.some((p) => p.scene === scene));
    if (!scenes.length)
      return [
        P.element(
          "p",
          { class: "empty" },
          "No finished point has such values, or the filter hides them all.",
        ),
      ];
    return scenes.map((scene) =>
      draw(
        scene,
        points.filter((p) => p.scene === scene),
      ),
    );
  };
  const y_kind = (column, values) => {
    const positive = values.filter((v) => v > 0);
    const linear = /bias|psnr|ssim/.test(column.key) || positive.length < values.length / 2;
    return linear || Math.max(...positive) / Math.min(...positive) < 4 ? "linear" : "log";
  };

  const against_axis = (axis, column) => {
    const points = eligible(axis).filter(
      (p) => P.param(p, axis) !== undefined && P.param(p, axis) !== null && typeof column.get(p) === "number",
    );
    const values = P.values_of(points, axis);
    const numbers = values.map(P.axis_number);
    const ordinal = numbers.some((n) => n === null) || new Set(numbers).size < values.length;
    const positive = numbers.every((n) => n > 0);
    const x_kind = ordinal
      ? "ordinal"
      : positive && Math.max(...numbers) / Math.min(...numbers) >= 4
        ? "log"
        : "linear";
    const all = points.map(column.get);
    const y = { label: axis_of(column), scale: P.scale(y_kind(column, all), all) };
    const x = { label: P.label_with_unit(axis), scale: P.scale(x_kind, numbers, ordinal ? values : numbers) };
    if (!ordinal)
      x.scale.ticks = x.scale.ticks.map(([t, text]) => {
        const i = numbers.indexOf(t);
        return [t, i >= 0 && Array.isArray(values[i]) ? values[i].join("×") : text];
      });
    const position = (p) => {
      const value = P.param(p, axis),
        [lo, hi] = column.interval?.(p) ?? [NaN, NaN];
      return {
        x: ordinal ? value : P.axis_number(value),
        y: column.get(p),
        lo,
        hi,
        point: p,
        order: ordinal
          ? values.findIndex((v) => JSON.stringify(v) === JSON.stringify(value))
          : P.axis_number(value),
      };
    };
    const variants = variants_beside(points, axis);
    return {
      panels: panels(points, (scene, list) =>
        P.chart({ title: scene, x, y, series: series_along(list, position) }),
      ),
      key: variant_key(variants),
    };
  };

  const against_time = (column) => {
    const time = P.columns.find((c) => c.key === "frame_ms");
    const points = eligible("").filter((p) => time.get(p) > 0 && typeof column.get(p) === "number");
    const all = points.map(column.get);
    const x = { label: axis_of(time), scale: P.scale("log", points.map(time.get)) };
    const y = { label: axis_of(column), scale: P.scale(y_kind(column, all), all) };
    const less_is_better = !/psnr|ssim|bias/.test(column.key);
    return {
      panels: panels(points, (scene, list) => {
        const placed = list.map((p) => {
          const [lo, hi] = time.interval(p) ?? [NaN, NaN];
          return { x: time.get(p), y: column.get(p), lo, hi, interval_on_x: true, point: p };
        });
        const series = P.techniques.map((technique) => ({
          technique,
          line: false,
          points: placed.filter((q) => q.point.technique === technique),
        }));
        const scale_is_log = y_kind(column, all) === "log";
        return P.chart({
          title: scene,
          x,
          y,
          series,
          front: less_is_better ? P.pareto_front(placed.filter((q) => !scale_is_log || q.y > 0)) : null,
        });
      }),
    };
  };

  const describe = (p) => {
    const keys = P.variant_keys(P.points.filter((q) => q.scene === p.scene && q.technique === p.technique));
    const time = P.stat(p, "frame_ms"),
      error = P.columns.find((c) => c.key === "metrics.rmse")?.get(p);
    const speed = P.speed_up(p);
    return [
      P.element("strong", {}, P.technique_label(p.technique)),
      ` in ${p.scene}`,
      P.element("br"),
      P.variant_text(p, keys),
      P.element("br"),
      time?.median !== undefined ? `${P.number(time.median)} ms` : "",
      speed !== null && p.technique !== P.anchor ? ` (${P.number(speed, 3)} × as fast as ray tracing)` : "",
      typeof error === "number" ? ` · RMSE ${P.number(error)}` : "",
    ];
  };

  const card = (title, controls, draw) => {
    const host = P.element("div", { class: "panels" }),
      key = P.element("ul", { class: "variant-key" });
    const made = P.element(
      "article",
      { class: "card" },
      P.element("h3", {}, title),
      P.element("div", { class: "controls" }, ...controls(() => redraw())),
      host,
      key,
    );
    const redraw = () => {
      const drawn = draw();
      host.replaceChildren(...drawn.panels);
      key.replaceChildren(...(drawn.key ?? []));
    };
    P.make_marks_live(host, describe);
    P.on_filter(redraw);
    P.on_scheme_change(redraw);
    redraw();
    return made;
  };
  const option = (c) => [c.key, P.label_with_unit(c.key)];
  const by_key = (list, key) => list.find((c) => c.key === key) ?? list[0];

  // Quantities before names and switches; among them first what most techniques were swept over.
  const by_weight = (keys) => {
    const points_of = P.techniques.map((t) => P.points.filter((p) => p.technique === t));
    const weight = (key) => {
      const swept = points_of.filter((points) => P.values_of(points, key).length > 1).length;
      const quantity = P.values_of(P.points, key).every((v) => P.axis_number(v) !== null);
      return swept + (quantity ? P.techniques.length : 0);
    };
    const weights = new Map(keys.map((key) => [key, weight(key)]));
    return [...keys].sort((a, b) => weights.get(b) - weights.get(a));
  };

  P.build_plots = (host) => {
    const time_list = times(),
      error_list = errors();
    const axes = by_weight(P.swept_keys).map((key) => [key, P.label(key)]);
    const time = { axis: axes[0]?.[0], y: "frame_ms" },
      pareto = { y: "metrics.rmse" },
      error = { axis: axes[0]?.[0], y: "metrics.rmse" };
    const y_times = P.anchor && P.techniques.length > 1 ? [...time_list, speed_up()] : time_list;
    const cards = [];
    if (time_list.length && axes.length)
      cards.push(
        card(
          "Time against a swept axis",
          (redraw) => [
            P.choices("Against", axes, time.axis, (v) => {
              time.axis = v;
              redraw();
            }),
            P.select("Show", y_times.map(option), time.y, (v) => {
              time.y = v;
              redraw();
            }),
          ],
          () => against_axis(time.axis, by_key(y_times, time.y)),
        ),
      );
    if (error_list.length && P.columns.some((c) => c.key === "frame_ms"))
      cards.push(
        card(
          "Error against time",
          (redraw) => [
            P.select("Error", error_list.map(option), pareto.y, (v) => {
              pareto.y = v;
              redraw();
            }),
            P.element(
              "p",
              { class: "hint" },
              "Lower left is better; the dashed line joins the points that no other beats in both.",
            ),
          ],
          () => against_time(by_key(error_list, pareto.y)),
        ),
      );
    if (error_list.length && axes.length)
      cards.push(
        card(
          "Error against a swept axis",
          (redraw) => [
            P.choices("Against", axes, error.axis, (v) => {
              error.axis = v;
              redraw();
            }),
            P.select("Error", error_list.map(option), error.y, (v) => {
              error.y = v;
              redraw();
            }),
          ],
          () => against_axis(error.axis, by_key(error_list, error.y)),
        ),
      );
    if (!cards.length)
      cards.push(
        P.element(
          "p",
          { class: "empty" },
          "Nothing to plot: no parameter was swept and no point has both a time and an error.",
        ),
      );
    host.replaceChildren(...cards);
  };
})();
