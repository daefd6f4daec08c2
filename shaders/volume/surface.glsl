// Light in a volume. Where values change, they change across a surface with the unit gradient as its normal N,
// which has no side: with unit vectors L to the light and V to the eye (Phong 1975)
//   diffuse |L.N|     specular max(R.V, 0)^kGloss, R = 2 (L.N) N - L
// The gradient is that of central differences, one voxel to either side. With s its size in table coordinates a
// voxel, the share s^2 / (s^2 + kFaint^2) of the light is that of the surface; the rest shines as it is, so that
// noise has no surface.
// Needs include/frame.glsl, include/shade.glsl and volume/slope.glsl.

// @param slope in table coordinates a voxel.
float surface_share(vec3 slope) {
  const float kFaint = 0.005;
  float square = dot(slope, slope);
  return square / (square + kFaint * kFaint);
}

// @param slope where `seen` is. @param reaching the light that reaches the place, of 1.
vec3 lit(vec4 seen, vec3 direction, vec3 slope, float reaching) {
  const float kAmbient = 0.35, kDiffuse = 0.70, kSpecular = 0.25, kGloss = 24.0;
  vec3 normal = slope_in_scene(slope);
  float size = length(normal);
  vec3 plain = seen.rgb * mix(kAmbient, 1.0, reaching);
  if (!(size > 0.0)) return plain;  // even, or NaN
  normal /= size;
  vec3 light = light_direction();
  float ln = dot(light, normal);
  float shine = max(dot(2.0 * ln * normal - light, -direction), 0.0);
  vec3 shone = seen.rgb * (kAmbient + reaching * kDiffuse * abs(ln)) +
               seen.a * (reaching * kSpecular * pow(shine, kGloss));
  return min(mix(plain, shone, surface_share(slope)), vec3(seen.a));
}

#ifdef SHADOWED
#include "volume/shadow.glsl"
#endif
#ifdef ILLUSTRATED
#include "volume/illustration.glsl"
#endif

// What is seen of a place of a part at g. Variants: SHADOWED light is kept off by matter; ILLUSTRATED some parts are drawn
// as lines, or fade.
vec4 looked_at(vec4 seen, vec3 direction, Part part, vec3 g, vec3 slope) {
  if ((part.looks & kLit) != 0) {
#ifdef SHADOWED
    seen.rgb = lit(seen, direction, slope, seen.a > 0.0 ? light_at(g, part) : 1.0);
#else
    seen.rgb = lit(seen, direction, slope, 1.0);
#endif
  }
#ifdef ILLUSTRATED
  seen = drawn_as_lines(seen, part, direction, slope);
#endif
  return seen;
}

vec4 shaded(vec4 seen, vec3 direction, Part part, vec3 g) {
#ifdef ILLUSTRATED
  bool slopes = true;
#else
  bool slopes = (part.looks & kLit) != 0;
#endif
  if (!slopes) return seen;
  return looked_at(seen, direction, part, g, slope_at(g));
}
