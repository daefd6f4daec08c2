// Where a ray runs inside lenses (common/render/lens/lens.h, the same sums in the scene frame).
// Needs include/frame.glsl, volume/volume_block.glsl and volume/ray.glsl.

// How far this pixel is from the middle of the circle of lens `i`, in its radii; 0 where it has none.
float circle_place(int i, float slack) {
  vec4 circle = shapes.circles[i];
  if (!(circle.z > 0.0)) return 0.0;
  vec2 at = (picture_pixel() - 0.5 * frame.size.xy) / frame.size.y;
  return distance(at, circle.xy) / (circle.z + slack);
}

// How much lens `i` would have to be scaled about its middle for x in N to lie on its border: 1 there, less inside.
float border_place(int i, vec3 x) {
  vec3 away = x - shapes.centers[i].xyz;
  float u = max(1e-6, circle_place(i, 0.0));
  mat4 unit = shapes.unit_from_scene[i];
  if (unit[3][3] > 0.5) u = max(u, length(mat3(unit) * away));
  ivec2 range = shapes.faces[i].xy;
  for (int k = range.x; k < range.x + range.y; ++k) {
    vec4 plane = shapes.planes[k];
    u = max(u, dot(plane.xyz, away) / (plane.w - dot(plane.xyz, shapes.centers[i].xyz)));
  }
  return u;
}

// First and last t inside lens `i`, grown by `slack` on all sides or more; first >= last: nowhere.
// @param pixels by which a circle on the screen is grown.
vec2 lens_interval(int i, Ray ray, float slack, float pixels) {
  const vec2 kNowhere = vec2(1e30, -1e30);
  if (circle_place(i, pixels / frame.size.y) > 1.0) return kNowhere;
  vec2 inside = vec2(-1e30, 1e30);
  mat4 unit = shapes.unit_from_scene[i];
  if (unit[3][3] > 0.5) {
    float stretch = sqrt(dot(unit[0].xyz, unit[0].xyz) + dot(unit[1].xyz, unit[1].xyz) + dot(unit[2].xyz, unit[2].xyz));
    float size = 1.0 / (1.0 + stretch * slack);
    vec3 p = size * (unit * vec4(ray.origin, 1.0)).xyz, v = size * (mat3(unit) * ray.direction);
    float a = dot(v, v), b = dot(p, v);
    // The discriminant from the distance of the line to the centre: b^2 - a c would lose it in rounding.
    vec3 nearest = p - v * (b / max(a, 1e-30));
    float room = 1.0 - dot(nearest, nearest);
    if (!(room > 0.0)) return kNowhere;
    if (a > 1e-20) inside = (vec2(-1.0, 1.0) * sqrt(room * a) - b) / a;
  }
  ivec2 range = shapes.faces[i].xy;
  for (int k = range.x; k < range.x + range.y; ++k) {
    vec4 plane = shapes.planes[k];
    float speed = dot(plane.xyz, ray.direction), room = plane.w + slack - dot(plane.xyz, ray.origin);
    if (speed > 0.0) inside.y = min(inside.y, room / speed);
    if (speed < 0.0) inside.x = max(inside.x, room / speed);
    if (speed == 0.0 && room < 0.0) return kNowhere;
  }
  return inside;
}

// The interval inside each lens. @return the first and last t in lenses that nothing hides; first >= last: there are
// none.
vec2 lens_span(Ray ray, out vec2 inside[kLensRoom]) {
  vec2 span = vec2(1e30, -1e30);
  for (int i = 0; i < volume.lens_count; ++i) {
    inside[i] = lens_interval(i, ray, 0.0, 0.0);
    vec2 seen = vec2(max(inside[i].x, ray.from), min(inside[i].y, ray.to));
    if (seen.x < seen.y) span = vec2(min(span.x, seen.x), max(span.y, seen.y));
  }
  return span;
}
