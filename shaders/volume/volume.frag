#version 450 core
// A volume without lenses: colour and opacity along the ray of each pixel.
// Variants (common/render/volume/volume_pass.cpp): SHADED under light, else it shines by itself; SLABS a slab of it and
// what lies below.
#include "include/frame.glsl"
#ifdef SHADED
#include "include/color.glsl"
#include "include/shade.glsl"
#endif
#include "volume/volume_block.glsl"
#include "volume/ray.glsl"
#include "volume/slope.glsl"
#ifdef SLABS
#include "volume/slab.glsl"
#endif
#ifdef SHADED
#include "volume/surface.glsl"
#endif
#include "volume/march.glsl"
#ifdef LAYERS
#include "volume/layers.glsl"
#endif

layout(location = 0) out vec4 color;  // associated

void main() {
  if (is_saved()) discard;
  Ray ray = pixel_ray();
#ifdef LAYERS
  begin_layers(ray);
  if (!(ray.first < ray.last) && layer == 0u) discard;
#else
  if (!(ray.first < ray.last)) discard;
#endif
  color = vec4(0.0);
#ifdef SLABS
  bool in_front;
  vec4 kept = enter_slab(ray, in_front);
  if (in_front) color = kept;
#endif
#ifdef LAYERS
  for (float t = ray.first, stop; t < ray.last && color.a <= volume.opaque; t = stop) {
    pass_layers(ray, t, color);
    stop = min(layer_at, ray.last);
    march(ray, shapes.parts[0], t, stop, color);
  }
  pass_layers(ray, 1e30, color);
#else
  march(ray, shapes.parts[0], ray.first, ray.last, color);
#endif
#ifdef SLABS
  if (!in_front) color += (1.0 - color.a) * kept;
#endif
}
