// Numbers and names as people read them, and a small helper to make elements (always from text, never from markup).
(() => {
  const names = {
    frame_ms: "frame",
    build_ms: "build",
    setup_ms: "set-up",
    "metrics.mae": "MAE",
    "metrics.rmse": "RMSE",
    "metrics.max": "max",
    "metrics.psnr": "PSNR",
    "metrics.ssim": "SSIM",
    "metrics.flip": "FLIP",
    "metrics.bias": "bias",
    "metrics.acne": "acne",
    "metrics.leak": "leak",
    "metrics.evaluated_pixels": "evaluated pixels",
    "metrics.reference_standard_error": "reference std. error",
    "metrics_matched.mae": "MAE, matched",
    "metrics_matched.max": "max, matched",
    "metrics_matched.pixels_off": "pixels off",
    "metrics_matched.mask_bit_mismatch": "mask bit mismatch",
    frame_time: "time per frame",
    speed_up: "speed-up over ray tracing",
  };
  const units = { frame_ms: "ms", build_ms: "ms", setup_ms: "ms", "metrics.psnr": "dB" };

  P.label = (key) =>
    names[key] ?? key.replace(/^(metrics|metrics_matched|memory)\./, "").replaceAll("_", " ");
  P.unit = (key) => units[key] ?? (key.endsWith("_ms") ? "ms" : key.endsWith("_bytes") ? "bytes" : "");
  P.label_with_unit = (key) => (P.unit(key) ? `${P.label(key)} (${P.unit(key)})` : P.label(key));

  const exponents = {
    "-": "⁻",
    0: "⁰",
    1: "¹",
    2: "²",
    3: "³",
    4: "⁴",
    5: "⁵",
    6: "⁶",
    7: "⁷",
    8: "⁸",
    9: "⁹",
  };
  const power = (text) => [...text].map((c) => exponents[c]).join("");

  // `digits` significant ones; powers of ten outside [1e-4, 1e7).
  P.number = (value, digits = 4) => {
    if (value === null || value === undefined || Number.isNaN(value)) return "–";
    if (value === 0) return "0";
    const size = Math.abs(value);
    const sign = value < 0 ? "−" : "";
    if (Number.isInteger(value) && size < 1e15 && digits >= 4)
      return sign + (size < 10000 ? String(size) : size.toLocaleString("en").replaceAll(",", " "));
    if (size < 1e-4 || size >= 1e7) {
      const [mantissa, exponent] = size.toExponential(Math.min(digits, 3) - 1).split("e");
      const factor = Number(mantissa) === 1 ? "" : `${Number(mantissa)}·`;
      return `${sign}${factor}10${power(String(Number(exponent)))}`;
    }
    return sign + String(Number(size.toPrecision(digits)));
  };
  P.bytes = (value) => {
    if (typeof value !== "number") return "–";
    let unit = 0;
    while (value >= 1024 && unit < 4) ((value /= 1024), ++unit);
    return `${Number(value.toPrecision(3))} ${["B", "KiB", "MiB", "GiB", "TiB"][unit]}`;
  };
  P.value_text = (value) => {
    if (value === null || value === undefined) return "–";
    if (Array.isArray(value))
      return value
        .map((v) => P.value_text(v))
        .join(value.length === 2 && value.every(Number.isInteger) ? " × " : ", ");
    if (typeof value === "number") return P.number(value, 6);
    if (typeof value === "object") return JSON.stringify(value);
    return String(value);
  };

  // element("button", { class: "x", onclick: f, "aria-label": "y" }, child, "text", ...)
  P.element = (tag, attributes = {}, ...children) => {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
      if (value === null || value === undefined || value === false) continue;
      if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
      else made.setAttribute(name, value === true ? "" : value);
    }
    made.append(...children.filter((child) => child !== null && child !== undefined));
    return made;
  };
  P.select = (label, options, value, change) => {
    const box = P.element(
      "select",
      { onchange: () => change(box.value) },
      ...options.map(([v, text]) => P.element("option", { value: v }, text)),
    );
    box.value = value;
    return P.element("label", { class: "field" }, P.element("span", {}, label), box);
  };
  // A row of exclusive choices, as radio buttons: arrow keys move between them.
  let groups = 0;
  P.choices = (label, options, value, change) => {
    const name = `choice-${++groups}`;
    return P.element(
      "fieldset",
      { class: "choices" },
      P.element("legend", {}, label),
      ...options.map(([v, text]) =>
        P.element(
          "label",
          {},
          P.element("input", {
            type: "radio",
            name,
            value: v,
            checked: v === value,
            onchange: () => change(v),
          }),
          P.element("span", {}, text),
        ),
      ),
    );
  };
})();
