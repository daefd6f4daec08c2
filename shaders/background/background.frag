#version 450 core
// A faint vertical gradient, dithered with an ordered 4x4 pattern so that it shows no bands.
#include "include/frame.glsl"

layout(location = 0) out vec4 color;

void main() {
  const int pattern[16] = int[](0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5);
  ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
  float dither = (float(pattern[cell.x + 4 * cell.y]) + 0.5) / 16.0 - 0.5;
  color = vec4(background_at(gl_FragCoord.xy) + dither / 255.0, 1.0);
}
