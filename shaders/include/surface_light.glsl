// Light on a surface with unit normal N, to the light L and to the eye V (all unit vectors):
//   diffuse   ((1 + L.N) / 2)^1.6, so that the side away from the light keeps its shape
//   specular  (R.V)^kShininess, R = 2 (L.N) N - L (Phong 1975)
// Needs include/shade.glsl.
vec2 surface_light(vec3 normal, vec3 light, vec3 view) {
  float ln = dot(light, normal);
  float rv = dot(2.0 * ln * normal - light, view);
  return vec2(pow(0.5 + 0.5 * ln, 1.6), ln > 0.0 ? pow(max(rv, 0.0), kShininess) : 0.0);
}
