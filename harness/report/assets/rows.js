// The rows of a long table. Only those in sight exist in the document, so ten thousand cost no more than fifty.
(() => {
  const row_height = 33, // as report.css has it
    margin_rows = 12,
    print_limit = 2000;

  // `items()`: all rows in order; `row(item, place)`: the element of one, with data-row = place; `columns()`: their number.
  // Draws again when it is scrolled, printed or sized.
  P.rows_in_sight = ({ scroller, body, items, row, columns }) => {
    const spacer = (rows) =>
      P.element(
        "tr",
        { class: "spacer", "aria-hidden": "true" },
        P.element("td", { colspan: columns(), style: `height:${rows * row_height}px` }),
      );
    const draw = (everything = false) => {
      const all = items(),
        in_sight = Math.ceil((scroller.clientHeight || 600) / row_height) + 2 * margin_rows;
      const first = everything ? 0 : Math.max(0, Math.floor(scroller.scrollTop / row_height) - margin_rows);
      const last = Math.min(all.length, everything ? print_limit : first + in_sight);
      const focused = body.contains(document.activeElement) ? document.activeElement.closest("tr")?.dataset.row : undefined;
      body.replaceChildren(
        ...(first ? [spacer(first)] : []),
        ...all.slice(first, last).map((item, i) => row(item, first + i)),
        ...(last < all.length && !everything ? [spacer(all.length - last)] : []),
      );
      if (focused !== undefined) focus(focused);
    };
    const focus = (place) => body.querySelector(`[data-row="${place}"]`)?.focus({ preventScroll: true });
    // Scrolls no farther than it takes to see the row, below the table's head.
    const reveal = (place, head) => {
      const y = place * row_height;
      if (y < scroller.scrollTop) scroller.scrollTop = y;
      else if (y + row_height + head > scroller.scrollTop + scroller.clientHeight)
        scroller.scrollTop = y + row_height + head - scroller.clientHeight;
      draw();
      focus(place);
    };
    const page = () => Math.floor(scroller.clientHeight / row_height) - 2;
    // Where a key leads from the row at `place`; undefined for other keys.
    const step = (key, place) => {
      const to = {
        ArrowDown: place + 1,
        ArrowUp: place - 1,
        PageDown: place + page(),
        PageUp: place - page(),
        Home: 0,
        End: items().length - 1,
      }[key];
      return to === undefined ? undefined : Math.min(Math.max(0, to), items().length - 1);
    };
    scroller.addEventListener("scroll", () => draw());
    addEventListener("beforeprint", () => draw(true));
    addEventListener("afterprint", () => draw());
    addEventListener("resize", () => draw());
    P.on_scheme_change(() => draw());
    return { draw, reveal, step };
  };
})();
