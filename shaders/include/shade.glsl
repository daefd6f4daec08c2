// Colours of lit things: one light above the viewer's left shoulder, for lines and surfaces alike.
// Needs include/frame.glsl and include/color.glsl.

// Unit vector to the light, in N.
vec3 light_direction() { return normalize(frame.back.xyz + 0.55 * frame.up.xyz - 0.45 * frame.right.xyz); }

// sRGB of a thing of colour `srgb` under `diffuse` and `specular` light in [0, 1]. Highlights keep some of
// the thing's hue, or they would take its colour's meaning away.
vec3 shade(vec3 srgb, float diffuse, float specular) {
  const float kAmbient = 0.20, kDiffuse = 0.92;
  vec3 linear = decode_srgb(srgb);
  vec3 gloss = mix(vec3(1.0), linear / max(max(linear.r, max(linear.g, linear.b)), 1e-3), 0.5);
  return encode_srgb(linear * (kAmbient + kDiffuse * diffuse) + gloss * (frame.depth_cue.w * specular));
}

const float kShininess = 48.0;

// Share of the background that a thing at `depth` along the view takes on (depth cue).
float fading_at(float depth) {
  float range = max(frame.depth_cue.y - frame.depth_cue.x, 1e-6);
  return frame.depth_cue.z * clamp((depth - frame.depth_cue.x) / range, 0.0, 1.0);
}
