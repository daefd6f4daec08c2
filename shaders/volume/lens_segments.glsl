// Where a ray runs inside lenses (common/render/lens/lens.h, the same sums in the scene frame).
// Needs volume/volume_block.glsl and volume/ray.glsl.
layout(std140, binding = 2) uniform Lenses {
  mat4 unit_from_scene[kMostLenses];  // quadric: |x| <= 1; its last element is 1 where there is one, else 0
  vec4 centers[kMostLenses];          // xyz: middle; w: magnification
  ivec4 faces[kMostLenses];           // x: first plane, y: planes
  vec4 planes[kMostLenses * kMostPlanes];  // outward unit normal, offset
} lenses;

// First and last t inside lens `i`; first >= last: nowhere.
vec2 lens_interval(int i, Ray ray) {
  const vec2 kNowhere = vec2(1e30, -1e30);
  vec2 inside = vec2(-1e30, 1e30);
  mat4 unit = lenses.unit_from_scene[i];
  if (unit[3][3] > 0.5) {
    vec3 p = (unit * vec4(ray.origin, 1.0)).xyz, v = mat3(unit) * ray.direction;
    float a = dot(v, v), b = dot(p, v);
    // The discriminant from the distance of the line to the centre: b^2 - a c would lose it in rounding.
    vec3 nearest = p - v * (b / max(a, 1e-30));
    float room = 1.0 - dot(nearest, nearest);
    if (!(room > 0.0)) return kNowhere;
    if (a > 1e-20) inside = (vec2(-1.0, 1.0) * sqrt(room * a) - b) / a;
  }
  ivec2 range = lenses.faces[i].xy;
  for (int k = range.x; k < range.x + range.y; ++k) {
    vec4 plane = lenses.planes[k];
    float speed = dot(plane.xyz, ray.direction), room = plane.w - dot(plane.xyz, ray.origin);
    if (speed > 0.0) inside.y = min(inside.y, room / speed);
    if (speed < 0.0) inside.x = max(inside.x, room / speed);
    if (speed == 0.0 && room < 0.0) return kNowhere;
  }
  return inside;
}
