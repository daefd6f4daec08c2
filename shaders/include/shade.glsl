// Colours of lit things: one light above the viewer's left shoulder, for lines and surfaces alike.
// Needs include/frame.glsl and include/color.glsl.

// Unit vector to the light, in N.
vec3 light_direction() { return normalize(frame.back.xyz + 0.55 * frame.up.xyz - 0.45 * frame.right.xyz); }

// A colour in linear light, and half of what brings its strongest part to one. Highlights keep some of a thing's hue, or
// they would take its colour's meaning away.
vec4 glossy_color(vec3 linear) { return vec4(linear, 0.5 / max(max(linear.r, max(linear.g, linear.b)), 1e-3)); }

// Of a thing of that colour under `diffuse` and `specular` light in [0, 1]; linear light.
vec3 lit_glossy(vec4 color, float diffuse, float specular) {
  const float kAmbient = 0.20, kDiffuse = 0.92;
  float gloss = frame.depth_cue.w * specular;
  return color.rgb * (kAmbient + kDiffuse * diffuse + gloss * color.a) + 0.5 * gloss;
}
vec3 lit_color(vec3 linear, float diffuse, float specular) {
  return lit_glossy(glossy_color(linear), diffuse, specular);
}

// The same from sRGB to sRGB.
vec3 shade(vec3 srgb, float diffuse, float specular) {
  return encode_srgb(lit_color(decode_srgb(srgb), diffuse, specular));
}

const float kShininess = 48.0;
// x to the power of kShininess, for x of which there are many.
float shininess(float x) {
  float x2 = x * x, x4 = x2 * x2, x8 = x4 * x4, x16 = x8 * x8;
  return x16 * x16 * x16;
}

// Share of the background that a thing at `depth` along the view takes on (depth cue).
float fading_at(float depth) {
  float range = max(frame.depth_cue.y - frame.depth_cue.x, 1e-6);
  return frame.depth_cue.z * clamp((depth - frame.depth_cue.x) / range, 0.0, 1.0);
}
