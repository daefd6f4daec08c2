// One way to be drawn along all of a ray.
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

layout(location = 0) out vec4 color;  // associated

void main() {
  if (is_kept()) discard;
  Ray ray = pixel_ray();
  if (!(ray.first < ray.last)) discard;
  color = vec4(0.0);
#ifdef SLABS
  bool in_front;
  vec4 kept = enter_slab(ray, in_front);
  if (in_front) color = kept;
#endif
  march(ray, shapes.parts[0], ray.first, ray.last, color);
#ifdef SLABS
  if (!in_front) color += (1.0 - color.a) * kept;
#endif
}
