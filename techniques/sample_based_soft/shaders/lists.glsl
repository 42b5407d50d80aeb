// Where the lists of view samples lie: their window in the light's view, and which list is where.
uint tiles_across(uint grid_size) { return (grid_size + tile_side - 1u) / tile_side; }
uint list_count(uint grid_size) { return tiles_across(grid_size) * tiles_across(grid_size) * tile_lists + 1u; }
uint outside_list(uint grid_size) { return list_count(grid_size) - 1u; }

struct Window {
  vec2 lo, scale;   // list = (uv - lo) * scale
};

// Needs the frame's `window` and `widest`.
Window window_of(FrameConstants f, HeaderRef header, uint grid_size, bool fit) {
  vec2 lo = f.window.xy, hi = f.window.zw;
  if (fit) {
    lo = vec2(from_ordered(header.h.lo[0]), from_ordered(header.h.lo[1]));
    hi = vec2(from_ordered(~header.h.hi[0]), from_ordered(~header.h.hi[1]));
    bool none = header.h.lo[0] == 0xffffffffu;
    lo = none ? vec2(0.0) : lo;
    hi = none ? vec2(1.0) : hi;
  }
  vec2 size = max(hi - lo, vec2(1e-6) * f.widest);
  return Window(lo, float(grid_size) / size);
}

// Outliers fall into the lists at the border, whose rectangles have no end; see list_rect().
uint list_of(Window w, uint grid_size, vec2 uv) {
  uvec2 at = uvec2(clamp((uv - w.lo) * w.scale, vec2(0.0), vec2(float(grid_size - 1u))));
  uvec2 tile = at / tile_side, inner = at % tile_side;
  return (tile.y * tiles_across(grid_size) + tile.x) * tile_lists + inner.y * tile_side + inner.x;
}

const float endless = 1e30;

// What a list, or (side = tile_side) a tile of them, covers: u, v of the lower corner, then of the upper.
vec4 rect_at(Window w, uint grid_size, uvec2 first, uint side) {
  // Places are rounded when they are binned, so a list covers a little more.
  vec2 lo = w.lo + (vec2(first) - 1e-3) / w.scale, hi = w.lo + (vec2(first + side) + 1e-3) / w.scale;
  lo = mix(lo, vec2(-endless), equal(first, uvec2(0u)));
  hi = mix(hi, vec2(endless), greaterThanEqual(first + side, uvec2(grid_size)));
  return vec4(lo, hi);
}
vec4 list_rect(Window w, uint grid_size, uint list) {
  uint tile = list / tile_lists, inner = list % tile_lists, across = tiles_across(grid_size);
  return rect_at(w, grid_size, uvec2(tile % across, tile / across) * tile_side + uvec2(inner % tile_side, inner / tile_side), 1u);
}
vec4 tile_rect(Window w, uint grid_size, uint tile) {
  uint across = tiles_across(grid_size);
  return rect_at(w, grid_size, uvec2(tile % across, tile / across) * tile_side, tile_side);
}
