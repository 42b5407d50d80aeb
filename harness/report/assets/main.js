// Puts the page together.
(() => {
  P.columns = P.make_columns();
  P.shown = P.points;
  const at = (id) => document.getElementById(id);
  const run = P.data.run ?? {};
  // A part of the run's record as one text: its own, or that of the first of these names in it.
  const text_of = (part, ...names) =>
    typeof part === "string" ? part : names.map((name) => part?.[name]).find((v) => typeof v === "string");

  const cores = run.cpu?.usable_cores ?? run.cpu?.cores ?? run.cores;
  const machine = [
    text_of(run.vulkan, "name", "device"),
    text_of(run.cpu, "model"),
    cores ? `${cores} cores` : null,
    text_of(run.os, "name"),
    run.started ?? run.start_time,
  ];
  at("machine").textContent = machine.filter(Boolean).join(" · ");
  const order = ["ok", "unsupported", "failed", "timeout"];
  at("counts").replaceChildren(
    ...[...P.statuses]
      .sort((a, b) => order.indexOf(a) - order.indexOf(b))
      .map((status) =>
        P.element(
          "li",
          { class: `status ${status}` },
          P.element("span", { class: "dot" }),
          P.element("b", {}, String(P.points.filter((p) => p.status === status).length)),
          ` ${status}`,
        ),
      ),
    ...[
      [P.techniques.length, "technique"],
      [P.scenes.length, "scene"],
    ].map(([n, word]) => P.element("li", {}, P.element("b", {}, String(n)), ` ${word}${n === 1 ? "" : "s"}`)),
  );
  if (run.complete === false)
    at("warnings").append(
      P.element(
        "p",
        { class: "notice" },
        `The run had not ended: ${P.points.length}${typeof run.points === "number" ? ` of ${run.points}` : ""} points.`,
      ),
    );
  // What speaks against the times.
  const doubts = [
    [(p) => p.timing?.drifts, "drifted while they were timed: heat, load or clock changed between the earlier and the later half"],
    [(p) => p.timing?.repeatable === false, "give another output from frame to frame"],
    [(p) => p.other_programs > 0.1, "were timed while other programs used more than a tenth of the processors"],
  ];
  for (const [doubtful, what] of doubts) {
    const list = P.points.filter((p) => p.status === "ok" && doubtful(p));
    if (!list.length) continue;
    at("warnings").append(
      P.element(
        "details",
        { class: "notice doubt" },
        P.element("summary", {}, `${list.length} of ${P.points.length} points ${what}`),
        P.element(
          "ul",
          {},
          ...list.slice(0, 50).map((p) =>
            P.element("li", {}, P.element("button", { class: "link", onclick: () => P.show_details(p) }, `${P.technique_label(p.technique)} · ${p.scene} · ${P.variant_text(p, P.swept_keys)}`)),
          ),
          list.length > 50 ? P.element("li", {}, "…") : null,
        ),
      ),
    );
  }
  if (P.data.warnings?.length)
    at("warnings").append(
      P.element(
        "details",
        { class: "notice" },
        P.element("summary", {}, `${P.data.warnings.length} pictures could not be shown`),
        P.element("ul", {}, ...P.data.warnings.map((w) => P.element("li", {}, w))),
      ),
    );

  const draw_legend = () =>
    at("legend").replaceChildren(
      ...P.techniques.map((technique) =>
        P.element(
          "button",
          {
            type: "button",
            "aria-pressed": String(!P.filter.hidden.has(technique)),
            title: "Show or hide in plots and table",
            "data-technique": technique,
            onclick: () => {
              if (!P.filter.hidden.delete(technique)) P.filter.hidden.add(technique);
              P.filter_changed();
              at("legend")
                .querySelector(`[data-technique="${CSS.escape(technique)}"]`)
                ?.focus();
            },
          },
          P.marker_icon(technique),
          P.technique_label(technique),
        ),
      ),
    );
  draw_legend();
  P.on_filter(draw_legend);
  P.on_scheme_change(() => {
    draw_legend();
    P.build_glance(at("glance-table"));
    P.build_flicker(at("flicker"));
  });

  P.build_glance(at("glance-table"));
  P.build_gallery(at("gallery"), at("gallery-link"));
  P.build_sequences(at("sequences"), at("sequences-link"));
  P.build_flicker(at("flicker"));
  P.build_diagnostics(at("diagnostics"), at("diagnostics-link"));
  P.build_viewer(at("viewer"));
  P.build_plots(at("plot-cards"));
  P.build_table(at("table"));
  P.build_scenes(at("scene-report"));
  P.build_provenance(at("provenance-report"));
  P.build_details();
})();
