// The results as the page sees them: points, the parameters that were swept, columns, and techniques' looks.
const P = { data: window.penumbra_data, styles: window.penumbra_styles };

(() => {
  const points = P.data.points;
  points.forEach((point, index) => {
    point.index = index;
    point.pictures = P.data.pictures[index] || {};
  });
  P.points = points;

  const unique = (values) => [...new Set(values)];
  P.unique = unique;
  P.techniques = unique(points.map((p) => p.technique));
  P.scenes = unique(points.map((p) => p.scene));
  P.statuses = unique(points.map((p) => p.status));

  // The frame of a sequence behaves as a parameter.
  const has_frames = unique(points.map((p) => p.frame ?? null).filter((f) => f !== null)).length > 1;
  P.param = (point, key) => (key === "frame" ? (point.frame ?? null) : point.params[key]);
  P.param_keys = unique([...(has_frames ? ["frame"] : []), ...points.flatMap((p) => Object.keys(p.params))]);

  // Values of one parameter among points, in order: numbers by size, the rest as they come.
  P.axis_number = (value) => {
    if (typeof value === "number") return value;
    if (Array.isArray(value) && value.length && value.every((v) => typeof v === "number"))
      return value.reduce((a, b) => a * b, 1);
    return null;
  };
  P.values_of = (list, key) => {
    const seen = new Map();
    for (const p of list) {
      const value = P.param(p, key);
      if (value !== undefined && value !== null) seen.set(JSON.stringify(value), value);
    }
    const values = [...seen.values()];
    return values.every((v) => P.axis_number(v) !== null)
      ? values.sort((a, b) => P.axis_number(a) - P.axis_number(b))
      : values;
  };

  // A parameter is swept when one technique has points with different values of it.
  const by_technique = P.techniques.map((t) => points.filter((p) => p.technique === t));
  P.swept_keys = P.param_keys.filter((key) => by_technique.some((list) => P.values_of(list, key).length > 1));

  // The parameters in which these points differ, as text: what tells one from the others.
  P.variant_keys = (list) => P.swept_keys.filter((key) => P.values_of(list, key).length > 1);
  P.variant_text = (point, keys) =>
    keys
      .filter((key) => P.param(point, key) !== undefined && P.param(point, key) !== null)
      .map((key) => `${P.label(key)} ${P.value_text(P.param(point, key))}`)
      .join(", ");

  P.style = (technique) => {
    if (P.styles[technique]) return { id: technique, ...P.styles[technique] };
    const spare = P.styles[""];
    let hash = 7;
    for (const c of technique) hash = (hash * 31 + c.codePointAt(0)) >>> 0;
    return {
      id: technique,
      label: technique.replaceAll("_", " "),
      colour: spare.colours[hash % spare.colours.length],
      dark: spare.darks[hash % spare.darks.length],
      marker: spare.markers[(hash >>> 5) % spare.markers.length],
    };
  };
  const dark_scheme = window.matchMedia("(prefers-color-scheme: dark)");
  const printing = window.matchMedia("print");
  P.is_dark = () => dark_scheme.matches && !printing.matches;
  P.on_scheme_change = (callback) => dark_scheme.addEventListener("change", callback);
  P.colour = (technique) => (P.is_dark() ? P.style(technique).dark : P.style(technique).colour);
  P.technique_label = (technique) => P.style(technique).label;

  const stat = (point, name) => point.timing?.[name] ?? null;
  P.stat = stat;
  // setup_ms and the like may stand as a plain number beside the STATs.
  const median = (value) => (typeof value === "number" ? value : (value?.median ?? null));

  const numeric_keys = (part) =>
    unique(
      points.flatMap((p) =>
        Object.entries(p[part] || {})
          .filter(([, v]) => v === null || typeof v === "number")
          .map(([k]) => k),
      ),
    );
  const shown_metrics = ["mae", "rmse", "psnr", "ssim", "flip", "bias"];
  const shown_matched = ["mae", "pixels_off", "mask_bit_mismatch"];

  const column = (key, group, get, more = {}) => ({
    key,
    group,
    get,
    label: P.label(key),
    numeric: true,
    shown: true,
    ...more,
  });
  P.make_columns = () => [
    column("technique", "point", (p) => p.technique, {
      numeric: false,
      text: (p) => P.technique_label(p.technique),
    }),
    column("scene", "point", (p) => p.scene, { numeric: false }),
    ...P.param_keys.map((key) =>
      column(key, "parameters", (p) => P.param(p, key), {
        numeric: P.values_of(points, key).every((v) => P.axis_number(v) !== null),
        param: true,
        shown: P.swept_keys.includes(key),
      }),
    ),
    column("status", "point", (p) => p.status, { numeric: false }),
    ...unique(["frame_ms", "build_ms", ...points.flatMap((p) => Object.keys(p.timing || {}))])
      .filter((key) => key !== "passes" && points.some((p) => median(stat(p, key)) !== null))
      .map((key) =>
        column(key, "timing", (p) => median(stat(p, key)), {
          interval: (p) => stat(p, key)?.ci95,
          shown: key === "frame_ms" || key === "build_ms",
        }),
      ),
    ...numeric_keys("metrics").map((key) =>
      column("metrics." + key, "converged reference", (p) => p.metrics?.[key], {
        shown: shown_metrics.includes(key),
      }),
    ),
    ...numeric_keys("metrics_matched").map((key) =>
      column("metrics_matched." + key, "matched reference", (p) => p.metrics_matched?.[key], {
        shown: shown_matched.includes(key),
      }),
    ),
    ...numeric_keys("memory").map((key) =>
      column("memory." + key, "memory", (p) => p.memory?.[key], { shown: false }),
    ),
  ];

  // Time relative to the anchor technique at the same scene, camera, light and light samples.
  const anchor = P.techniques.includes("ray_tracing") ? "ray_tracing" : null;
  const shared = [
    "resolution",
    "mask_size",
    "light_samples",
    "light_pattern",
    "light_rotation",
    "accumulate",
    "light_size",
    "light",
    "camera",
    "seed",
  ];
  const situation = (p) =>
    JSON.stringify([p.scene, p.frame ?? null, ...shared.map((key) => p.params[key] ?? null)]);
  const anchors = new Map();
  for (const p of points) {
    const time = median(stat(p, "frame_ms"));
    if (p.technique !== anchor || time === null) continue;
    const key = situation(p);
    if (!anchors.has(key) || anchors.get(key) > time) anchors.set(key, time);
  }
  P.anchor = anchor;
  P.speed_up = (p) => {
    const time = median(stat(p, "frame_ms")),
      base = anchors.get(situation(p));
    return time > 0 && base !== undefined ? base / time : null;
  };
})();
