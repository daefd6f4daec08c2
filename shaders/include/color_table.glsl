// The colour at t in [0, 1] of a table of one row, sRGB; grey where there is no number. The middle of the first texel
// is t = 0, that of the last one t = 1.
vec3 table_color(sampler2D table, float t) {
  if (isnan(t)) return vec3(0.5);
  float entries = float(textureSize(table, 0).x);
  return texture(table, vec2((t * (entries - 1.0) + 0.5) / entries, 0.5)).rgb;
}
