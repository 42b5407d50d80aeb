// Everything about one point, in a dialog that #point-<id> opens too.
(() => {
  const dialog = () => document.getElementById("details");
  const pairs = (entries) =>
    P.element(
      "dl",
      { class: "pairs" },
      ...entries.flatMap(([key, value]) => [P.element("dt", {}, key), P.element("dd", {}, value)]),
    );
  const block = (title, ...content) => P.element("section", {}, P.element("h3", {}, title), ...content);

  // The run's own record of the command when there is one.
  P.command_of = (p) => {
    if (p.command) return p.command;
    const quoted = (text) => (/^[\w.,:/=@%+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
    const config = P.data.run?.config_path ?? P.data.run?.config_file ?? "CONFIG.json";
    if (p.key)
      return `penumbra run ${quoted(config)} --filter ${quoted(`^${p.key.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")}$`)}`;
    const value = (v) => (Array.isArray(v) ? v.join("x") : String(v));
    return [
      "penumbra render",
      quoted(p.scene),
      p.technique,
      ...Object.entries(p.params)
        .filter(([, v]) => (v !== null && typeof v !== "object") || Array.isArray(v))
        .map(([k, v]) => quoted(`${k}=${value(v)}`)),
    ].join(" ");
  };
  const command = (p) => {
    const text = P.command_of(p),
      said = P.element("span", { class: "said", "aria-live": "polite" });
    const code = P.element("code", {}, text);
    const copy = async () => {
      try {
        await navigator.clipboard.writeText(text);
      } catch {
        // not offered to pages from disk everywhere: select it and use the old command
        getSelection().selectAllChildren(code);
        document.execCommand("copy");
      }
      said.textContent = "copied";
    };
    return block(
      "Run this point again",
      P.element(
        "div",
        { class: "command" },
        P.element("pre", {}, code),
        P.element("button", { type: "button", class: "copy", onclick: copy }, "Copy"),
        said,
      ),
    );
  };

  const stat_row = (name, s) =>
    P.element(
      "tr",
      {},
      P.element("th", { scope: "row" }, name),
      ...["median", "mean", "min", "p95"].map((k) => P.element("td", { class: "num" }, P.number(s[k]))),
      P.element("td", { class: "num" }, s.ci95 ? `${P.number(s.ci95[0])} – ${P.number(s.ci95[1])}` : "–"),
      P.element("td", { class: "num" }, s.samples ? String(s.samples.length) : "–"),
    );
  const pass_colours = [
    "#0072b2",
    "#e69f00",
    "#009e73",
    "#cc79a7",
    "#56b4e9",
    "#d55e00",
    "#8a8a00",
    "#332288",
    "#888888",
  ];
  const pass_bar = (passes) => {
    const total = passes.reduce((sum, [, s]) => sum + s.median, 0);
    if (!(total > 0)) return null;
    return P.element(
      "div",
      {},
      P.element(
        "div",
        { class: "pass-bar", role: "img", "aria-label": "Share of each pass" },
        ...passes.map(([name, s], i) =>
          P.element("span", {
            style: `flex:${Math.max(s.median, 0)};background:${pass_colours[i % pass_colours.length]}`,
            title: `${name}: ${P.number(s.median)} ms`,
          }),
        ),
      ),
      P.element(
        "ul",
        { class: "pass-key" },
        ...passes.map(([name, s], i) =>
          P.element(
            "li",
            {},
            P.element("span", {
              class: "swatch",
              style: `background:${pass_colours[i % pass_colours.length]}`,
            }),
            `${name} ${P.number(s.median, 3)} ms (${((100 * s.median) / total).toFixed(0)} %)`,
          ),
        ),
      ),
    );
  };
  const samples_strip = (name, s, colour) => {
    if (!(s.samples?.length > 1)) return null;
    const lo = Math.min(...s.samples),
      hi = Math.max(...s.samples),
      at = (v) => 10 + (380 * (v - lo)) / (hi - lo || 1);
    const strip = P.svg(
      "svg",
      {
        viewBox: "0 0 400 44",
        class: "strip",
        role: "img",
        "aria-label": `${name}: ${s.samples.length} samples from ${P.number(lo)} to ${P.number(hi)} ms`,
      },
      ...(s.ci95
        ? [
            P.svg("rect", {
              x: at(s.ci95[0]),
              y: 4,
              width: Math.max(1, at(s.ci95[1]) - at(s.ci95[0])),
              height: 22,
              fill: colour,
              opacity: 0.15,
            }),
          ]
        : []),
      P.svg("line", {
        x1: at(s.median),
        x2: at(s.median),
        y1: 2,
        y2: 28,
        stroke: colour,
        "stroke-width": 1.5,
      }),
      ...s.samples.map((v, i) =>
        P.svg("circle", { cx: at(v), cy: 9 + (i % 3) * 6, r: 3, fill: colour, opacity: 0.65 }),
      ),
      P.svg("text", { x: 10, y: 40, class: "tick" }, `${P.number(lo)} ms`),
      P.svg("text", { x: 390, y: 40, class: "tick", "text-anchor": "end" }, `${P.number(hi)} ms`),
    );
    return P.element(
      "figure",
      {},
      P.element("figcaption", {}, `${name}: raw samples`),
      strip,
      P.element(
        "details",
        {},
        P.element("summary", {}, "as numbers (ms)"),
        P.element("p", { class: "raw" }, s.samples.map((v) => P.number(v, 6)).join(", ")),
      ),
    );
  };
  const timing = (p) => {
    const own = Object.entries(p.timing ?? {})
      .filter(([k]) => k !== "passes")
      .map(([k, s]) => [k, typeof s === "number" ? { median: s } : s])
      .filter(([, s]) => s && typeof s === "object");
    const passes = Object.entries(p.timing?.passes ?? {}).filter(
      ([, s]) => s && typeof s.median === "number",
    );
    if (!own.length && !passes.length) return null;
    const heads = ["ms", "median", "mean", "min", "p95", "95 % CI", "samples"];
    return block(
      "Timing",
      pass_bar(passes),
      P.element(
        "div",
        { class: "scroll-x" },
        P.element(
          "table",
          { class: "plain" },
          P.element(
            "thead",
            {},
            P.element(
              "tr",
              {},
              ...heads.map((h, i) => P.element("th", { scope: "col", class: i ? "num" : null }, h)),
            ),
          ),
          P.element(
            "tbody",
            {},
            ...own.map(([k, s]) => stat_row(P.label(k), s)),
            ...passes.map(([k, s]) => stat_row(`· ${k}`, s)),
          ),
        ),
      ),
      ...own.map(([k, s]) => samples_strip(P.label(k), s, P.colour(p.technique))),
    );
  };

  const zones = (p) => {
    const rows = Object.entries(p.metrics?.zones ?? {});
    return rows.length
      ? P.element(
          "table",
          { class: "plain" },
          P.element(
            "thead",
            {},
            P.element(
              "tr",
              {},
              ...["zone", "pixels", "MAE", "bias"].map((h, i) =>
                P.element("th", { scope: "col", class: i ? "num" : null }, h),
              ),
            ),
          ),
          P.element(
            "tbody",
            {},
            ...rows.map(([zone, z]) =>
              P.element(
                "tr",
                {},
                P.element("th", { scope: "row" }, zone),
                ...["pixels", "mae", "bias"].map((k) => P.element("td", { class: "num" }, P.number(z?.[k]))),
              ),
            ),
          ),
        )
      : null;
  };
  const numbers = (part, prefix) =>
    Object.entries(part ?? {})
      .filter(([, v]) => v === null || typeof v !== "object")
      .map(([k, v]) => [P.label(prefix + k), typeof v === "number" ? P.number(v) : P.value_text(v)]);
  const histogram = (name, values) => {
    const top = Math.max(...values, 0),
      step = 300 / values.length;
    return P.element(
      "figure",
      {},
      P.element("figcaption", {}, `${name}: ${values.length} values, greatest ${P.number(top)}`),
      P.svg(
        "svg",
        { viewBox: "0 0 300 60", class: "strip", role: "img", "aria-label": name },
        ...values.map((v, i) =>
          P.svg("rect", {
            x: i * step,
            width: Math.max(step - 0.5, 0.3),
            y: 60 - (58 * v) / (top || 1),
            height: (58 * v) / (top || 1),
            fill: "currentColor",
            opacity: 0.6,
          }),
        ),
      ),
    );
  };
  const counters = (p) => {
    const entries = Object.entries(p.counters ?? {});
    if (!entries.length) return null;
    return block(
      "Counters",
      pairs(
        entries
          .filter(([, v]) => !Array.isArray(v))
          .map(([k, v]) => [k.replaceAll("_", " "), P.value_text(v)]),
      ),
      ...entries
        .filter(([, v]) => Array.isArray(v) && v.length && v.every((x) => typeof x === "number"))
        .map(([k, v]) => histogram(k.replaceAll("_", " "), v)),
    );
  };
  const pictures = (p) => {
    const entries = ["shaded", "visibility"].filter((k) => p.pictures[k]);
    return entries.length
      ? P.element(
          "div",
          { class: "thumbs" },
          ...entries.map((k) =>
            P.element(
              "a",
              { href: p.pictures[k], target: "_blank", rel: "noopener" },
              P.element("img", { src: p.pictures[k], alt: k, loading: "lazy" }),
            ),
          ),
        )
      : null;
  };

  P.show_details = (p) => {
    const box = dialog();
    const metrics = numbers(p.metrics, "metrics."),
      own = numbers(p.metrics_own, "metrics."),
      matched = numbers(p.metrics_matched, "metrics_matched.");
    const speed = P.speed_up(p);
    box.replaceChildren(
      ...[
        P.element(
          "header",
          {},
          P.marker_icon(p.technique),
          P.element("h2", { id: "details-title" }, `${P.technique_label(p.technique)} · ${p.scene}`),
          P.element(
            "button",
            { type: "button", class: "close", "aria-label": "Close", onclick: () => box.close() },
            "✕",
          ),
        ),
        P.element(
          "p",
          { class: `status ${p.status}` },
          P.element("span", { class: "dot" }),
          p.message ? `${p.status}: ${p.message}` : p.status,
          speed !== null && p.technique !== P.anchor
            ? ` · ${P.number(speed, 3)} × as fast as ray tracing at the same samples`
            : "",
        ),
        pictures(p),
        command(p),
        block(
          "Parameters",
          pairs([
            ["id", p.id ?? "–"],
            ...(p.frame !== undefined && p.frame !== null ? [["frame", String(p.frame)]] : []),
            ...Object.entries(p.params).map(([k, v]) => [k, P.value_text(v)]),
          ]),
        ),
        timing(p),
        metrics.length ? block("Error against the converged reference", pairs(metrics), zones(p)) : null,
        own.length
          ? block("Error against the light as the technique takes it", pairs(own), zones({ metrics: p.metrics_own }))
          : null,
        matched.length ? block("Difference from Embree at the same light samples", pairs(matched)) : null,
        Object.keys(p.memory ?? {}).length
          ? block(
              "Memory",
              pairs(
                Object.entries(p.memory).map(([k, v]) => [P.label(k.replace(/_bytes$/, "")), P.bytes(v)]),
              ),
            )
          : null,
        counters(p),
      ].filter(Boolean),
    );
    if (!box.open) box.showModal();
    box.scrollTop = 0;
    if (p.id) history.replaceState(null, "", `#point-${encodeURIComponent(p.id)}`);
  };
  P.build_details = () => {
    const box = dialog();
    box.addEventListener("click", (event) => {
      if (event.target === box) box.close();
    });
    box.addEventListener("close", () => history.replaceState(null, "", location.pathname + location.search));
    const open_named = () => {
      const id = /^#point-(.+)$/.exec(location.hash)?.[1];
      const point = id && P.points.find((p) => p.id === decodeURIComponent(id));
      if (point) P.show_details(point);
    };
    addEventListener("hashchange", open_named);
    open_named();
  };
})();
