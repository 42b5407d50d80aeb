// Drives the report as a reader does and writes what it found into the document. Loaded after the page's own scripts.
(async () => {
  const checks = [];
  const check = (name, ok, found = null) =>
    checks.push({ name, ok: Boolean(ok), found: found === null ? null : String(found) });
  const all = (selector) => [...document.querySelectorAll(selector)];
  const one = (selector) => document.querySelector(selector);
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const rows = () => all(".results tbody tr[data-row]");
  const cells = (key) => {
    const at = all(".results thead th").findIndex((th) => th.dataset.key === key);
    return rows().map((row) => row.children[at].firstChild.textContent);
  };
  const header = (key) => one(`.results thead th[data-key="${key}"] button`);
  const filter = async (text) => {
    one("#filter-text").value = text;
    one("#filter-text").dispatchEvent(new Event("input"));
    await wait(200);
  };
  const key = (target, name) =>
    target.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true }));
  const choose = (text) => {
    const label = all(".choices label").find((l) => l.textContent === text);
    label.querySelector("input").click();
  };
  const ascending = (list) => list.every((v, i) => i === 0 || list[i - 1] <= v);
  const numbers = (list) => list.map((t) => Number(t.replaceAll(" ", "").replace("−", "-")));
  const data = window.penumbra_data,
    total = data.points.length;

  const table = async () => {
    check("every point has its row", Number(one(".results").getAttribute("aria-rowcount")) === total + 1);
    check("the first row exists", rows().length > 0, rows().length);
    header("frame_ms").click();
    const up = numbers(cells("frame_ms")).filter((v) => !Number.isNaN(v));
    check("sorted upwards", up.length > 5 && ascending(up), up);
    check("says so", one('[data-key="frame_ms"]').getAttribute("aria-sort") === "ascending");
    header("frame_ms").click();
    const down = numbers(cells("frame_ms")).filter((v) => !Number.isNaN(v));
    check("sorted downwards", ascending([...down].reverse()) && down[0] >= up[up.length - 1], down);
    await filter("mask_size=8 gears");
    const expected = data.points.filter((p) => p.params.mask_size === 8 && p.technique === "gears").length;
    check(
      "filtered by text",
      Number(one(".results").getAttribute("aria-rowcount")) === expected + 1,
      one(".count").textContent,
    );
    check(
      "only what was asked for is left",
      new Set(cells("technique")).size === 1 || rows().every((r) => r.textContent.includes("GEARS")),
    );
    await filter("frame_ms<50");
    const quick = data.points.filter((p) => p.timing && p.timing.frame_ms.median < 50).length;
    check(
      "filtered by a number",
      Number(one(".results").getAttribute("aria-rowcount")) === quick + 1,
      `${one(".count").textContent}, expected ${quick}`,
    );
    await filter("no such thing anywhere");
    check(
      "an empty filter result is said",
      rows().length === 0 && one(".count").textContent.startsWith("0 of"),
    );
    await filter("");
    check("all rows are back", Number(one(".results").getAttribute("aria-rowcount")) === total + 1);
    const legend = one("#legend button");
    const marks = all("#plots .mark").length;
    legend.click();
    check(
      "a technique switched off leaves plots and table",
      all("#plots .mark").length < marks && Number(one(".results").getAttribute("aria-rowcount")) < total + 1,
    );
    one("#legend button").click();
    check("and comes back", all("#plots .mark").length === marks);
    const scroller = one(".table-scroll");
    scroller.scrollTop = scroller.scrollHeight;
    scroller.dispatchEvent(new Event("scroll"));
    check(
      "scrolled to the last row",
      rows().some((r) => Number(r.dataset.row) === total - 1),
      rows().at(-1)?.dataset.row,
    );
    scroller.scrollTop = 0;
    scroller.dispatchEvent(new Event("scroll"));
    rows()[0].focus();
    key(rows()[0], "ArrowDown");
    check(
      "arrow keys move between rows",
      document.activeElement.dataset?.row === "1",
      document.activeElement.dataset?.row,
    );
    key(document.activeElement, "End");
    check(
      "End goes to the last row",
      document.activeElement.dataset?.row === String(total - 1),
      document.activeElement.dataset?.row,
    );
    key(document.activeElement, "Home");
  };

  const details = () => {
    key(document.activeElement, "Enter");
    const box = one("#details");
    check("Enter opens the details", box.open);
    const point = data.points.find((p) => location.hash === `#point-${p.id}`);
    check("the address names the point", point !== undefined, location.hash);
    check(
      "its command stands there",
      box.querySelector(".command code").textContent === point?.command,
      box.querySelector(".command code").textContent,
    );
    check("with a button to copy it", box.querySelector("button.copy") !== null);
    check(
      "its raw samples stand there",
      point?.timing === undefined || box.querySelectorAll(".raw").length >= 1,
    );
    check(
      "its passes stand there",
      point?.timing === undefined ||
        box.querySelectorAll(".pass-bar span").length === Object.keys(point.timing.passes).length,
    );
    box.close();
    check("and closes", !box.open);
  };

  const plots = () => {
    check(
      "plots are drawn",
      all("#plots .chart").length >= 3 && all("#plots .mark").length >= 6,
      all("#plots .mark").length,
    );
    check(
      "no coordinate is undefined",
      !all("#plots svg *").some((e) => [...e.attributes].some((a) => /NaN|undefined|Infinity/.test(a.value))),
    );
    for (const input of all("#plots .choices input")) {
      input.click();
      check(`plotted against ${input.value}`, input.closest(".card").querySelectorAll(".mark").length > 0);
    }
  };

  const loaded = async (img) => {
    for (let i = 0; i < 50 && !(img.complete && img.naturalWidth > 0); ++i) await wait(20);
    return img.complete && img.naturalWidth > 0;
  };
  const viewer = async () => {
    const pictures = all("#viewer .tile img");
    pictures.forEach((img) => {
      img.loading = "eager";
    });
    check(
      "pictures stand side by side with the reference",
      pictures.length >= 4 && one("#viewer .tile strong").textContent === "Reference",
      pictures.length,
    );
    for (const img of pictures) check(`loaded ${img.getAttribute("src")}`, await loaded(img));
    choose("Signed error");
    check("the error has a colour bar", one(".colour-bar") !== null && !one(".range-bar").hidden);
    check(
      "and its pictures are coloured",
      all("#viewer img.coded").length >= 3 &&
        getComputedStyle(one("img.coded")).filter.includes("signed-error"),
    );
    choose("Visibility");
    check("the bar goes with it", one(".range-bar").hidden);
    one('[aria-label="Zoom in"]').click();
    const transforms = new Set(all("#viewer .view img").map((img) => getComputedStyle(img).transform));
    check(
      "all pictures zoom in step",
      transforms.size === 1 && [...transforms][0].startsWith("matrix(2,"),
      [...transforms].join(),
    );
    key(one(".stage"), "ArrowRight");
    const moved = new Set(all("#viewer .view img").map((img) => getComputedStyle(img).transform));
    check("and pan in step", moved.size === 1 && [...moved][0] !== [...transforms][0], [...moved].join());
    key(one(".stage"), "0");

    choose("Slider");
    const split = one("#viewer input.split");
    split.value = "25";
    split.dispatchEvent(new Event("input"));
    check(
      "the slider cuts the picture",
      getComputedStyle(one(".half.left")).clipPath.includes("75%"),
      getComputedStyle(one(".half.left")).clipPath,
    );
    check("two pictures lie on each other", all(".single .view img").length === 2);

    choose("Flick");
    const shown = () => all(".flick img").findIndex((img) => getComputedStyle(img).visibility === "visible");
    const before = shown();
    key(one(".stage"), " ");
    const after = shown();
    check("space flicks to the other picture", before !== after && after >= 0, `${before} ${after}`);
    key(one(".stage"), " ");
    check("and back", shown() === before);
    key(one(".stage"), "3");
    check("a digit chooses a picture", shown() === 2, shown());
    check(
      "only one is visible",
      all(".flick img").filter((img) => getComputedStyle(img).visibility === "visible").length === 1,
    );
    const places = new Set(all(".flick img").map((img) => JSON.stringify(img.getBoundingClientRect())));
    check("all lie in the same place", places.size === 1);
    choose("Side by side");
  };

  const gallery = async () => {
    const named = data.points.filter((p) => p.title && p.status === "ok");
    const section = one("#gallery");
    check("the gallery is there when exhibits are", section.hidden === !named.length);
    check("and so is its link", one("#gallery-link").hidden === !named.length);
    if (!named.length) return;
    const titles = new Set(named.map((p) => p.title));
    check("one card for each title", all(".exhibit").length === titles.size, all(".exhibit").length);
    check("which it names", one(".exhibit h3").textContent.includes(named[0].title), one(".exhibit h3").textContent);
    check("and explains", one(".exhibit").textContent.includes(named[0].caption));
    const pictures = all(".exhibit img");
    check("every variant and the truth are shown", pictures.length > named.length, pictures.length);
    for (const img of pictures) check(`exhibit ${img.getAttribute("src")}`, await loaded(img));
    const img = one(".exhibit .view[title] img"),
      own = img.src;
    img.parentElement.dispatchEvent(new PointerEvent("pointerdown"));
    check("held, a picture shows the truth", img.src !== own);
    img.parentElement.dispatchEvent(new PointerEvent("pointerup"));
    check("let go, itself", img.src === own);
  };

  const fits_the_window = () => {
    const page = document.documentElement;
    check("nothing is wider than the window", page.scrollWidth <= page.clientWidth, `${page.scrollWidth} ${page.clientWidth}`);
  };

  try {
    const hostile = data.points.some((p) => p.scene.includes("<"));
    if (total > 0) {
      await table();
      details();
      plots();
    } else {
      check("an empty run says so", one("#viewer .empty") !== null && one("#plots .empty") !== null);
    }
    fits_the_window();
    await gallery();
    if (data.pictures.some((p) => p.visibility)) await viewer();
    if (hostile) {
      check(
        "names are text, not markup",
        document.querySelector("[onmouseover]") === null && window.hacked === undefined,
      );
      check(
        "and stand there unchanged",
        one(".glance").textContent.includes(data.points.find((p) => p.scene.includes("<")).scene),
      );
    }
    check(
      "nothing was asked of a network",
      performance.getEntriesByType("resource").every((e) => /^(file|data):/.test(e.name)),
      performance
        .getEntriesByType("resource")
        .map((e) => e.name)
        .filter((n) => !/^(file|data):/.test(n)),
    );
    check("provenance stands there", one("#provenance-report").textContent.includes("EPYC"));
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
