// Drives the page of two runs as a reader does and writes what it found into the document.
(async () => {
  const checks = [];
  const check = (name, ok, found = null) =>
    checks.push({ name, ok: Boolean(ok), found: found === null ? null : String(found) });
  const all = (selector) => [...document.querySelectorAll(selector)];
  const one = (selector) => document.querySelector(selector);
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const rows = () => all(".verdict-list tbody tr[data-row]");
  const key = (target, name) =>
    target.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true }));
  const choose = (text) => all(".choices label").find((l) => l.textContent === text).querySelector("input").click();
  const row_count = () => Number(one(".verdict-list").getAttribute("aria-rowcount")) - 1;
  const data = window.penumbra_data,
    total = data.points.length,
    with_verdict = (verdict) => data.points.filter((p) => p.verdict === verdict);
  const loaded = async (img) => {
    for (let i = 0; i < 50 && !(img.complete && img.naturalWidth > 0); ++i) await wait(20);
    return img.complete && img.naturalWidth > 0;
  };

  const sums = () => {
    const of = (kind, verdict) => {
      const at = all(".sums thead th").findIndex((th) => th.textContent === verdict);
      return Number(one(`.sums tr[data-kind="${kind}"]`).children[at].textContent);
    };
    const expected = (kind, verdict) =>
      data.points.flatMap((p) => p.findings).filter((f) => f.verdict === verdict && (kind === "time") === f.metric.startsWith("timing.") && (kind === "status") === (f.metric === "status")).length;
    for (const kind of ["status", "quality", "time"])
      for (const verdict of ["pass", "regressed", "missing"])
        check(`${kind}: ${verdict}`, of(kind, verdict) === expected(kind, verdict), `${of(kind, verdict)} ${expected(kind, verdict)}`);
  };
  const table = () => {
    check("every point has its row", row_count() === total, row_count());
    const bad = ["regressed", "missing", "ambiguous"].some((v) => with_verdict(v).length);
    check("the heading says whether all is well", one("#outcome").className === (bad ? "bad" : "good"), one("#outcome").textContent);
    const worst = ["regressed", "missing", "ambiguous", "improved", "added", "pass", "unjudged"].find((v) => with_verdict(v).length);
    check("the worst comes first", rows()[0].children[1].textContent === worst, rows()[0].textContent);
    const scroller = one(".table-scroll");
    scroller.scrollTop = scroller.scrollHeight;
    scroller.dispatchEvent(new Event("scroll"));
    check("scrolled to the last row", rows().some((r) => Number(r.dataset.row) === total - 1), rows().at(-1)?.dataset.row);
    scroller.scrollTop = 0;
    scroller.dispatchEvent(new Event("scroll"));
    const field = one("#filter-text");
    field.value = "gears";
    field.dispatchEvent(new Event("input"));
    const gears = data.points.filter((p) => p.technique === "gears").length;
    check("filtered by text", row_count() === gears, `${row_count()} ${gears}`);
    field.value = "";
    field.dispatchEvent(new Event("input"));
  };
  const pictures = async () => {
    const slower = data.points.find((p) => p.findings.some((f) => f.metric === "timing.frame_ms" && f.verdict === "regressed"));
    const darker = data.points.find((p) => p.findings.some((f) => f.metric === "metrics.rmse" && f.verdict === "regressed"));
    check("time and quality are told apart", slower && darker && slower !== darker);
    one(`tr[data-point="${darker.index}"]`).click();
    check("a click shows the point", one("#point-title").textContent.includes("GEARS"), one("#point-title").textContent);
    const names = all("#stage .tile strong").map((e) => e.textContent);
    check("both runs and the reference stand side by side", names.join() === "Baseline,Current,Reference", names);
    for (const img of all("#stage img")) check(`loaded ${img.getAttribute("src")}`, await loaded(img));
    const [quality, time] = all("#findings .card");
    check("the worse figure stands among quality", quality.textContent.includes("metrics.rmse") && quality.querySelector("tbody tr").textContent.includes("regressed"));
    check("times stand apart", time.textContent.includes("timing.frame_ms") && !quality.textContent.includes("timing."));

    choose("What changed");
    const changed = all("#stage .tile strong").map((e) => e.textContent);
    check("the difference comes first", changed[0] === "Current − baseline", changed);
    check("in colours", getComputedStyle(one("#stage img")).filter.includes("signed-error"));
    check("with their meaning", one(".colour-bar").textContent.includes("current darker"), one(".colour-bar").textContent);
    check("and loads", await loaded(one("#stage img")));
    choose("Visibility");
    choose("Slider");
    const split = one("#stage input.split");
    split.value = "25";
    split.dispatchEvent(new Event("input"));
    check("the slider cuts the picture", getComputedStyle(one(".half.left")).clipPath.includes("75%"));
    choose("Flick");
    const shown = () => all(".flick img").findIndex((img) => getComputedStyle(img).visibility === "visible");
    const before = shown();
    key(one(".stage"), " ");
    check("space flicks between the runs", shown() !== before && [before, shown()].sort().join() === "0,1", `${before} ${shown()}`);
    const sources = all(".flick img").map((img) => img.getAttribute("src"));
    check("which are two files", sources[0].startsWith("baseline/") && sources[1].startsWith("current/"), sources);
    one('[aria-label="Zoom in"]').click();
    const transforms = new Set(all(".flick img").map((img) => getComputedStyle(img).transform));
    check("they zoom in step", transforms.size === 1 && [...transforms][0].startsWith("matrix(2,"), [...transforms].join());
    choose("Side by side");
  };

  try {
    sums();
    table();
    if (data.points.some((p) => p.pictures.difference)) await pictures();
    const page = document.documentElement;
    check("nothing is wider than the window", page.scrollWidth <= page.clientWidth, `${page.scrollWidth} ${page.clientWidth}`);
    check("names are text, not markup", document.querySelector("[onmouseover]") === null && window.hacked === undefined);
    check(
      "nothing was asked of a network",
      performance.getEntriesByType("resource").every((e) => /^(file|data):/.test(e.name)),
    );
  } catch (error) {
    window.page_errors.push(String(error.stack || error));
  }
  const outcome = { errors: window.page_errors, checks, points: total, rows_in_document: rows().length };
  const pre = document.createElement("pre");
  pre.id = "selftest";
  pre.textContent = JSON.stringify(outcome)
    .replaceAll("<", "\\u003c")
    .replaceAll("&", "\\u0026")
    .replaceAll(">", "\\u003e");
  document.body.prepend(pre);
})();
