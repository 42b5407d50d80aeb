// The page of two runs side by side: what came out, the verdicts, and one point's pictures and figures.
(() => {
  const at = (id) => document.getElementById(id);
  const c = P.data.comparison;
  const text_of = (part, ...names) =>
    typeof part === "string" ? part : names.map((name) => part?.[name]).find((v) => typeof v === "string");
  const layers = {
    shaded: { label: "Shaded" },
    visibility: { label: "Visibility" },
    error: { label: "Error of each", ends: ["test darker", "test − reference", "test lighter"] },
    difference: { label: "What changed", ends: ["current darker", "current − baseline", "current lighter"] },
  };
  const state = P.stage_state();
  let draw = null;

  const head = () => {
    const count = (verdict) => P.points.filter((p) => p.verdict === verdict).length;
    const bad = ["regressed", "missing", "ambiguous"].map((v) => [count(v), v]).filter(([n]) => n);
    at("outcome").textContent = c.error
      ? "Nothing was compared"
      : bad.length
        ? `Of ${P.points.length} points ${bad.map(([n, v]) => `${n} ${v}`).join(", ")}`
        : `None of ${P.points.length} points is worse`;
    at("outcome").className = c.error || bad.length ? "bad" : "good";
    for (const side of ["baseline", "current"]) {
      const run = c.runs[side];
      const more = [run.started, text_of(run.cpu, "model"), text_of(run.vulkan, "name", "device")].filter(Boolean);
      at("runs").append(P.element("dt", {}, side), P.element("dd", {}, [run.name, ...more].join(" · ")));
    }
    for (const remark of [c.error, ...c.remarks].filter(Boolean))
      at("warnings").append(P.element("p", { class: "notice" }, remark));
    if (P.data.warnings?.length)
      at("warnings").append(
        P.element(
          "details",
          { class: "notice" },
          P.element("summary", {}, `${P.data.warnings.length} pictures could not be shown`),
          P.element("ul", {}, ...P.data.warnings.map((w) => P.element("li", {}, w))),
        ),
      );
  };

  const sums = () => {
    const findings = P.points.flatMap((p) => p.findings);
    const verdicts = P.verdict_order.filter((v) => v !== "unjudged");
    at("sum-table").replaceChildren(
      P.element(
        "table",
        { class: "glance sums" },
        P.element("thead", {}, P.element("tr", {}, ...["", ...verdicts].map((v) => P.element("th", { scope: "col", class: "num" }, v)))),
        P.element(
          "tbody",
          {},
          ...[
            ["status", "Status"],
            ["quality", "Quality"],
            ["time", "Time"],
          ].map(([kind, label]) =>
            P.element(
              "tr",
              { "data-kind": kind },
              P.element("th", { scope: "row" }, label),
              ...verdicts.map((v) => {
                const n = findings.filter((f) => f.verdict === v && P.kind_of(f) === kind).length;
                return P.element("td", { class: `num ${n ? `verdict ${v}` : "soft"}` }, String(n));
              }),
            ),
          ),
        ),
      ),
    );
  };

  const pictures_of = (tile) => tile.point.pictures[tile.side] ?? {};
  const tiles_of = (p) => {
    const sides = ["baseline", "current"].filter((side) => Object.keys(p.pictures[side] ?? {}).length);
    const tiles = sides.map((side) => ({ side, point: p }));
    const truth = sides.find((side) => p.pictures[side].reference ?? p.pictures[side].reference_shaded);
    if (state.layer === "difference") return p.pictures.difference ? [{ side: "difference", point: p }, ...tiles] : tiles;
    if (truth && state.layer !== "error") tiles.push({ side: "reference", from: truth, point: p });
    return tiles;
  };
  const source_of = (tile) => {
    if (tile.side === "difference") return { src: tile.point.pictures.difference, coded: true };
    if (tile.side === "reference") {
      const own = tile.point.pictures[tile.from];
      return { src: state.layer === "shaded" ? (own.reference_shaded ?? own.reference) : (own.reference ?? own.reference_shaded) };
    }
    const own = pictures_of(tile);
    if (state.layer === "error") return own.error_code ? { src: own.error_code, coded: true } : { src: own.error };
    return { src: state.layer === "difference" ? (own.visibility ?? own.shaded) : own[state.layer] };
  };
  const names = { baseline: "Baseline", current: "Current", reference: "Reference", difference: "Current − baseline" };
  const name_of = (tile) => names[tile.side];
  const figures = (tile) => {
    const value = (metric) => tile.point.findings.find((f) => f.metric === metric)?.[tile.side];
    const time = value("timing.frame_ms"),
      rmse = value("metrics.rmse");
    return [time > 0 ? `${P.number(time, 3)} ms` : null, typeof rmse === "number" ? `RMSE ${P.number(rmse, 3)}` : null]
      .filter(Boolean)
      .join(" · ");
  };
  const caption = (tile) =>
    P.element(
      "figcaption",
      {},
      P.element("div", { class: "name" }, P.element("strong", {}, name_of(tile))),
      P.element("span", { class: "figures" }, ["baseline", "current"].includes(tile.side) ? figures(tile) : ""),
    );
  const fill = (p) => {
    state.tiles = tiles_of(p);
    state.a = 0;
    state.b = Math.min(1, state.tiles.length - 1);
    state.current = state.b;
    state.previous = state.a;
  };

  const findings_table = (title, list) =>
    P.element(
      "div",
      { class: "card scroll-x" },
      P.element("h3", {}, title),
      list.length
        ? P.element(
            "table",
            { class: "plain" },
            P.element("thead", {}, P.element("tr", {}, ...["figure", "verdict", "baseline", "current", "ratio", "p", ""].map((h, i) => P.element("th", { scope: "col", class: i > 1 && i < 6 ? "num" : null }, h)))),
            P.element(
              "tbody",
              {},
              ...list.map((f) =>
                P.element(
                  "tr",
                  { title: f.rule ?? null },
                  P.element("th", { scope: "row" }, f.metric),
                  P.element("td", {}, P.verdict_badge(f.verdict)),
                  ...["baseline", "current", "ratio", "p"].map((k) => P.element("td", { class: "num" }, P.number(f[k]))),
                  P.element("td", { class: "why" }, [f.against_anchor ? "ratio to the anchor" : "", f.message ?? ""].filter(Boolean).join("; ")),
                ),
              ),
            ),
          )
        : P.element("p", { class: "empty" }, "none"),
    );
  const show = (p, scroll) => {
    at("point-title").textContent = P.point_name(p);
    at("point-name").textContent = p.key ?? "";
    fill(p);
    if (draw && state.tiles.length) {
      at("stage").hidden = false;
      draw();
    } else {
      at("stage").hidden = true;
    }
    const by_verdict = (a, b) => P.verdict_order.indexOf(a.verdict) - P.verdict_order.indexOf(b.verdict);
    const of_kind = (...kinds) => p.findings.filter((f) => kinds.includes(P.kind_of(f))).sort(by_verdict);
    at("findings").replaceChildren(
      findings_table("Quality", of_kind("status", "quality")),
      findings_table("Time", of_kind("time")),
      c.all_findings ? "" : P.element("p", { class: "note" }, "Of so many points only figures that have a rule are listed here."),
    );
    shown = p;
    if (scroll) at("point").scrollIntoView({ behavior: "instant" });
  };
  let shown = null;

  for (const p of P.points)
    p.has_pictures = ["baseline", "current"].some((side) => Object.keys(p.pictures[side] ?? {}).length);
  const available = Object.fromEntries(
    Object.entries(layers).filter(([key]) =>
      P.points.some((p) =>
        key === "difference"
          ? p.pictures.difference
          : ["baseline", "current"].some((side) => p.pictures[side]?.[key] || (key === "error" && p.pictures[side]?.error_code)),
      ),
    ),
  );
  head();
  sums();
  if (Object.keys(available).length) {
    if (!available[state.layer]) state.layer = Object.keys(available)[0];
    draw = P.make_stage(at("stage"), {
      state,
      layers: available,
      source_of,
      name_of,
      variant_of: () => "",
      caption,
      layer_changed: () => fill(shown),
      before: [],
      after: [],
    });
  } else {
    at("point-name").parentElement.after(P.element("p", { class: "empty" }, "Neither run has pictures (a committed baseline never has)."));
  }
  P.build_verdicts(at("verdict-table"), show);
})();
