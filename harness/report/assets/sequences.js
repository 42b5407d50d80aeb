// Sequences of frames: a contact sheet of each technique and variant beside the reference, played in place, and the flicker
// and time of each frame below.
(() => {
  const most_shown = 10;
  const picture_of = (p) => p.pictures.shaded ?? p.pictures.visibility;
  const truth_of = (p) => (p.pictures.shaded ? (p.pictures.reference_shaded ?? p.pictures.reference) : p.pictures.reference);
  const in_frames = (p) => typeof p.frame === "number" && picture_of(p);
  const same = (p) => JSON.stringify([p.scene, p.technique, Object.entries(p.params).filter(([k]) => k !== "frame")]);

  // Evenly picked, the first and the last among them.
  const picked = (list) =>
    list.length <= most_shown
      ? list
      : Array.from({ length: most_shown }, (_, i) => list[Math.round((i * (list.length - 1)) / (most_shown - 1))]);

  const strip_of = (frames, source, alt) =>
    P.element(
      "div",
      { class: "contact" },
      ...picked(frames).map((p) =>
        P.element(
          "figure",
          {},
          P.element("img", { src: source(p), alt: `${alt}, frame ${p.frame}`, loading: "lazy" }),
          P.element("figcaption", {}, String(p.frame)),
        ),
      ),
    );

  const curve = (frames, get, unit, colour) => {
    const values = frames.map(get);
    const known = values.filter((v) => typeof v === "number");
    if (known.length < 2) return null;
    const most = Math.max(...known) || 1,
      x = (i) => 4 + (392 * i) / Math.max(1, values.length - 1),
      y = (v) => 50 - (42 * v) / most;
    const at = values.map((v, i) => (typeof v === "number" ? `${x(i).toFixed(1)},${y(v).toFixed(1)}` : null)).filter(Boolean);
    return P.svg(
      "svg",
      { viewBox: "0 0 400 68", class: "strip", role: "img", "aria-label": `${unit} by frame, at most ${P.number(most, 3)}` },
      P.svg("line", { x1: 4, x2: 396, y1: 50, y2: 50, class: "axis" }),
      P.svg("polyline", { points: at.join(" "), fill: "none", stroke: colour, "stroke-width": 1.6 }),
      P.svg("text", { x: 4, y: 64, class: "tick" }, `${unit}: at most ${P.number(most, 3)}`),
    );
  };

  const row = (frames, keys) => {
    const first = frames[0],
      label = P.technique_label(first.technique),
      colour = P.colour(first.technique);
    return P.element(
      "div",
      { class: "sequence-row" },
      P.element("h4", {}, P.marker_icon(first.technique), ` ${[label, P.variant_text(first, keys)].filter(Boolean).join(", ")}`),
      strip_of(frames, picture_of, label),
      P.element(
        "div",
        { class: "curves" },
        ...[
          curve(frames, (p) => p.metrics?.flicker, "flicker", colour),
          curve(frames, (p) => P.stat(p, "frame_ms")?.median, "ms per frame", colour),
        ].filter(Boolean),
      ),
    );
  };

  // All rows of a scene played in step: the reference first.
  const player = (rows, truth) => {
    const tiles = [...(truth ? [["Reference", truth, truth_of]] : []), ...rows.map((f) => [P.technique_label(f[0].technique), f, picture_of])].map(
      ([name, frames, source]) => {
        const image = P.element("img", { src: source(frames[0]), alt: `${name}, played`, draggable: "false" });
        return { frames, source, image, figure: P.element("figure", {}, image, P.element("figcaption", {}, name)) };
      },
    );
    const count = Math.max(...tiles.map((t) => t.frames.length)),
      at = P.element("output", {});
    let now = 0,
      timer = null;
    const show = (frame) => {
      now = frame % count;
      for (const t of tiles) t.image.src = t.source(t.frames[Math.min(now, t.frames.length - 1)]);
      place.value = String(now);
      at.textContent = `frame ${now}`;
    };
    const place = P.element("input", {
      type: "range",
      min: 0,
      max: count - 1,
      value: 0,
      "aria-label": "Frame",
      oninput: () => show(Number(place.value)),
    });
    const button = P.element(
      "button",
      {
        type: "button",
        "aria-pressed": "false",
        onclick: () => {
          if (timer) timer = clearInterval(timer) ?? null;
          else timer = setInterval(() => show(now + 1), 125);
          button.setAttribute("aria-pressed", String(timer !== null));
        },
      },
      "Play",
    );
    show(0);
    return [P.element("div", { class: "controls" }, button, place, at), P.element("div", { class: "player" }, ...tiles.map((t) => t.figure))];
  };

  const card = (scene, list) => {
    const rows = P.unique(list.map(same)).map((s) => list.filter((p) => same(p) === s).sort((a, b) => a.frame - b.frame));
    const truth = rows.find((frames) => frames.every(truth_of));
    const keys = P.variant_keys(list).filter((k) => k !== "frame");
    return P.element(
      "article",
      { class: "card" },
      P.element("h3", {}, scene),
      ...player(rows, truth),
      ...(truth ? [P.element("div", { class: "sequence-row" }, P.element("h4", {}, "Reference"), strip_of(truth, truth_of, "Reference"))] : []),
      ...rows.map((frames) => row(frames, keys)),
    );
  };

  P.build_sequences = (section, link) => {
    const points = P.points.filter(in_frames);
    const moving = P.unique(points.map((p) => p.frame)).length > 1;
    section.hidden = link.hidden = !moving;
    if (!moving) return;
    section.querySelector(".sequences").replaceChildren(
      ...P.unique(points.map((p) => p.scene)).map((scene) =>
        card(scene, points.filter((p) => p.scene === scene)),
      ),
    );
  };
})();
