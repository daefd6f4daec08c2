#version 450 core
// A volume without lenses under light.
#define SHADED
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/shade.glsl"
#include "volume/volume_block.glsl"
#include "volume/ray.glsl"
#include "volume/surface.glsl"
#include "volume/march.glsl"

layout(location = 0) out vec4 color;  // associated

void main() {
  Ray ray = pixel_ray();
  if (!(ray.first < ray.last)) discard;
  color = vec4(0.0);
  march(ray, volume.parts[0], ray.first, ray.last, color);
}
