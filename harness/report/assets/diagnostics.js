// What techniques show of how they came to their answer: figures in false colour, classes, lines over the scene.
(() => {
  const shown_by = (p) => (p.diagnostics ?? []).filter((d) => p.pictures[`diagnostic_${d.name}`]);

  const key = (names, colours, counts) =>
    P.element(
      "ul",
      { class: "pass-key" },
      ...names.map((name, i) =>
        P.element(
          "li",
          {},
          P.element("span", { class: "swatch outlined", style: `background:${colours[i]}` }),
          counts ? `${name} (${P.number(counts[i])})` : name,
        ),
      ),
    );
  const scale = (d) =>
    d.high > 0
      ? P.element(
          "div",
          { class: "colour-bar" },
          P.element("div", { class: "gradient", style: `background:linear-gradient(to right, ${d.colors.join(", ")})` }),
          P.element("div", { class: "ticks" }, ...d.marks.map((v) => P.element("span", {}, P.number(v, 2)))),
        )
      : P.element("span", {}, "none anywhere");
  const legends = {
    figures: (d) => [scale(d), `median ${P.number(d.median, 3)} of ${P.number(d.above_none)} pixels that have any`],
    grid: (d) => [
      scale(d),
      `median ${P.number(d.median, 3)} of ${P.number(d.above_none)} cells that have any; black: none`,
      d.names ? key(d.names, d.line_colors) : null,
    ],
    classes: (d) => [key(d.names, d.colors, d.pixels)],
    lines: (d) => [key(d.names, d.colors, d.segments)],
  };
  const figure = (p, d) =>
    P.element(
      "figure",
      { class: d.kind === "grid" ? "crisp" : "" },
      P.element("img", { src: p.pictures[`diagnostic_${d.name}`], alt: `${d.title}: ${P.technique_label(p.technique)}, ${p.scene}`, loading: "lazy" }),
      P.element("figcaption", {}, P.element("strong", {}, d.title), ...(legends[d.kind]?.(d) ?? [])),
    );

  // One card for each technique and scene; of several variants one is chosen.
  const card = (list) => {
    const keys = P.variant_keys(list);
    const row = P.element("div", { class: "exhibit-row diagnostics" });
    const show = (p) => row.replaceChildren(...shown_by(p).map((d) => figure(p, d)));
    show(list[0]);
    const chooser =
      list.length > 1
        ? P.select(
            "Variant",
            list.map((p, i) => [String(i), P.variant_text(p, keys) || "default"]),
            "0",
            (i) => show(list[Number(i)]),
          )
        : null;
    return P.element(
      "article",
      { class: "card" },
      P.element("h3", {}, P.marker_icon(list[0].technique), ` ${P.technique_label(list[0].technique)} · ${list[0].scene}`),
      chooser,
      row,
    );
  };

  P.build_diagnostics = (section, link) => {
    const points = P.points.filter((p) => shown_by(p).length);
    section.hidden = link.hidden = !points.length;
    const group = (p) => JSON.stringify([p.scene, p.technique]);
    section.querySelector(".diagnostic-cards").replaceChildren(
      ...P.unique(points.map(group)).map((g) => card(points.filter((p) => group(p) === g))),
    );
  };
})();
