// The one filter that the table and the plots share: techniques switched off, a scene, a status, and a text.
//   text: words, all of which must match; `key=value`, `key!=value`, `key<number`, `key>number` (also <=, >=) compare a
//   column, anything else is looked for in technique, scene, status, parameters and message.
(() => {
  const listeners = [];
  P.filter = { hidden: new Set(), scene: "", status: "", text: "" };
  P.on_filter = (callback) => listeners.push(callback);
  P.filter_changed = () => {
    P.shown = P.apply_filter();
    listeners.forEach((callback) => callback());
  };

  const haystack = (p) =>
    (p.haystack ??= [
      p.technique,
      P.technique_label(p.technique),
      p.scene,
      p.status,
      p.message ?? "",
      p.id ?? "",
      ...Object.entries(p.params).map(([k, v]) => `${k}=${P.value_text(v).replaceAll(" ", "")}`),
    ]
      .join(" ")
      .toLowerCase());

  const comparisons = {
    "=": (a, b) => a === b,
    "!=": (a, b) => a !== b,
    "<": (a, b) => a < b,
    ">": (a, b) => a > b,
    "<=": (a, b) => a <= b,
    ">=": (a, b) => a >= b,
  };
  const find_column = (name) =>
    P.columns.find((c) => c.key === name) ??
    P.columns.find((c) => c.key === `metrics.${name}`) ??
    P.columns.find((c) => c.key === `metrics_matched.${name}`);

  const compile_word = (word) => {
    const match = /^([\w.]+)(<=|>=|!=|=|<|>)(.*)$/.exec(word);
    const column = match && find_column(match[1].toLowerCase());
    if (!column || match[3] === "") return (p) => haystack(p).includes(word.toLowerCase());
    const [, , operation, wanted] = match;
    return (p) => {
      const value = column.get(p);
      if (value === undefined || value === null) return operation === "!=";
      const number = typeof value === "number" ? value : null;
      if (number !== null && wanted.trim() !== "" && !Number.isNaN(Number(wanted)))
        return comparisons[operation](number, Number(wanted));
      if (operation === "<" || operation === ">" || operation === "<=" || operation === ">=") {
        const size = P.axis_number(value);
        return size !== null && comparisons[operation](size, Number(wanted));
      }
      const text = P.value_text(value).replaceAll(" ", "").toLowerCase();
      return comparisons[operation](text, wanted.toLowerCase().replace("x", text.includes("×") ? "×" : "x"));
    };
  };

  P.apply_filter = () => {
    const { hidden, scene, status, text } = P.filter;
    const tests = text
      .split(/\s+/)
      .filter((word) => word !== "")
      .map(compile_word);
    return P.points.filter(
      (p) =>
        !hidden.has(p.technique) &&
        (scene === "" || p.scene === scene) &&
        (status === "" || p.status === status) &&
        tests.every((test) => test(p)),
    );
  };
})();
