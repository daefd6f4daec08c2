// Light in a volume. Where values change, they change across a surface with the unit gradient as its normal N,
// which has no side: with unit vectors L to the light and V to the eye (Phong 1975)
//   diffuse |L.N|     specular max(R.V, 0)^kGloss, R = 2 (L.N) N - L
// The gradient is that of central differences, one voxel to either side. With s its size in table coordinates a
// voxel, the share s^2 / (s^2 + kFaint^2) of the light is that of the surface; the rest shines as it is, so that
// noise has no surface.
// Needs include/frame.glsl, include/shade.glsl and volume/slope.glsl.

// @param slope in table coordinates a voxel, where `seen` is.
vec3 lit(vec4 seen, vec3 direction, vec3 slope) {
  const float kAmbient = 0.35, kDiffuse = 0.70, kSpecular = 0.25, kGloss = 24.0, kFaint = 0.005;
  vec3 normal = slope_in_scene(slope);
  float size = length(normal);
  float square = dot(slope, slope);
  if (!(size > 0.0)) return seen.rgb;  // even, or NaN
  normal /= size;
  vec3 light = light_direction();
  float ln = dot(light, normal);
  float shine = max(dot(2.0 * ln * normal - light, -direction), 0.0);
  float share = square / (square + kFaint * kFaint);
  vec3 shone = seen.rgb * (kAmbient + kDiffuse * abs(ln)) + seen.a * (kSpecular * pow(shine, kGloss));
  return min(mix(seen.rgb, shone, share), vec3(seen.a));
}

vec3 shaded(vec4 seen, vec3 direction, vec3 g) { return lit(seen, direction, slope_at(g)); }
