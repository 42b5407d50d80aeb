// Which pictures the viewer shows: one tile per technique, at the values of the parameters that the techniques share.
(() => {
  const common_keys = [
    "resolution",
    "camera",
    "light",
    "light_size",
    "mask_size",
    "light_samples",
    "light_pattern",
    "light_rotation",
    "accumulate",
    "frame",
    "seed",
  ];
  const state = { ...P.stage_state(), scene: null, common: {} };

  const with_pictures = (scene) =>
    P.points.filter((p) => p.scene === scene && Object.keys(p.pictures).length);
  const matches = (p) =>
    Object.entries(state.common).reduce((n, [key, value]) => {
      const own = P.param(p, key);
      return n + (own === undefined || own === null || JSON.stringify(own) === value ? 1 : 0);
    }, 0);
  const error_of = (p) => p.metrics?.rmse ?? Infinity;

  // What a technique can show for the common parameters chosen; all it has when nothing fits.
  const candidates = (technique) => {
    const list = with_pictures(state.scene).filter((p) => p.technique === technique);
    const best = Math.max(...list.map(matches));
    return list.filter((p) => matches(p) === best);
  };
  const best_of = (list) => list.reduce((a, b) => (error_of(b) < error_of(a) ? b : a));
  const reference_of = (tiles) =>
    tiles.find((t) => t.point?.pictures.reference || t.point?.pictures.reference_shaded)?.point ?? null;

  const fill_tiles = () => {
    const own = with_pictures(state.scene);
    const techniques = P.techniques.filter((t) => own.some((p) => p.technique === t));
    const tiles = techniques.map((technique) => ({ technique, point: best_of(candidates(technique)) }));
    const reference = reference_of(tiles);
    state.tiles = reference ? [{ technique: null, point: reference }, ...tiles] : tiles;
    state.a = 0;
    state.b = Math.min(1, state.tiles.length - 1);
    state.current = state.b;
    state.previous = state.a;
  };
  // After a common parameter changed: every tile goes to its nearest picture.
  const refit_tiles = () => {
    for (const tile of state.tiles)
      if (tile.technique) {
        const list = candidates(tile.technique);
        if (!list.includes(tile.point)) tile.point = best_of(list);
      }
    const reference = reference_of(state.tiles.filter((t) => t.technique));
    for (const tile of state.tiles) if (!tile.technique && reference) tile.point = reference;
  };

  const source_of = (tile) => {
    const pictures = tile.point.pictures;
    if (!tile.technique)
      return {
        src:
          state.layer === "shaded"
            ? (pictures.reference_shaded ?? pictures.reference)
            : (pictures.reference ?? pictures.reference_shaded),
      };
    if (state.layer === "error")
      return pictures.error_code ? { src: pictures.error_code, coded: true } : { src: pictures.error };
    return { src: pictures[state.layer] };
  };
  const name_of = (tile) => (tile.technique ? P.technique_label(tile.technique) : "Reference");
  const variant_keys = (tile) =>
    P.variant_keys(with_pictures(state.scene).filter((p) => p.technique === tile.technique));
  const variant_of = (tile) =>
    tile.technique ? P.variant_text(tile.point, variant_keys(tile)) : "converged";

  P.reference_text = (point) => {
    const samples = P.data.run?.config?.reference?.light_samples;
    if (samples === 0) return "Embree, the same light samples";
    const text =
      typeof samples === "number" ? `Embree, ${P.number(samples)} light samples` : "Embree, converged";
    return point.metrics?.reference_standard_error > 0
      ? `${text}, std. error ${P.number(point.metrics.reference_standard_error, 2)}`
      : text;
  };
  P.tiles = {
    state,
    common_keys,
    with_pictures,
    candidates,
    best_of,
    fill_tiles,
    refit_tiles,
    source_of,
    name_of,
    variant_of,
  };
})();
