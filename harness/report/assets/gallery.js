// The exhibits: entries of the config that have a title, each named and explained beside its pictures and the truth.
(() => {
  const view_keys = ["resolution", "camera", "light", "light_size", "seed"];
  const view_of = (p) => JSON.stringify([p.scene, p.frame ?? null, ...view_keys.map((k) => P.param(p, k) ?? null)]);
  const has_picture = (p) => Boolean(p.pictures.shaded ?? p.pictures.visibility);
  const picture_of = (p) => p.pictures.shaded ?? p.pictures.visibility;
  const truth_of = (p) =>
    p.pictures.shaded
      ? (p.pictures.reference_shaded ?? p.pictures.reference)
      : (p.pictures.reference ?? p.pictures.reference_shaded);

  // In the order of the config; of a sequence the last frame.
  const exhibits = () => {
    const order = new Map((P.data.run?.config?.techniques ?? []).map((entry, i) => [entry.title, i]));
    const named = P.points.filter((p) => p.title && (has_picture(p) || p.status !== "ok"));
    const last = Math.max(...named.map((p) => p.frame ?? 0));
    const titles = P.unique(named.map((p) => p.title));
    return titles
      .sort((a, b) => (order.get(a) ?? Infinity) - (order.get(b) ?? Infinity))
      .map((title) => {
        const points = named.filter((p) => p.title === title && (p.frame ?? last) === last);
        return { title, caption: points[0]?.caption ?? "", points };
      })
      .filter((e) => e.points.length);
  };

  const frame_of = (p, ...children) => {
    const [w, h] = p.params.resolution ?? [1, 1];
    return P.element("div", { class: "view still", style: `aspect-ratio:${w || 1}/${h || 1}` }, ...children);
  };
  // Held down, a picture shows the truth in its place.
  const technique_figure = (p, keys) => {
    if (!has_picture(p))
      return P.element("figure", {}, frame_of(p, P.element("span", { class: "missing" }, `${p.status}: ${p.message ?? ""}`)));
    const image = P.element("img", { src: picture_of(p), alt: `${p.title}: ${P.technique_label(p.technique)}`, draggable: "false" });
    const frame = frame_of(p, image);
    const truth = truth_of(p);
    if (truth) {
      frame.title = "Hold to see the reference";
      frame.addEventListener("pointerdown", () => (image.src = truth));
      for (const end of ["pointerup", "pointerleave", "pointercancel"])
        frame.addEventListener(end, () => (image.src = picture_of(p)));
    }
    // A technique without light samples is matched at the light's centre, which is not what the reference beside it shows.
    const sampled = typeof p.metrics_matched?.mask_bit_mismatch === "number";
    const off = sampled ? p.metrics_matched.mae : (p.metrics?.mae ?? p.metrics_matched?.mae);
    return P.element(
      "figure",
      {},
      frame,
      P.element(
        "figcaption",
        {},
        P.element("strong", {}, P.variant_text(p, keys) || P.technique_label(p.technique)),
        typeof off === "number" ? ` · ${P.number(100 * off, 2)} % wrong · ` : " · ",
        P.element("button", { class: "link", onclick: () => P.show_details(p) }, "details"),
      ),
    );
  };
  const truth_figure = (p) =>
    P.element(
      "figure",
      {},
      frame_of(p, P.element("img", { src: truth_of(p), alt: "reference", draggable: "false" })),
      P.element("figcaption", {}, P.element("strong", {}, "Reference"), ` · ${p.scene}`),
    );

  const card = ({ title, caption, points }, index) => {
    const keys = P.variant_keys(points).filter((key) => !view_keys.includes(key));
    const figures = P.unique(points.map(view_of)).flatMap((view) => {
      const own = points.filter((p) => view_of(p) === view);
      const known = own.find((p) => truth_of(p));
      return [...own.map((p) => technique_figure(p, keys)), ...(known ? [truth_figure(known)] : [])];
    });
    const techniques = P.unique(points.map((p) => P.technique_label(p.technique))).join(", ");
    return P.element(
      "article",
      { class: "card exhibit", "data-figures": figures.length },
      P.element("h3", {}, P.element("span", { class: "number" }, String(index + 1)), title),
      P.element("p", { class: "technique" }, techniques),
      P.element("p", {}, caption),
      P.element("div", { class: "exhibit-row" }, ...figures),
    );
  };

  P.build_gallery = (section, link) => {
    const list = exhibits();
    section.hidden = link.hidden = !list.length;
    section.querySelector(".exhibits").replaceChildren(...list.map(card));
  };
})();
