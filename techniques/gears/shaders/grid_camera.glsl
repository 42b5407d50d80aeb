// The grid camera C: its image plane carries the grid G.

// What reachable() and project() need of the frame's constants, as texels: as a buffer every number of them
// would be loaded lane by lane on lavapipe.
FrameConstants camera_constants(Texels array) {
  FrameConstants f;
  f.light = light_basis(array);
  f.camera_x = texel(array, camera_texel);
  f.camera_y = texel(array, camera_texel + 1u);
  f.camera_z = texel(array, camera_texel + 2u);
  f.camera_eye = texel(array, camera_texel + 3u);
  vec4 last = texel(array, pad_texel);
  f.pad = last.x;
  f.near = last.y;
  f.grid_unit = last.z;
  return f;
}

struct GridPoint {
  vec2 at;        // on the image plane
  float z;        // distance before the camera
};

vec3 to_camera(FrameConstants f, vec3 working) {
  vec3 d = working - f.camera_eye.xyz;
  return vec3(dot(f.camera_x.xyz, d), dot(f.camera_y.xyz, d), dot(f.camera_z.xyz, d));
}
bool perspective(FrameConstants f) { return f.camera_eye.w != 0.0; }

GridPoint project(FrameConstants f, vec3 working) {
  vec3 c = to_camera(f, working);
  return GridPoint(perspective(f) ? c.xy / c.z : c.xy, c.z);
}

// Cell of a view sample. What the fit leaves out falls into border cells; what has no place on the image plane, behind
// the camera, into the cell after the last.
uint cell_of(FrameConstants f, Header h, uint size, GridPoint q) {
  if (perspective(f) && !(q.z > f.near)) return size * size;
  vec2 c = clamp((q.at - vec2(h.grid_lo[0], h.grid_lo[1])) * vec2(h.grid_scale[0], h.grid_scale[1]), 0.0, float(size - 1u));
  return uint(c.y) * size + uint(c.x);
}
