#version 450 core
// The voxels of a slice in their colours, over those of a scalar image, with the crosshair over them and a border
// around them. Where there is neither a tensor nor a value the slice is open.
#include "tensor/slice_block.glsl"

in vec3 grid;

layout(binding = 0) uniform sampler3D voxels;  // associated sRGB: colour times FA
layout(binding = 1) uniform sampler3D under;   // numbers of the image below

layout(location = 0) out vec4 color;

// How much of a line of `half_width` pixels lies over a pixel `distance` pixels away.
float coverage(float distance, float half_width) {
  return half_width > 0.0 ? clamp(half_width + 0.5 - distance, 0.0, 1.0) : 0.0;
}

// The grey of the image below, and 1 where there is one, else 0.
vec2 underlay() {
  if (under_blend == 0) return vec2(0.0);
  vec3 g = (under_from_grid * vec4(grid, 1.0)).xyz;
  if (any(lessThan(g, vec3(-0.5))) || any(greaterThan(g, under_points - 0.5))) return vec2(0.0);
  float grey = under_grey.x * texture(under, (g + 0.5) / under_points).r + under_grey.y;
  return isnan(grey) ? vec2(0.0) : vec2(clamp(grey, 0.0, 1.0), 1.0);
}

// How opaque the colours of tensors are, which hold FA as a factor.
float opacity_of(vec3 rgb) {
  if (under_blend == 1) return clamp(anisotropy_grey ? rgb.r : length(rgb), 0.0, 1.0);
  return 1.0;
}

void main() {
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  vec2 g = vec2(grid[u], grid[v]);
  vec2 pixel = max(fwidth(g), vec2(1e-6));  // steps of g a pixel
  vec2 from_cross = abs(g - vec2(cross_at[u], cross_at[v])) / pixel;
  vec2 from_edge = min(g + 0.5, vec2(points[u], points[v]) - 0.5 - g) / pixel;

  float edge = coverage(min(from_edge.x, from_edge.y), border.w);
  vec4 voxel = texture(voxels, (grid + 0.5) / points);
  vec2 below = underlay();
  bool tensor = voxel.a >= 0.5 && !(below.y > 0.0 && under_blend == 3);
  if (!tensor && below.y == 0.0) discard;
  vec3 colors = tensor ? voxel.rgb / voxel.a : vec3(0.0);
  float part = !tensor ? 0.0 : below.y == 0.0 ? 1.0 : opacity_of(colors);
  vec3 shown = colors + (1.0 - part) * below.x;
  vec3 rgb = mix(brightness * shown, border.rgb, edge);
  float line = coverage(min(from_cross.x, from_cross.y), cross_line.w);
  color = vec4(mix(rgb, cross_line.rgb, 0.7 * line), 1.0);
}
