// Fewer samples far from the viewer (Ikits 2006, ch. 9), on the ray's one lattice t = n d: with u the place of t between
// the nearest (0) and the farthest point (1) of the volume and F the ratio asked for, a step goes over
//   s = 2^floor(u log2 F)
// samples where n is a multiple of s, over fewer up to there. s depends on t alone, so it is the same to either side of a
// border of a lens, and steps that are joined begin and end at samples of the shorter ones.
// Needs volume/volume_block.glsl.

// @param most that a table allows
float far_stride(float n, float d, float most) {
  float u = clamp((n * d - volume.far_first) * volume.far_rate, 0.0, 1.0);
  int stride = 1 << int(min(floor(u * volume.far_doublings), floor(log2(max(most, 1.0)))));
  int place = int(n);
  int aligned = place & -place;  // the largest power of two that divides it
  return float(place == 0 ? stride : min(stride, aligned));
}
