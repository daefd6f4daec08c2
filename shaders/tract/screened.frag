#version 450 core
// Transparent tracts in any order, with depth: each sample of a pixel shows a line by chance, with its opacity as
// the odds (Enderton, Sintorn, Shirley, Luebke 2010).
#include "tract/tract_color.glsl"

layout(location = 3) uniform float opacity;
layout(location = 4) uniform uint piece;  // of the tracts: another one, another choice

layout(location = 0) out vec4 color;

// Jarzynski, Olano 2020: pcg3d.
uvec3 hash(uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z; v.y += v.z * v.x; v.z += v.x * v.y;
  return v;
}

int shown_samples() {
  uvec3 bits = hash(uvec3(gl_FragCoord.xy, uint(gl_PrimitiveID) + (piece << 20u)));
  uint odds = uint(65536.0 * opacity);
  uvec4 chance = uvec4(bits.x & 0xffffu, bits.x >> 16u, bits.y & 0xffffu, bits.y >> 16u);
  uvec4 more = uvec4(bits.z & 0xffffu, bits.z >> 16u, (bits.x ^ bits.z) & 0xffffu, (bits.y ^ bits.z) >> 16u);
  int mask = 0;
  for (int i = 0; i < 4; ++i) mask |= (chance[i] < odds ? 1 << i : 0) | (more[i] < odds ? 16 << i : 0);
  return mask;
}

void main() {
  gl_SampleMask[0] = shown_samples();
  color = vec4(tract_color(), 1.0);
}
