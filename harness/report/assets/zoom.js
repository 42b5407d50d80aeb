// Zoom and pan, the same for every picture in sight. A view is an element of class "view" with img children.
(() => {
  const state = { scale: 1, x: 0, y: 0 }; // x, y: the view's top left corner as a share of the picture
  let host, readout;

  const clamp = (v, lo, hi) => Math.min(hi, Math.max(lo, v));
  const views = () => host.querySelectorAll(".view");
  const apply = () => {
    state.x = clamp(state.x, 0, 1 - 1 / state.scale);
    state.y = clamp(state.y, 0, 1 - 1 / state.scale);
    host.style.setProperty(
      "--zoom",
      `translate(${-state.x * state.scale * 100}%, ${-state.y * state.scale * 100}%) scale(${state.scale})`,
    );
    host.classList.toggle("zoomed", state.scale > 1);
    readout.textContent = `${P.number(state.scale, 3)}×`;
  };
  // Keeps the picture's point under (u, v) of the view where it is.
  const zoom_at = (u, v, factor) => {
    const px = state.x + u / state.scale,
      py = state.y + v / state.scale;
    state.scale = clamp(state.scale * factor, 1, 64);
    state.x = px - u / state.scale;
    state.y = py - v / state.scale;
    apply();
  };
  const pan = (dx, dy) => {
    state.x += dx / state.scale;
    state.y += dy / state.scale;
    apply();
  };
  const place_in = (view, event) => {
    const r = view.getBoundingClientRect();
    return [(event.clientX - r.left) / r.width, (event.clientY - r.top) / r.height];
  };

  // The same place marked in all views, and its pixel named.
  const mark = (view, event) => {
    const [u, v] = place_in(view, event);
    host.style.setProperty("--u", `${u * 100}%`);
    host.style.setProperty("--v", `${v * 100}%`);
    const img = view.querySelector("img");
    const place = host.querySelector(".place");
    if (img?.naturalWidth && place)
      place.textContent = `pixel ${Math.floor((state.x + u / state.scale) * img.naturalWidth)}, ${Math.floor((state.y + v / state.scale) * img.naturalHeight)}`;
    for (const other of views()) other.classList.toggle("marked", other !== view);
  };

  P.zoom_state = state;
  P.zoom_controls = () => {
    readout = P.element("output", { class: "zoom" }, "1×");
    const button = (text, label, action) =>
      P.element("button", { type: "button", "aria-label": label, title: label, onclick: action }, text);
    return P.element(
      "div",
      { class: "zoom-controls", role: "group", "aria-label": "Zoom" },
      button("−", "Zoom out", () => zoom_at(0.5, 0.5, 0.5)),
      readout,
      button("+", "Zoom in", () => zoom_at(0.5, 0.5, 2)),
      button("Reset", "Whole picture", () => {
        Object.assign(state, { scale: 1, x: 0, y: 0 });
        apply();
      }),
    );
  };
  P.zoom_key = (event) => {
    const step = 0.12,
      moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
    if (event.key in moves && state.scale > 1) pan(...moves[event.key]);
    else if (event.key === "+" || event.key === "=") zoom_at(0.5, 0.5, 1.5);
    else if (event.key === "-") zoom_at(0.5, 0.5, 1 / 1.5);
    else if (event.key === "0") (Object.assign(state, { scale: 1, x: 0, y: 0 }), apply());
    else return false;
    return true;
  };
  P.make_zoom_live = (element) => {
    host = element;
    apply();
    let drag = null;
    host.addEventListener(
      "wheel",
      (event) => {
        const view = event.target.closest(".view");
        // A page must stay scrollable over pictures: the wheel zooms with Ctrl, or once a picture has been clicked.
        if (!view || !(event.ctrlKey || event.metaKey || host.contains(document.activeElement))) return;
        event.preventDefault();
        zoom_at(...place_in(view, event), 2 ** (-event.deltaY / 300));
      },
      { passive: false },
    );
    host.addEventListener("dblclick", (event) => {
      const view = event.target.closest(".view");
      if (view) zoom_at(...place_in(view, event), event.shiftKey ? 0.5 : 2);
    });
    host.addEventListener("pointerdown", (event) => {
      const view = event.target.closest(".view");
      if (!view || event.button !== 0 || event.target.closest(".handle")) return;
      drag = { view, x: event.clientX, y: event.clientY };
      view.setPointerCapture?.(event.pointerId);
    });
    host.addEventListener("pointermove", (event) => {
      const view = event.target.closest(".view");
      if (drag) {
        const r = drag.view.getBoundingClientRect();
        pan((drag.x - event.clientX) / r.width, (drag.y - event.clientY) / r.height);
        Object.assign(drag, { x: event.clientX, y: event.clientY });
      }
      if (view) mark(view, event);
    });
    const end = () => {
      drag = null;
    };
    host.addEventListener("pointerup", end);
    host.addEventListener("pointercancel", end);
    host.addEventListener("pointerleave", () => {
      for (const view of views()) view.classList.remove("marked");
      const place = host.querySelector(".place");
      if (place) place.textContent = "";
    });
  };
})();
