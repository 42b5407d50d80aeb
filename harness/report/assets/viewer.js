// The pictures of one scene: all techniques beside the reference.
(() => {
  const all_layers = {
    shaded: { label: "Shaded" },
    visibility: { label: "Visibility" },
    error: { label: "Signed error", ends: ["test darker", "test − reference", "test lighter"] },
  };
  const { state, common_keys, with_pictures, candidates, best_of, fill_tiles, refit_tiles } = P.tiles;
  const { source_of, name_of, variant_of } = P.tiles;
  let draw, common_row;

  const figures = (point) => {
    const time = P.stat(point, "frame_ms")?.median,
      rmse = point.metrics?.rmse;
    return [
      time === undefined ? null : `${P.number(time, 3)} ms`,
      typeof rmse === "number" ? `RMSE ${P.number(rmse, 2)}` : null,
    ]
      .filter(Boolean)
      .join(" · ");
  };
  const variant_select = (tile) => {
    const list = candidates(tile.technique),
      all = list.includes(tile.point) ? list : [tile.point, ...list];
    const keys = P.variant_keys(all);
    if (all.length < 2) return P.element("span", { class: "variant" }, variant_of(tile));
    const box = P.element(
      "select",
      {
        "aria-label": `${name_of(tile)}: which variant`,
        onchange: () => {
          tile.point = P.points[Number(box.value)];
          draw();
        },
      },
      ...all.map((p) => P.element("option", { value: p.index }, P.variant_text(p, keys) || "default")),
    );
    box.value = String(tile.point.index);
    return box;
  };
  const caption = (tile, index) =>
    P.element(
      "figcaption",
      {},
      P.element(
        "div",
        { class: "name" },
        tile.technique ? P.marker_icon(tile.technique) : "",
        P.element("strong", {}, name_of(tile)),
        tile.technique
          ? P.element("button", { class: "link", onclick: () => P.show_details(tile.point) }, "details")
          : "",
        tile.extra
          ? P.element(
              "button",
              {
                class: "link",
                "aria-label": `Remove ${name_of(tile)}`,
                onclick: () => {
                  state.tiles.splice(index, 1);
                  draw();
                },
              },
              "remove",
            )
          : "",
      ),
      tile.technique
        ? variant_select(tile)
        : P.element("span", { class: "variant" }, P.reference_text(tile.point)),
      P.element("span", { class: "figures" }, tile.technique ? figures(tile.point) : ""),
    );

  const add_select = () => {
    const add = P.element(
      "select",
      {
        "aria-label": "Add a picture",
        onchange: () => {
          state.tiles.push({ technique: add.value, point: best_of(candidates(add.value)), extra: true });
          draw();
        },
      },
      P.element("option", { value: "" }, "+ another variant of …"),
      ...P.unique(state.tiles.map((t) => t.technique).filter(Boolean)).map((t) =>
        P.element("option", { value: t }, P.technique_label(t)),
      ),
    );
    return P.element("p", { class: "add" }, add);
  };

  const draw_common = () => {
    const list = with_pictures(state.scene);
    const keys = common_keys.filter((key) => P.values_of(list, key).length > 1);
    for (const key of keys) {
      const values = P.values_of(list, key);
      if (!values.some((v) => JSON.stringify(v) === state.common[key]))
        state.common[key] = JSON.stringify(values[values.length - 1]);
    }
    for (const key of Object.keys(state.common)) if (!keys.includes(key)) delete state.common[key];
    common_row.replaceChildren(
      ...keys.map((key) =>
        P.select(
          P.label(key),
          P.values_of(list, key).map((v) => [JSON.stringify(v), P.value_text(v)]),
          state.common[key],
          (v) => {
            state.common[key] = v;
            refit_tiles();
            draw();
          },
        ),
      ),
    );
  };
  const set_scene = (scene) => {
    state.scene = scene;
    draw_common();
    fill_tiles();
    draw();
  };
  P.build_viewer = (element) => {
    const scenes = P.scenes.filter((scene) => with_pictures(scene).length);
    if (!scenes.length) {
      element.replaceChildren(
        P.element(
          "p",
          { class: "empty" },
          'The run has written no pictures ("images": [] in the config, or --no-images).',
        ),
      );
      return;
    }
    const layers = Object.fromEntries(
      Object.entries(all_layers).filter(([key]) =>
        P.points.some((p) => p.pictures[key] || (key === "error" && p.pictures.error_code)),
      ),
    );
    if (!layers[state.layer]) state.layer = Object.keys(layers)[0] ?? "visibility";
    common_row = P.element("div", { class: "inline" });
    draw = P.make_stage(element, {
      state,
      layers,
      source_of,
      name_of,
      variant_of,
      caption,
      beside: add_select,
      before: [
        P.choices(
          "Scene",
          scenes.map((s) => [s, s]),
          scenes[0],
          set_scene,
        ),
      ],
      after: [common_row],
    });
    set_scene(scenes[0]);
  };
})();
