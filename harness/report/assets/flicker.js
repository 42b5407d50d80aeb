// Sequences: how much the error of each technique and variant changes from frame to frame, a bar for each.
(() => {
  const situation_keys = ["resolution", "camera", "light", "light_size"];
  const flicker_of = (p) => p.metrics?.flicker;
  const is_summary = (p) => p.frame === null && p.status === "ok" && typeof flicker_of(p) === "number";

  // Of many parameters those that are not as usual; all of them for the point that is as usual in each.
  const short_text = (p, own) => {
    const keys = P.variant_keys(own);
    const as_text = (q, key) => JSON.stringify(P.param(q, key));
    const usual = (key) => {
      const counts = new Map();
      for (const q of own) counts.set(as_text(q, key), (counts.get(as_text(q, key)) ?? 0) + 1);
      return [...counts].sort((a, b) => b[1] - a[1])[0][0];
    };
    const told = keys.length > 2 ? keys.filter((key) => as_text(p, key) !== usual(key)) : keys;
    return P.variant_text(p, told.length ? told : keys);
  };

  const bar = (p, own, most) =>
    P.element(
      "tr",
      {},
      P.element("th", { scope: "row" }, P.marker_icon(p.technique), short_text(p, own) || P.technique_label(p.technique)),
      P.element(
        "td",
        { class: "bar" },
        P.element("i", { style: `width:${(100 * flicker_of(p)) / (most || 1)}%;background:${P.colour(p.technique)}` }),
      ),
      P.element("td", { class: "num" }, P.number(flicker_of(p), 2)),
      P.element("td", { class: "num soft" }, P.number(p.metrics.mae, 2)),
    );

  P.build_flicker = (section) => {
    const summaries = P.points.filter(is_summary);
    section.hidden = !summaries.length;
    const situation = (p) => [p.scene, ...P.swept_keys.filter((k) => situation_keys.includes(k)).map((k) => P.value_text(P.param(p, k)))].join(" · ");
    const most = Math.max(...summaries.map(flicker_of));
    section.querySelector(".panels").replaceChildren(
      ...P.unique(summaries.map(situation)).map((name) => {
        const own = summaries.filter((p) => situation(p) === name);
        return P.element(
          "table",
          { class: "flicker" },
          P.element("caption", {}, name),
          P.element(
            "thead",
            {},
            P.element("tr", {}, ...["", "", "flicker", "MAE"].map((h) => P.element("th", { scope: "col", class: "num" }, h))),
          ),
          P.element(
            "tbody",
            {},
            ...own.map((p) => bar(p, own.filter((q) => q.technique === p.technique), most)),
          ),
        );
      }),
    );
  };
})();
