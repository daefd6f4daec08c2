// Matter seen enlarged through a lens. With c the middle of the lens, m its magnification and u(x) the factor by
// which the lens would have to be scaled about c for x to lie on its border, the place x shows the matter of
//   y(x) = c + (x - c) f(u) / u,   f(u) = u / m + (1 - 1/m) max(0, (u - a) / (1 - a))^2            (1)
// f grows and f(1) = 1: the lens is mapped on to itself, point for point, its border stays, and matter up to u = a is
// m times as large.
// Needs volume/volume_block.glsl and volume/lens_segments.glsl.
const float kCore = 0.5;  // a

bool magnifies(int i) { return shapes.centers[i].w > 1.0; }

// (1), in N.
vec3 place_seen(int i, vec3 x) {
  vec3 c = shapes.centers[i].xyz, away = x - c;
  float u = border_place(i, x);
  float shrunk = 1.0 / shapes.centers[i].w, outer = clamp((u - kCore) / (1.0 - kCore), 0.0, 1.0);
  return c + away * (shrunk + (1.0 - shrunk) * outer * outer / u);
}
