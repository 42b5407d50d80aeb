// Signed error maps. The pictures hold the error as 128 + 127 sign(e) sqrt|e|; an SVG filter turns that code into colour
// for the range asked for, which works on pictures from disk, where scripts may not read pixels.
(() => {
  // Test darker than the reference: blue; lighter: red. [Brewer RdBu], readable with any colour vision.
  const stops = [
    "#053061",
    "#2166ac",
    "#4393c3",
    "#92c5de",
    "#f7f7f7",
    "#f4a582",
    "#d6604d",
    "#b2182b",
    "#67001f",
  ].map((c) => [1, 3, 5].map((i) => parseInt(c.slice(i, i + 2), 16)));
  const colour_at = (t) => {
    const x = Math.min(1, Math.max(0, (t + 1) / 2)) * (stops.length - 1),
      i = Math.min(stops.length - 2, Math.floor(x));
    return stops[i].map((c, k) => c + (stops[i + 1][k] - c) * (x - i));
  };
  const decode = (code) => {
    const root = (code - 128) / 127;
    return Math.sign(root) * Math.min(1, root * root);
  };

  let functions = [];
  P.make_error_filter = () => {
    functions = ["R", "G", "B"].map((channel) => P.svg(`feFunc${channel}`, { type: "table" }));
    return P.svg(
      "svg",
      { width: 0, height: 0, class: "filters", "aria-hidden": "true" },
      P.svg(
        "filter",
        {
          id: "signed-error",
          "color-interpolation-filters": "sRGB",
          x: "0",
          y: "0",
          width: "1",
          height: "1",
        },
        P.svg("feComponentTransfer", {}, ...functions),
      ),
    );
  };
  P.set_error_range = (range) => {
    const colours = Array.from({ length: 256 }, (_, code) => colour_at(decode(code) / range));
    functions.forEach((f, k) =>
      f.setAttribute("tableValues", colours.map((c) => (c[k] / 255).toFixed(4)).join(" ")),
    );
  };
  // ends: what the left end, the whole and the right end say.
  P.colour_bar = (range, ends) => {
    const gradient = Array.from(
      { length: 33 },
      (_, i) =>
        `rgb(${colour_at(i / 16 - 1)
          .map(Math.round)
          .join(",")}) ${((100 * i) / 32).toFixed(2)}%`,
    );
    const ticks = [-1, -0.5, 0, 0.5, 1].map((t) =>
      P.element("span", {}, (t > 0 ? "+" : "") + P.number(t * range, 3)),
    );
    return P.element(
      "figure",
      {
        class: "colour-bar",
        role: "img",
        "aria-label": `Colours from ${-range} (${ends[0]}) to ${range} (${ends[2]})`,
      },
      P.element(
        "div",
        { class: "ends" },
        ...ends.map((text) => P.element("span", {}, text)),
      ),
      P.element("div", {
        class: "gradient",
        style: `background:linear-gradient(to right,${gradient.join(",")})`,
      }),
      P.element("div", { class: "ticks" }, ...ticks),
    );
  };
})();
