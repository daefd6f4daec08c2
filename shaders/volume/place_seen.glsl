// Matter seen enlarged through a lens. With c the middle of the lens, m its magnification and u(x) the factor by
// which the lens would have to be scaled about c for x to lie on its border, the place x shows the matter of
//   y(x) = c + (x - c) f(u) / u,   f(u) = u / m + (1 - 1/m) max(0, (u - a) / (1 - a))^2            (1)
// f grows and f(1) = 1: the lens is mapped on to itself, point for point, its border stays, and matter up to u = a is
// m times as large.
// Needs volume/volume_block.glsl and volume/lens_segments.glsl.
const float kCore = 0.5;  // a

bool magnifies(int i) { return lenses.centers[i].w > 1.0; }

// (1), in N.
vec3 place_seen(int i, vec3 x) {
  vec3 c = lenses.centers[i].xyz, away = x - c;
  float u = 1e-6;
  mat4 unit = lenses.unit_from_scene[i];
  if (unit[3][3] > 0.5) u = max(u, length(mat3(unit) * away));
  ivec2 range = lenses.faces[i].xy;
  for (int k = range.x; k < range.x + range.y; ++k) {
    vec4 plane = lenses.planes[k];
    u = max(u, dot(plane.xyz, away) / (plane.w - dot(plane.xyz, c)));
  }
  float shrunk = 1.0 / lenses.centers[i].w, outer = clamp((u - kCore) / (1.0 - kCore), 0.0, 1.0);
  return c + away * (shrunk + (1.0 - shrunk) * outer * outer / u);
}
