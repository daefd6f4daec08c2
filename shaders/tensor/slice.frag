#version 450 core
// The voxels of a slice in their colours, with the crosshair over them and a border around them. Where there is
// no tensor the slice is open.
#include "tensor/slice_block.glsl"

in vec3 grid;

layout(binding = 0) uniform sampler3D voxels;  // associated sRGB

layout(location = 0) out vec4 color;

// How much of a line of `half_width` pixels lies over a pixel `distance` pixels away.
float coverage(float distance, float half_width) {
  return half_width > 0.0 ? clamp(half_width + 0.5 - distance, 0.0, 1.0) : 0.0;
}

void main() {
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  vec2 g = vec2(grid[u], grid[v]);
  vec2 pixel = max(fwidth(g), vec2(1e-6));  // steps of g a pixel
  vec2 from_cross = abs(g - vec2(cross_at[u], cross_at[v])) / pixel;
  vec2 from_edge = min(g + 0.5, vec2(points[u], points[v]) - 0.5 - g) / pixel;

  float edge = coverage(min(from_edge.x, from_edge.y), border.w);
  vec4 voxel = texture(voxels, (grid + 0.5) / points);
  if (voxel.a < 0.5) discard;
  vec3 rgb = mix(brightness * voxel.rgb / voxel.a, border.rgb, edge);
  float line = coverage(min(from_cross.x, from_cross.y), cross_line.w);
  color = vec4(mix(rgb, cross_line.rgb, 0.7 * line), 1.0);
}
