// The table of verdicts, a row for each point.
(() => {
  const badness = ["regressed", "missing", "ambiguous", "improved", "added", "pass", "unjudged"];
  P.verdict_order = badness;

  // Which kind of figure a finding is of: status, quality or time.
  P.kind_of = (finding) =>
    finding.metric === "status" ? "status" : finding.metric.startsWith("timing.") ? "time" : "quality";
  const worst = (findings) => {
    const found = badness.find((v) => findings.some((f) => f.verdict === v));
    return { verdict: found ?? null, of: findings.filter((f) => f.verdict === found) };
  };
  const frame_time = (p) => p.findings.find((f) => f.metric === "timing.frame_ms") ?? {};

  P.verdict_badge = (verdict) =>
    P.element("span", { class: `verdict ${verdict}` }, P.element("span", { class: "dot" }), verdict);
  const verdict_cell = (outcome) => {
    const told = outcome.of.find((f) => f.message) ?? {};
    const named = ["pass", "unjudged"].includes(outcome.verdict) ? "" : P.unique(outcome.of.map((f) => P.label(f.metric.replace(/^timing\./, "")))).join(", ");
    return P.element(
      "td",
      { title: told.message ?? null },
      outcome.verdict ? P.verdict_badge(outcome.verdict) : "–",
      named ? P.element("small", {}, named) : null,
    );
  };
  // Where a ratio of times lies between half and twice, 1 in the middle.
  const ratio_bar = (ratio) => {
    if (!(ratio > 0)) return "";
    const at = 50 + 50 * Math.max(-1, Math.min(1, Math.log2(ratio)));
    return P.element(
      "span",
      { class: "ratio-bar", role: "img", "aria-label": `${P.number(ratio, 3)} times` },
      P.element("i", { style: `left:${Math.min(50, at)}%;width:${Math.abs(at - 50)}%`, class: ratio > 1 ? "up" : "down" }),
    );
  };
  // Named by the parameters that differ among the points of its technique and scene.
  const keys_of = new Map();
  P.point_name = (p) => {
    const kin = JSON.stringify([p.technique, p.scene]);
    if (!keys_of.has(kin))
      keys_of.set(kin, P.variant_keys(P.points.filter((q) => q.technique === p.technique && q.scene === p.scene)));
    return [P.technique_label(p.technique), p.scene, P.variant_text(p, keys_of.get(kin))].filter(Boolean).join(" · ");
  };

  const columns = [
    ["Point", (p) => P.element("th", { scope: "row" }, P.element("button", { class: "open", tabindex: -1 }, P.marker_icon(p.technique), P.point_name(p))), 36],
    ["Verdict", (p) => P.element("td", {}, P.verdict_badge(p.verdict)), 14],
    ["Quality", (p) => verdict_cell(p.quality), 25],
    ["Time", (p) => verdict_cell(p.time), 18],
    ["before, ms", (p) => P.element("td", { class: "num" }, P.number(frame_time(p).baseline)), 12],
    ["now, ms", (p) => P.element("td", { class: "num" }, P.number(frame_time(p).current)), 11],
    ["ratio", (p) => P.element("td", { class: "num" }, P.number(frame_time(p).ratio, 3), ratio_bar(frame_time(p).ratio)), 19],
    ["p", (p) => P.element("td", { class: "num" }, P.number(frame_time(p).p, 2)), 9],
  ];

  P.build_verdicts = (host, choose) => {
    for (const p of P.points) {
      p.status_outcome = worst(p.findings.filter((f) => P.kind_of(f) === "status"));
      p.quality = worst(p.findings.filter((f) => P.kind_of(f) === "quality"));
      p.time = worst(p.findings.filter((f) => P.kind_of(f) === "time"));
      p.words = `${p.technique} ${P.technique_label(p.technique)} ${p.scene} ${P.point_name(p)} ${p.key ?? ""}`.toLowerCase();
    }
    const rank = (p) => badness.indexOf(p.verdict);
    const ordered = [...P.points].sort((a, b) => rank(a) - rank(b) || a.index - b.index);
    const wanted = { text: "", verdict: "" };
    let shown = ordered,
      chosen = null;
    const count = P.element("output", { class: "count", "aria-live": "polite" });
    const body = P.element("tbody");
    const table = P.element(
      "table",
      { class: "results verdict-list", style: `width:${columns.reduce((sum, c) => sum + c[2], 0)}ch` },
      P.element("caption", { class: "hidden" }, "One row per point, the worst first"),
      P.element("colgroup", {}, ...columns.map((c) => P.element("col", { style: `width:${c[2]}ch` }))),
      P.element("thead", {}, P.element("tr", {}, ...columns.map((c, i) => P.element("th", { scope: "col", class: i > 3 ? "num" : null }, P.element("span", { class: "head" }, c[0]))))),
      body,
    );
    const scroller = P.element("div", { class: "table-scroll", tabindex: -1 }, table);
    const rows = P.rows_in_sight({
      scroller,
      body,
      items: () => shown,
      row: (p, place) =>
        P.element(
          "tr",
          { tabindex: 0, "data-row": place, "data-point": p.index, "aria-selected": String(p === chosen) },
          ...columns.map((c) => c[1](p)),
        ),
      columns: () => columns.length,
    });
    const refresh = () => {
      const words = wanted.text.toLowerCase().split(/\s+/).filter(Boolean);
      shown = ordered.filter(
        (p) => (!wanted.verdict || p.verdict === wanted.verdict) && words.every((w) => p.words.includes(w)),
      );
      table.setAttribute("aria-rowcount", shown.length + 1);
      count.textContent = shown.length === P.points.length ? `${shown.length} points` : `${shown.length} of ${P.points.length} points`;
      rows.draw();
    };
    const pick = (row, scroll) => {
      chosen = P.points[Number(row.dataset.point)];
      rows.draw();
      choose(chosen, scroll);
    };
    body.addEventListener("click", (event) => {
      const row = event.target.closest("tr[data-row]");
      if (row && !getSelection().toString()) pick(row, true);
    });
    table.addEventListener("keydown", (event) => {
      const row = event.target.closest("tr[data-row]");
      if (!row) return;
      if (event.key === "Enter" || event.key === " ") pick(row, true);
      else if (rows.step(event.key, Number(row.dataset.row)) !== undefined)
        rows.reveal(rows.step(event.key, Number(row.dataset.row)), table.tHead.offsetHeight);
      else return;
      event.preventDefault();
    });
    const verdicts = badness.filter((v) => P.points.some((p) => p.verdict === v));
    host.replaceChildren(
      P.element(
        "div",
        { class: "controls" },
        P.element(
          "label",
          { class: "field grow" },
          P.element("span", {}, "Filter"),
          P.element("input", {
            type: "search",
            id: "filter-text",
            placeholder: "technique, scene, parameter",
            spellcheck: "false",
            oninput: (e) => ((wanted.text = e.target.value), refresh()),
          }),
        ),
        P.select("Verdict", [["", "all"], ...verdicts.map((v) => [v, v])], "", (v) => ((wanted.verdict = v), refresh())),
        count,
      ),
      scroller,
      P.element("p", { class: "note" }, "Click a row, or press Enter on it, for its pictures and all its figures."),
    );
    refresh();
    chosen = ordered.find((p) => p.has_pictures && p.verdict !== "pass") ?? ordered.find((p) => p.has_pictures) ?? ordered[0] ?? null;
    rows.draw();
    if (chosen) choose(chosen, false);
  };
})();
