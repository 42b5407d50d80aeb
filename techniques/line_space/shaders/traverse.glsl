// Algorithm 1 [Keul2017, sec. 4.1], one node at a time and without a stack. Also compiles as C++, as members of a struct
// (include after glsl.h) that has N, DEPTH, START, and the pools as tree_entry(place) and line_space_word(place).
//
// All in fine cells: the grid of N^(DEPTH-1) cells a side of the finest nodes that can be subdivided. A walk is at `t` on
// its line, in fine cell `cell`; the nodes of levels 0 ... `level` around that cell have non-empty shafts for the line.
//
// Conservative: what the walk computes lies within the grid's slack (casters.h) of the true line, and triangles are in
// every leaf that they come near by that much. So that nothing is skipped, the walk leaves a box by changing the cell's
// integer coordinate, and takes for granted that it is in the box when it looks for the ways in and out.

const float far_away = 1e30f;

struct Line {  // o + t d
  vec3 o, d, inverse;
};

struct Span {
  float enter, leave;
  uint enter_axis, leave_axis;
};

struct Walk {
  Line line;
  float t, last;
  vec3 cell, start;  // start: the cell in which the segment begins; -1: it begins outside
  uint level;
  uint parent1, parent2, parent3, parent4;  // nodes of levels 1 to 4 around the cell; the root is node 0
  bool done, blocked;
};

float component(vec3 v, uint axis) { return axis == 0u ? v.x : axis == 1u ? v.y : v.z; }

// A direction that is nearly parallel to a plane becomes parallel to it.
Line make_line(vec3 o, vec3 d) {
  float tiny = 1e-9f * max(abs(d.x), max(abs(d.y), abs(d.z)));
  Line r;
  r.o = o;
  r.d = VEC3(abs(d.x) > tiny ? d.x : 0.0f, abs(d.y) > tiny ? d.y : 0.0f, abs(d.z) > tiny ? d.z : 0.0f);
  r.inverse = VEC3(1.0f / r.d.x, 1.0f / r.d.y, 1.0f / r.d.z);
  return r;
}

vec3 at(Line r, float t) { return VEC3(r.o.x + t * r.d.x, r.o.y + t * r.d.y, r.o.z + t * r.d.z); }

float meet_plane(float o, float d, float inverse, float plane, float parallel) {
  return d != 0.0f ? (plane - o) * inverse : parallel;
}

// Where the line enters and leaves a box, around t at which it is inside.
Span span_around(Line r, vec3 lo, float size, float t) {
  float nx = meet_plane(r.o.x, r.d.x, r.inverse.x, r.d.x > 0.0f ? lo.x : lo.x + size, -far_away);
  float ny = meet_plane(r.o.y, r.d.y, r.inverse.y, r.d.y > 0.0f ? lo.y : lo.y + size, -far_away);
  float nz = meet_plane(r.o.z, r.d.z, r.inverse.z, r.d.z > 0.0f ? lo.z : lo.z + size, -far_away);
  float fx = meet_plane(r.o.x, r.d.x, r.inverse.x, r.d.x > 0.0f ? lo.x + size : lo.x, far_away);
  float fy = meet_plane(r.o.y, r.d.y, r.inverse.y, r.d.y > 0.0f ? lo.y + size : lo.y, far_away);
  float fz = meet_plane(r.o.z, r.d.z, r.inverse.z, r.d.z > 0.0f ? lo.z + size : lo.z, far_away);
  Span s;
  s.enter_axis = nx >= ny && nx >= nz ? 0u : ny >= nz ? 1u : 2u;
  s.leave_axis = fx <= fy && fx <= fz ? 0u : fy <= fz ? 1u : 2u;
  s.enter = min(max(nx, max(ny, nz)), t);
  s.leave = max(min(fx, min(fy, fz)), t);
  return s;
}

uint place_on_side(float p, float lo, float per_subside) {
  return uint(clamp(floor((p - lo) * per_subside), 0.0f, float(N - 1u)));
}

uint subside(vec3 p, vec3 lo, float per_subside, uint axis) {
  uint u = place_on_side(axis == 0u ? p.y : p.x, axis == 0u ? lo.y : lo.x, per_subside);
  uint v = place_on_side(axis == 2u ? p.y : p.z, axis == 2u ? lo.y : lo.z, per_subside);
  return v * N + u;
}

