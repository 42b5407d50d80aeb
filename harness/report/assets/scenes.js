// Overview, scenes and provenance: what the run says about itself, shown as it stands.
(() => {
  const is_object = (v) => v !== null && typeof v === "object" && !Array.isArray(v);
  const leaf = (key, v) =>
    typeof v !== "number" ? P.value_text(v) : key.endsWith("_bytes") ? P.bytes(v) : P.number(v, 6);
  const name_of = (key) => key.replace(/_bytes$/, "").replaceAll("_", " ");

  const is_flat = (v) =>
    is_object(v) && !Object.values(v).some((x) => is_object(x) || (Array.isArray(x) && x.some(is_object)));
  const rows = (list) => {
    const keys = P.unique(list.flatMap(Object.keys));
    return P.element(
      "div",
      { class: "scroll-x" },
      P.element(
        "table",
        { class: "plain" },
        P.element(
          "thead",
          {},
          P.element("tr", {}, ...keys.map((k) => P.element("th", { scope: "col" }, name_of(k)))),
        ),
        P.element(
          "tbody",
          {},
          ...list.map((row) => P.element("tr", {}, ...keys.map((k) => P.element("td", {}, leaf(k, row[k]))))),
        ),
      ),
    );
  };
  // Nested objects become nested lists of names and values, lists of flat objects tables.
  const tree = (value, key = "") => {
    if (is_object(value))
      return P.element(
        "dl",
        { class: "pairs" },
        ...Object.entries(value).flatMap(([k, v]) => [
          P.element("dt", {}, name_of(k)),
          P.element("dd", {}, tree(v, k)),
        ]),
      );
    if (Array.isArray(value) && value.length > 1 && value.every(is_flat)) return rows(value);
    if (Array.isArray(value) && value.some(is_object))
      return P.element("div", {}, ...value.map((v) => tree(v)));
    return document.createTextNode(leaf(key, value));
  };

  const range_text = (values, digits) => {
    const numbers = values.filter((v) => typeof v === "number");
    if (!numbers.length) return "–";
    const lo = P.number(Math.min(...numbers), digits),
      hi = P.number(Math.max(...numbers), digits);
    return lo === hi ? lo : `${lo} – ${hi}`;
  };
  P.build_glance = (host) => {
    const row = (technique) =>
      P.element(
        "tr",
        {},
        P.element("th", { scope: "row" }, P.marker_icon(technique), P.technique_label(technique)),
        ...P.scenes.map((scene) => {
          const list = P.points.filter((p) => p.technique === technique && p.scene === scene),
            done = list.filter((p) => p.status === "ok");
          const others = P.unique(list.filter((p) => p.status !== "ok").map((p) => p.status)).map(
            (s) => `${list.filter((p) => p.status === s).length} ${s}`,
          );
          return P.element(
            "td",
            {},
            ...(done.length
              ? [
                  P.element(
                    "b",
                    {},
                    `${range_text(
                      done.map((p) => P.stat(p, "frame_ms")?.median),
                      3,
                    )} ms`,
                  ),
                  P.element(
                    "small",
                    {},
                    `RMSE ${range_text(
                      done.map((p) => p.metrics?.rmse),
                      2,
                    )}`,
                  ),
                ]
              : []),
            list.length
              ? P.element(
                  "small",
                  { class: others.length ? "other" : "" },
                  [done.length ? `${done.length} ok` : "", ...others].filter(Boolean).join(", "),
                )
              : P.element("small", {}, "not run"),
          );
        }),
      );
    host.replaceChildren(
      P.element(
        "table",
        { class: "glance" },
        P.element(
          "thead",
          {},
          P.element(
            "tr",
            {},
            P.element("th", { scope: "col" }, "Technique"),
            ...P.scenes.map((s) => P.element("th", { scope: "col" }, s)),
          ),
        ),
        P.element("tbody", {}, ...P.techniques.map(row)),
      ),
    );
  };

  P.build_scenes = (host) => {
    const scenes = P.data.run?.scenes;
    const list = Array.isArray(scenes)
      ? scenes.map((s, i) => [s.name ?? s.scene ?? String(i + 1), s])
      : is_object(scenes)
        ? Object.entries(scenes)
        : [];
    host.replaceChildren(
      ...(list.length
        ? list.map(([name, scene]) => {
            const { name: _, ...rest } = scene;
            return P.element("article", { class: "card" }, P.element("h3", {}, name), tree(rest));
          })
        : [P.element("p", { class: "empty" }, "The run has recorded nothing about its scenes.")]),
    );
  };
  P.build_provenance = (host) => {
    const { config, scenes, ...rest } = P.data.run ?? {};
    host.replaceChildren(
      P.element("div", { class: "card" }, tree(rest)),
      ...(config
        ? [
            P.element(
              "details",
              { class: "card" },
              P.element("summary", {}, "The expanded config"),
              P.element("pre", {}, JSON.stringify(config, null, 2)),
            ),
          ]
        : []),
    );
  };
})();
