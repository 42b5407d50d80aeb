// Sequences and diagnostic pictures: drives the report and writes what it found into the document, as selftest.js does.
(async () => {
  const checks = [];
  const check = (name, ok, found = null) => checks.push({ name, ok: Boolean(ok), found: found === null ? null : String(found) });
  const all = (selector) => [...document.querySelectorAll(selector)];
  const one = (selector) => document.querySelector(selector);
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const data = window.penumbra_data;
  try {
    check("sequences are shown", !one("#sequences").hidden && !one("#sequences-link").hidden);
    const frames = new Set(data.points.map((p) => p.frame)).size;
    const sheets = all("#sequences .contact");
    const variants = data.points.length / frames;
    check("a contact sheet for each variant and the reference", sheets.length === variants + 1, sheets.length);
    check("with every frame of few", sheets.every((s) => s.querySelectorAll("img").length === Math.min(frames, 10)));
    check("and the flicker and time of each frame", all("#sequences .curves").every((c) => c.querySelectorAll("polyline").length === 2));
    const output = one("#sequences output"),
      played = all("#sequences .player img");
    check("played beside the reference", played.length === variants + 1, played.length);
    const place = one("#sequences .controls input");
    place.value = "1";
    place.dispatchEvent(new Event("input"));
    check("a frame can be chosen", output.textContent === "frame 1", output.textContent);
    one("#sequences .controls button").click();
    await wait(1000);
    check("it plays", one("#sequences .controls button").getAttribute("aria-pressed") === "true" && output.textContent !== "frame 1", output.textContent);
    one("#sequences .controls button").click();
    const now = output.textContent;
    await wait(400);
    check("and stops", output.textContent === now);

    check("diagnostics are shown", !one("#diagnostics").hidden && !one("#diagnostics-link").hidden);
    const shown = data.points.find((p) => p.diagnostics);
    const figures = all("#diagnostics .card:first-child figure");
    check("each has its figure", figures.length === shown.diagnostics.length, figures.length);
    for (const d of shown.diagnostics) check(`'${d.title}' stands there as text`, one("#diagnostics").textContent.includes(d.title));
    check("figures have a scale", one("#diagnostics .gradient") !== null && one("#diagnostics .ticks").textContent.includes("99"));
    check("classes have names", all("#diagnostics .pass-key li").some((li) => li.textContent.includes("penumbra (7)")));
    for (const img of all("#diagnostics img, #sequences img")) {
      img.loading = "eager";
      for (let i = 0; i < 50 && !img.complete; i++) await wait(20);
      check(`picture ${img.getAttribute("src")}`, img.naturalWidth > 0);
    }
    const page = document.documentElement;
    check("nothing is wider than the window", page.scrollWidth <= page.clientWidth, `${page.scrollWidth} ${page.clientWidth}`);
    check("titles are text, not markup", window.hacked === undefined);
  } catch (error) {
    window.page_errors.push(String(error.stack || error));
  }
  const pre = document.createElement("pre");
  pre.id = "selftest";
  pre.textContent = JSON.stringify({ errors: window.page_errors, checks, points: data.points.length })
    .replaceAll("<", "\\u003c")
    .replaceAll("&", "\\u0026")
    .replaceAll(">", "\\u003e");
  document.body.prepend(pre);
})();