uint shaft_index(uint side_a, uint subside_a, uint side_b, uint subside_b) {
  bool ordered = side_a < side_b;
  uint a = ordered ? side_a : side_b, b = ordered ? side_b : side_a;
  uint from = ordered ? subside_a : subside_b, to = ordered ? subside_b : subside_a;
  uint pair = a * (11u - a) / 2u + b - a - 1u;
  return (pair * N * N + from) * N * N + to;
}

// LS(r, n): whether the line's shaft through the node is non-empty. The line is extended to the node's sides where the
// segment begins or ends within.
bool shaft_occupied(uint node, Line r, Span s, vec3 lo, float per_subside) {
  uint enter_side = 2u * s.enter_axis + (component(r.d, s.enter_axis) > 0.0f ? 0u : 1u);
  uint leave_side = 2u * s.leave_axis + (component(r.d, s.leave_axis) > 0.0f ? 1u : 0u);
  uint shaft = shaft_index(enter_side, subside(at(r, s.enter), lo, per_subside, s.enter_axis), leave_side,
                           subside(at(r, s.leave), lo, per_subside, s.leave_axis));
  uint words = (15u * N * N * N * N + 31u) / 32u;
  return (line_space_word(node * words + (shaft >> 5u)) >> (shaft & 31u) & 1u) != 0u;
}

// Fine cells along a side of a node, and one over that. What DEPTH decides comes first, so that it costs nothing.
float node_size(uint level) {
  float n = float(N), s = DEPTH > 1u && level + 1u < DEPTH ? n : 1.0f;
  s *= DEPTH > 2u && level + 2u < DEPTH ? n : 1.0f;
  s *= DEPTH > 3u && level + 3u < DEPTH ? n : 1.0f;
  s *= DEPTH > 4u && level + 4u < DEPTH ? n : 1.0f;
  s *= DEPTH > 5u && level + 5u < DEPTH ? n : 1.0f;
  return s;
}
float node_share(uint level) {
  float n = 1.0f / float(N), s = DEPTH > 1u && level + 1u < DEPTH ? n : 1.0f;
  s *= DEPTH > 2u && level + 2u < DEPTH ? n : 1.0f;
  s *= DEPTH > 3u && level + 3u < DEPTH ? n : 1.0f;
  s *= DEPTH > 4u && level + 4u < DEPTH ? n : 1.0f;
  s *= DEPTH > 5u && level + 5u < DEPTH ? n : 1.0f;
  return s;
}

// Which node of such a size holds a cell, along one axis. Half a cell keeps the quotient away from integers.
float node_place(float cell, float share) { return floor((cell + 0.5f) * share); }

