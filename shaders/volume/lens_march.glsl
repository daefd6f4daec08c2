// Each ray is split at the borders of lenses into stretches of context and focus, each marched in its own way.
#define SHADED
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/shade.glsl"
#include "volume/volume_block.glsl"
#include "volume/ray.glsl"
#include "volume/surface.glsl"
#include "volume/march.glsl"
#include "volume/lens_segments.glsl"

layout(location = 0) out vec4 color;  // associated

void main() {
  Ray ray = pixel_ray();
  if (!(ray.first < ray.last)) discard;
  color = vec4(0.0);
  vec2 inside[kMostLenses];
  int count = volume.lens_count.x;
  for (int i = 0; i < count; ++i) inside[i] = lens_interval(i, ray);

  float t = ray.first;
  for (int k = 0; k <= 2 * count && t < ray.last && color.a <= volume.lengths.z; ++k) {
    // The first lens that holds t owns the stretch, up to its end or where one before it in the list begins.
    int owner = 0;
    float stop = ray.last;
    for (int i = 0; i < count; ++i) {
      if (!(inside[i].x < inside[i].y)) continue;
      if (inside[i].x > t) {
        stop = min(stop, inside[i].x);
      } else if (inside[i].y > t) {
        owner = i + 1;
        stop = min(stop, inside[i].y);
        break;
      }
    }
    if (volume.parts[owner].w != 1.0) march(ray, volume.parts[owner], t, stop, color);
    t = stop;
  }
}
