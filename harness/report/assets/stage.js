// Pictures of one size under one zoom: side by side, two under a slider, or several flicked in one place.
(() => {
  // In what way pictures are shown; the pictures themselves (`tiles`) and the layer of them are the maker's to choose.
  P.stage_state = () => ({
    layer: "shaded",
    mode: "side",
    range: 0.1,
    tiles: [],
    a: 0,
    b: 1,
    current: 0,
    previous: 1,
    split: 50,
    timer: null,
  });

  // parts: state; layers { key: { label, ends } } (with `ends`, the words under its colours, a layer of signed differences);
  // source_of(tile) { src, coded }; name_of(tile); variant_of(tile); caption(tile, index); beside(): what stands below the
  // tiles, or null; layer_changed(); before, after: controls. A tile has a `point`. Returns draw().
  P.make_stage = (host, parts) => {
    const { state, layers, source_of, name_of, variant_of } = parts;
    let stage, bar;

    const image = (tile, more = {}) => {
      const { src, coded } = source_of(tile);
      if (!src) return P.element("span", { class: "missing" }, "no such picture");
      return P.element("img", {
        src,
        alt: `${name_of(tile)}, ${variant_of(tile)}, ${(layers[state.layer]?.label ?? "").toLowerCase()}`,
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

    const side_by_side = () => [
      P.element(
        "div",
        { class: "tiles" },
        ...state.tiles.map((tile, i) =>
          P.element("figure", { class: "tile" }, view(tile, image(tile)), parts.caption(tile, i)),
        ),
      ),
      ...[parts.beside?.()].filter(Boolean),
    ];

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
        P.colour_bar(state.range, layers[state.layer]?.ends ?? []),
      );
    };

    const draw = () => {
      stop_timer();
      const coded = Boolean(layers[state.layer]?.ends);
      host.classList.toggle("coded-layer", coded);
      bar.hidden = !coded;
      if (coded) draw_bar();
      const made = { side: side_by_side, slider, flick }[state.mode]();
      stage.replaceChildren(...made);
      if (state.mode === "flick") show_flick(state.current);
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

    stage = P.element("div", {
      class: "stage",
      tabindex: 0,
      role: "group",
      "aria-label": "Pictures; + and − zoom, arrows pan, 0 resets, digits and space choose in flick mode",
    });
    bar = P.element("div", { class: "controls range-bar" });
    host.replaceChildren(
      P.make_error_filter(),
      P.element(
        "div",
        { class: "controls" },
        ...parts.before,
        P.choices(
          "Show",
          Object.entries(layers).map(([key, layer]) => [key, layer.label]),
          state.layer,
          (v) => {
            state.layer = v;
            parts.layer_changed?.();
            draw();
          },
        ),
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
        ...parts.after,
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
    P.make_zoom_live(host);
    P.set_error_range(state.range);
    P.on_scheme_change(() => draw());
    return draw;
  };
})();