bool same(vec3 a, vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
bool same_node(float a, float b, uint level) {
  float share = node_share(level);
  return node_place(a, share) == node_place(b, share);
}

bool near_cells(float a, float b) { return abs(a - b) <= 1.0f; }

// Nodes that say nothing of a segment that starts in cell `start` [Keul2017, sec. 4.1].
bool skipped(vec3 cell, vec3 start) {
  if (start.x < 0.0f) return false;
  if (START == start_neighbours)
    return near_cells(cell.x, start.x) && near_cells(cell.y, start.y) && near_cells(cell.z, start.z);
  if (START == start_coarse && DEPTH > 2u)
    return same_node(cell.x, start.x, 1u) && same_node(cell.y, start.y, 1u) && same_node(cell.z, start.z, 1u);
  return same(cell, start);
}

bool within(float p, float hi) { return p >= 0.0f && p <= hi; }

Walk begin_walk(vec3 o, vec3 d, float last) {
  Walk w;
  w.line = make_line(o, d);
  float cells = node_size(0u);
  bool starts_inside = o.x >= 0.0f && o.y >= 0.0f && o.z >= 0.0f && o.x < cells && o.y < cells && o.z < cells;
  w.start = starts_inside ? VEC3(floor(o.x), floor(o.y), floor(o.z)) : VEC3(-1.0f, -1.0f, -1.0f);
  Line r = w.line;
  // With t far away in both directions nothing is taken for granted.
  float enter = span_around(r, VEC3(0.0f, 0.0f, 0.0f), cells, far_away).enter;
  float leave = span_around(r, VEC3(0.0f, 0.0f, 0.0f), cells, -far_away).leave;
  bool beside = (r.d.x == 0.0f && !within(o.x, cells)) || (r.d.y == 0.0f && !within(o.y, cells)) ||
                (r.d.z == 0.0f && !within(o.z, cells));
  bool misses = beside || enter > leave || leave < 0.0f || enter > last;
  w.t = max(enter, 0.0f);
  w.last = last;
  vec3 p = at(r, w.t);
  w.cell = VEC3(clamp(floor(p.x), 0.0f, cells - 1.0f), clamp(floor(p.y), 0.0f, cells - 1.0f),
                clamp(floor(p.z), 0.0f, cells - 1.0f));
  w.level = 0u;
  w.parent1 = w.parent2 = w.parent3 = w.parent4 = 0u;
  w.blocked = false;
  w.done = true;
  if (misses) return w;
  Span s = span_around(r, VEC3(0.0f, 0.0f, 0.0f), cells, w.t);
  bool occupied = shaft_occupied(0u, r, s, VEC3(0.0f, 0.0f, 0.0f), float(N) * node_share(0u));
  w.blocked = occupied && DEPTH == 1u && !starts_inside;
  w.done = !occupied || DEPTH == 1u;
  return w;
}

uint parent(Walk w) {
  uint node = DEPTH > 2u && w.level == 1u ? w.parent1 : 0u;
  node = DEPTH > 3u && w.level == 2u ? w.parent2 : node;
  node = DEPTH > 4u && w.level == 3u ? w.parent3 : node;
  return DEPTH > 5u && w.level == 4u ? w.parent4 : node;
}

float step_along(uint axis, uint leave_axis, float d, float p, float lo, float size) {
  return axis == leave_axis ? (d > 0.0f ? lo + size : lo - 1.0f) : clamp(floor(p), lo, lo + size - 1.0f);
}

// Out of a box; up to the deepest node that the new cell is in as well.
Walk leave_box(Walk w, Span s, vec3 lo, float size) {
  w.t = s.leave;
  vec3 p = at(w.line, w.t), old = w.cell;
  w.cell = VEC3(step_along(0u, s.leave_axis, w.line.d.x, p.x, lo.x, size),
                step_along(1u, s.leave_axis, w.line.d.y, p.y, lo.y, size),
                step_along(2u, s.leave_axis, w.line.d.z, p.z, lo.z, size));
  float now = component(w.cell, s.leave_axis);
  w.done = now < 0.0f || now >= node_size(0u) || w.t > w.last;
  // Across the other axes it stays in the box, and so in the nodes around it.
  float before = component(old, s.leave_axis);
  uint level = 0u;
  level = DEPTH > 2u && w.level >= 1u && same_node(before, now, 1u) ? 1u : level;
  level = DEPTH > 3u && w.level >= 2u && same_node(before, now, 2u) ? 2u : level;
  level = DEPTH > 4u && w.level >= 3u && same_node(before, now, 3u) ? 3u : level;
  level = DEPTH > 5u && w.level >= 4u && same_node(before, now, 4u) ? 4u : level;
  w.level = level;
  return w;
}

// One subnode of the node at w.level: into it, or past it.
Walk step_walk(Walk w) {
  float size = node_size(w.level + 1u), share = node_share(w.level + 1u), above = node_share(w.level), n = float(N);
  // Places among the nodes of its level, and among its parent's subnodes.
  vec3 place = VEC3(node_place(w.cell.x, share), node_place(w.cell.y, share), node_place(w.cell.z, share));
  vec3 lo = VEC3(place.x * size, place.y * size, place.z * size);
  uint x = uint(place.x - node_place(w.cell.x, above) * n + 0.5f);
  uint y = uint(place.y - node_place(w.cell.y, above) * n + 0.5f);
  uint z = uint(place.z - node_place(w.cell.z, above) * n + 0.5f);
  uint node = tree_entry(parent(w) * N * N * N + (z * N + y) * N + x);
  Span s = span_around(w.line, lo, size, w.t);
  bool occupied = node < occupied_leaf;
  if (occupied) occupied = shaft_occupied(node, w.line, s, lo, n * share);
  bool finest = w.level + 2u == DEPTH;
  if (occupied && finest && !skipped(w.cell, w.start)) {  // deep enough, and not where the segment starts
    w.done = w.blocked = true;
    return w;
  }
  if (!occupied || finest) return leave_box(w, s, lo, size);
  w.level += 1u;
  w.parent1 = w.level == 1u ? node : w.parent1;
  w.parent2 = w.level == 2u ? node : w.parent2;
  w.parent3 = w.level == 3u ? node : w.parent3;
  w.parent4 = w.level == 4u ? node : w.parent4;
  return w;
}
