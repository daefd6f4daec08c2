// Matter drawn as lines are (Ikits 2006, fig. 5.11b; Ebert and Rheingans 2000). With N the unit gradient, V the unit
// ray, and s of volume/surface.glsl the share of a place that is a surface:
//   w = s (1 - |N.V|)^kSharp      1 on silhouettes, 0 where a surface faces the viewer and where there is none
// a part that is illustrated has the opacity 1 - (1 - A)^w in the place of A, dark toward silhouettes. What lies before a
// lens and fades by the share f has 1 - (1 - A)^(1 - f (1 - w)): its silhouettes stay (Krueger et al. 2006, ClearView).
// Needs volume/slope.glsl and volume/surface.glsl.
float fading = 0.0;  // f of the stretch that is marched

float silhouette(vec3 direction, vec3 slope) {
  const float kSharp = 2.5;
  vec3 normal = slope_in_scene(slope);
  float size = length(normal);
  if (!(size > 0.0)) return 0.0;  // even, or NaN
  return surface_share(slope) * pow(1.0 - abs(dot(normal / size, direction)), kSharp);
}

vec4 drawn_as_lines(vec4 seen, Part part, vec3 direction, vec3 slope) {
  bool lines = (part.looks & kIllustrated) != 0;
  if (!(seen.a > 0.0) || !(lines || fading > 0.0)) return seen;
  const float kInk = 0.7;  // of the colour that silhouettes lose
  float w = silhouette(direction, slope);
  float kept = (lines ? w : 1.0) * (1.0 - fading * (1.0 - w));
  float opacity = 1.0 - pow(1.0 - min(seen.a, 0.9999), kept);
  return vec4(seen.rgb * (opacity / seen.a) * (lines ? 1.0 - kInk * w : 1.0), opacity);
}
