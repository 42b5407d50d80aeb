// The pictures of one scene: all techniques beside the reference, two under a slider, or several flicked in one place.
(() => {
  const layers = { shaded: "Shaded", visibility: "Visibility", error: "Signed error" };
  const { state, common_keys, with_pictures, candidates, best_of, fill_tiles, refit_tiles } = P.tiles;
  const { source_of, name_of, variant_of } = P.tiles;
  let host, stage, bar, common_row;

  const image = (tile, more = {}) => {
    const { src, coded } = source_of(tile);
    if (!src) return P.element("span", { class: "missing" }, "no such picture");
    return P.element("img", {
      src,
      alt: `${name_of(tile)}, ${variant_of(tile)}, ${layers[state.layer].toLowerCase()}`,
      draggable: "false",
      decoding: "sync",
      ...more,
      class: `${coded ? "coded" : ""} ${more.class ?? ""}`,
    });
  };
  const view = (tile, ...children) => {
    const [w, h] = tile.point.params.resolution ?? [1, 1];
    return P.element(
      "div",
      { class: "view", style: `aspect-ratio:${w || 1}/${h || 1}` },
      ...children,
      P.element("i", { class: "cross" }),
    );
  };

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

  const side_by_side = () => {
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
    return [
      P.element(
        "div",
        { class: "tiles" },
        ...state.tiles.map((tile, i) =>
          P.element("figure", { class: "tile" }, view(tile, image(tile)), caption(tile, i)),
        ),
      ),
      P.element("p", { class: "add" }, add),
    ];
  };

  const tile_options = () =>
    state.tiles.map((tile, i) => [
      String(i),
      `${name_of(tile)}${tile.technique && variant_of(tile) ? ` (${variant_of(tile)})` : ""}`,
    ]);
  const tag = (side, tile) => P.element("span", { class: `tag ${side}` }, name_of(tile));
  const slider = () => {
    const a = state.tiles[state.a],
      b = state.tiles[state.b];
    const range = P.element("input", {
      type: "range",
      min: 0,
      max: 100,
      step: 0.5,
      value: state.split,
      class: "split",
      "aria-label": "Where the two pictures meet",
      oninput: () => {
        state.split = Number(range.value);
        frame.style.setProperty("--split", `${state.split}%`);
      },
    });
    const handle = P.element("div", { class: "handle", "aria-hidden": "true" });
    const frame = view(
      a,
      P.element("div", { class: "half right" }, image(b)),
      P.element("div", { class: "half left" }, image(a)),
      handle,
      tag("left", a),
      tag("right", b),
    );
    frame.style.setProperty("--split", `${state.split}%`);
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      event.stopPropagation();
      handle.onpointermove = (e) => {
        const r = frame.getBoundingClientRect();
        range.value = String(Math.min(100, Math.max(0, (100 * (e.clientX - r.left)) / r.width)));
        range.dispatchEvent(new Event("input"));
      };
    });
    handle.addEventListener("pointerup", () => {
      handle.onpointermove = null;
    });
    const pick = (key) => (v) => {
      state[key] = Number(v);
      draw();
    };
    return [
      P.element(
        "div",
        { class: "controls" },
        P.select("Left", tile_options(), String(state.a), pick("a")),
        P.select("Right", tile_options(), String(state.b), pick("b")),
      ),
      P.element("div", { class: "single" }, frame, range),
    ];
  };

  const show_flick = (index) => {
    if (index !== state.current) [state.previous, state.current] = [state.current, index];
    stage
      .querySelectorAll(".flick img, .flick .missing")
      .forEach((img, i) => img.classList.toggle("shown", i === state.current));
    stage.querySelectorAll(".flick-list button").forEach((b, i) => {
      b.setAttribute("aria-pressed", i === state.current);
      b.classList.toggle("other", i === state.previous);
    });
    const name = stage.querySelector(".flick .tag");
    if (name) name.textContent = name_of(state.tiles[state.current]);
  };
  const stop_timer = () => {
    clearInterval(state.timer);
    state.timer = null;
  };
  const flick = () => {
    state.current = Math.min(state.current, state.tiles.length - 1);
    state.previous = Math.min(state.previous, state.tiles.length - 1);
    const frame = view(
      state.tiles[state.current],
      ...state.tiles.map((tile) => image(tile)),
      tag("left", state.tiles[state.current]),
    );
    frame.classList.add("flick");
    const auto = P.element(
      "button",
      {
        type: "button",
        "aria-pressed": "false",
        onclick: () => {
          if (state.timer) stop_timer();
          else state.timer = setInterval(() => show_flick(state.previous), 600);
          auto.setAttribute("aria-pressed", String(state.timer !== null));
        },
      },
      "Alternate",
    );
    const list = P.element(
      "div",
      { class: "flick-list", role: "group", "aria-label": "Picture shown" },
      ...tile_options().map(([, text], i) =>
        P.element(
          "button",
          { type: "button", onclick: () => show_flick(i) },
          P.element("kbd", {}, String(i + 1)),
          text,
        ),
      ),
    );
    return [
      P.element("div", { class: "single" }, frame),
      P.element(
        "div",
        { class: "controls" },
        list,
        P.element(
          "button",
          { type: "button", class: "swap", onclick: () => show_flick(state.previous) },
          P.element("kbd", {}, "Space"),
          "swap the last two",
        ),
        auto,
      ),
    ];
  };

  const draw = () => {
    stop_timer();
    host.classList.toggle("coded-layer", state.layer === "error");
    bar.hidden = state.layer !== "error";
    const made = { side: side_by_side, slider, flick }[state.mode]();
    stage.replaceChildren(...made);
    if (state.mode === "flick") show_flick(state.current);
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
  const draw_bar = () => {
    P.set_error_range(state.range);
    bar.replaceChildren(
      P.select(
        "Range",
        [1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01].map((r) => [String(r), `± ${r}`]),
        String(state.range),
        (v) => {
          state.range = Number(v);
          draw_bar();
        },
      ),
      P.colour_bar(state.range),
    );
  };

  const on_key = (event) => {
    if (
      /^(SELECT|INPUT|TEXTAREA)$/.test(event.target.tagName) ||
      event.altKey ||
      event.ctrlKey ||
      event.metaKey
    )
      return;
    const digit = /^[1-9]$/.test(event.key) ? Number(event.key) - 1 : -1;
    if (state.mode === "flick" && event.key === " " && event.target.tagName !== "BUTTON")
      show_flick(state.previous);
    else if (state.mode === "flick" && digit >= 0 && digit < state.tiles.length) show_flick(digit);
    else if (!P.zoom_key(event)) return;
    event.preventDefault();
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
    host = element;
    const available = Object.entries(layers).filter(([key]) =>
      P.points.some((p) => p.pictures[key] || (key === "error" && p.pictures.error_code)),
    );
    if (!available.some(([key]) => key === state.layer)) state.layer = available[0]?.[0] ?? "visibility";
    stage = P.element("div", {
      class: "stage",
      tabindex: 0,
      role: "group",
      "aria-label": "Pictures; + and − zoom, arrows pan, 0 resets, digits and space choose in flick mode",
    });
    bar = P.element("div", { class: "controls range-bar" });
    common_row = P.element("div", { class: "inline" });
    element.replaceChildren(
      P.make_error_filter(),
      P.element(
        "div",
        { class: "controls" },
        P.choices(
          "Scene",
          scenes.map((s) => [s, s]),
          scenes[0],
          set_scene,
        ),
        P.choices("Show", available, state.layer, (v) => {
          state.layer = v;
          draw();
        }),
        P.choices(
          "As",
          [
            ["side", "Side by side"],
            ["slider", "Slider"],
            ["flick", "Flick"],
          ],
          state.mode,
          (v) => {
            state.mode = v;
            draw();
          },
        ),
        common_row,
        P.element("div", { class: "corner" }, P.element("output", { class: "place" }), P.zoom_controls()),
      ),
      bar,
      stage,
      P.element(
        "p",
        { class: "note" },
        "Double-click or Ctrl + wheel zooms, dragging pans; all pictures stay in step. Visibility is shown linearly (grey = V).",
      ),
    );
    stage.addEventListener("keydown", on_key);
    P.make_zoom_live(element);
    draw_bar();
    set_scene(scenes[0]);
    P.on_scheme_change(draw);
  };
})();
