// The results table.
(() => {
  let columns = [],
    sorted = [],
    sort = { column: null, down: false },
    focus = 0;
  let scroller, table, body, count, rows;

  const cell_text = (c, p) => {
    const value = c.get(p);
    if (c.text) return c.text(p);
    return c.numeric && typeof value === "number" ? P.number(value) : P.value_text(value);
  };
  const compare = (a, b) => {
    const value = (p) => sort.column.get(p);
    const [x, y] = [value(a), value(b)];
    const missing = (v) => v === null || v === undefined;
    if (missing(x) || missing(y)) return missing(x) - missing(y) || a.index - b.index; // last, either way
    const numeric = P.axis_number(x) !== null && P.axis_number(y) !== null;
    const order = numeric
      ? P.axis_number(x) - P.axis_number(y)
      : P.value_text(x).localeCompare(P.value_text(y), "en", { numeric: true });
    return (sort.down ? -order : order) || a.index - b.index;
  };

  const interval_text = (c, p) => {
    const interval = c.interval?.(p);
    if (!interval || !interval.every(Number.isFinite)) return null;
    return `${P.number(interval[0], 3)} – ${P.number(interval[1], 3)}`;
  };
  const cell = (c, p) => {
    if (c.key === "technique")
      return P.element(
        "th",
        { scope: "row" },
        P.element(
          "button",
          { class: "open", tabindex: -1, title: "Details of this point" },
          P.marker_icon(p.technique),
          cell_text(c, p),
        ),
      );
    if (c.key === "status")
      return P.element(
        "td",
        { class: `status ${p.status}`, title: p.message ?? null },
        P.element("span", { class: "dot" }),
        p.status,
      );
    const interval = interval_text(c, p);
    return P.element(
      "td",
      { class: c.numeric ? "num" : null },
      cell_text(c, p),
      interval ? P.element("small", { title: "95 % confidence interval of the median" }, interval) : null,
    );
  };

  // A point without a result says why in place of its figures, which stand after the status.
  const cells_of = (p) => {
    const at = columns.findIndex((c) => c.key === "status"),
      rest = columns.slice(at + 1);
    if (!p.message || !rest.length || rest.some((c) => typeof c.get(p) === "number"))
      return columns.map((c) => cell(c, p));
    return [
      ...columns.slice(0, at + 1).map((c) => cell(c, p)),
      P.element("td", { class: "message", colspan: rest.length, title: p.message }, p.message),
    ];
  };

  // Widths are fixed from the rows' texts (of many rows, from a sample), so that nothing jumps while scrolling.
  const width_of = (c) => {
    if (c.key === "status") return 16;
    let longest = P.label_with_unit(c.key).length * 0.95 + 2.6;
    const stride = Math.ceil(P.points.length / 1000);
    for (let i = 0; i < P.points.length; i += stride) {
      const p = P.points[i],
        interval = interval_text(c, p);
      longest = Math.max(
        longest,
        cell_text(c, p).length +
          (interval ? interval.length * 0.8 + 2.5 : 0) +
          (c.key === "technique" ? 5 : 0),
      );
    }
    return Math.min(longest, 46) + 3;
  };

  const header = () =>
    P.element(
      "thead",
      {},
      P.element(
        "tr",
        { "aria-rowindex": 1 },
        ...columns.map((c) => {
          const on = sort.column === c;
          return P.element(
            "th",
            {
              scope: "col",
              class: c.numeric ? "num" : null,
              "aria-sort": on ? (sort.down ? "descending" : "ascending") : "none",
              "data-key": c.key,
              title: `${c.group}: ${c.key}`,
            },
            P.element(
              "button",
              { onclick: () => sort_by(c) },
              P.label_with_unit(c.key),
              P.element("span", { class: "arrow", "aria-hidden": "true" }, on ? (sort.down ? "▼" : "▲") : ""),
            ),
          );
        }),
      ),
    );

  const row_of = (p, place) =>
    P.element(
      "tr",
      {
        tabindex: place === focus ? 0 : -1,
        "data-row": place,
        "data-point": p.index,
        "aria-rowindex": place + 2,
        class: p.status,
      },
      ...cells_of(p),
    );

  const rebuild = () => {
    columns = P.columns.filter((c) => c.shown);
    table.style.width = `${columns.reduce((sum, c) => sum + (c.width ??= width_of(c)), 0)}ch`;
    table.replaceChildren(
      P.element("caption", { class: "hidden" }, "One row per point"),
      P.element("colgroup", {}, ...columns.map((c) => P.element("col", { style: `width:${c.width}ch` }))),
      header(),
      body,
    );
    refresh();
  };
  const refresh = () => {
    sorted = sort.column ? [...P.shown].sort(compare) : P.shown;
    focus = Math.min(focus, Math.max(0, sorted.length - 1));
    table.setAttribute("aria-rowcount", sorted.length + 1);
    count.textContent =
      sorted.length === P.points.length
        ? `${sorted.length} points`
        : `${sorted.length} of ${P.points.length} points`;
    rows.draw();
  };
  const sort_by = (c) => {
    sort = { column: c, down: sort.column === c ? !sort.down : false };
    const key = c.key;
    rebuild();
    table.querySelector(`thead [data-key="${CSS.escape(key)}"] button`)?.focus();
  };

  const on_key = (event) => {
    const row = event.target.closest("tr[data-row]");
    if (!row) return;
    const to = rows.step(event.key, Number(row.dataset.row));
    if (to !== undefined) rows.reveal((focus = to), table.tHead.offsetHeight);
    else if (event.key === "Enter" || event.key === " ") P.show_details(P.points[Number(row.dataset.point)]);
    else return;
    event.preventDefault();
  };

  const column_menu = () => {
    const groups = P.unique(P.columns.map((c) => c.group)).filter((g) => g !== "point");
    return P.element(
      "details",
      { class: "menu" },
      P.element("summary", {}, "Columns"),
      P.element(
        "div",
        { class: "menu-body" },
        ...groups.map((group) =>
          P.element(
            "fieldset",
            {},
            P.element("legend", {}, group),
            ...P.columns
              .filter((c) => c.group === group)
              .map((c) =>
                P.element(
                  "label",
                  {},
                  P.element("input", {
                    type: "checkbox",
                    checked: c.shown,
                    onchange: (e) => {
                      c.shown = e.target.checked;
                      rebuild();
                    },
                  }),
                  P.label(c.key),
                ),
              ),
          ),
        ),
      ),
    );
  };
  const debounced = (callback) => {
    let timer;
    return (event) => {
      clearTimeout(timer);
      timer = setTimeout(() => callback(event), 120);
    };
  };

  P.build_table = (host) => {
    const set = (key) => (value) => {
      P.filter[key] = value;
      P.filter_changed();
    };
    count = P.element("output", { class: "count", "aria-live": "polite" });
    body = P.element("tbody");
    table = P.element("table", { class: "results" });
    scroller = P.element("div", { class: "table-scroll", tabindex: -1 }, table);
    rows = P.rows_in_sight({ scroller, body, items: () => sorted, row: row_of, columns: () => columns.length });
    table.addEventListener("keydown", on_key);
    body.addEventListener("click", (event) => {
      const row = event.target.closest("tr[data-row]");
      if (!row || getSelection().toString()) return;
      focus = Number(row.dataset.row);
      P.show_details(P.points[Number(row.dataset.point)]);
    });
    host.replaceChildren(
      P.element(
        "div",
        { class: "controls" },
        P.element(
          "label",
          { class: "field grow" },
          P.element("span", {}, "Filter"),
          P.element("input", {
            type: "search",
            id: "filter-text",
            placeholder: "words, or mask_size=16  rmse<0.01  scene!=nest",
            spellcheck: "false",
            oninput: debounced((e) => set("text")(e.target.value)),
          }),
        ),
        P.select("Scene", [["", "all"], ...P.scenes.map((s) => [s, s])], "", set("scene")),
        P.select("Status", [["", "all"], ...P.statuses.map((s) => [s, s])], "", set("status")),
        column_menu(),
        count,
      ),
      scroller,
      P.element(
        "p",
        { class: "note" },
        "The filter holds for the plots too. Click a row, or press Enter on it, for all parameters, passes, counters, raw samples and the command that runs it again.",
      ),
    );
    rebuild();
    P.on_filter(() => {
      scroller.scrollTop = 0;
      refresh();
    });
  };
})();
