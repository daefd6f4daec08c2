#version 450 core
// What lies before the first lens of a ray and behind its last one, for pixels of a smaller picture
// (common/render/volume/context_picture.h). Variant SHADED: under light.
#include "include/frame.glsl"
#ifdef SHADED
#include "include/color.glsl"
#include "include/shade.glsl"
#endif
#include "volume/volume_block.glsl"
#include "volume/ray.glsl"
#include "volume/slope.glsl"
#ifdef SHADED
#include "volume/surface.glsl"
#endif
#include "volume/march.glsl"
#include "volume/lens_segments.glsl"

layout(location = 0) out vec4 front;  // associated
layout(location = 1) out vec4 back;
layout(location = 2) out vec2 kind;  // 1 where the ray meets a lens, else 0; t of what is opaque

void main() {
  Ray ray = pixel_ray();
  vec2 inside[kLensRoom];
  vec2 span = lens_span(ray, inside);
  kind = vec2(span.x < span.y ? 1.0 : 0.0, ray.to);
  vec4 seen[2] = vec4[2](vec4(0.0), vec4(0.0));
  vec2 parts[2] = vec2[2](vec2(ray.first, min(span.x, ray.last)), vec2(max(span.y, ray.first), ray.last));
  // Software rasterisers compute a step of a loop for rays that skip it, unless all of them end the loop.
  int last = span.x < span.y && parts[1].x < parts[1].y ? 1 : 0;
  for (int i = parts[0].x < parts[0].y ? 0 : 1; i <= last && seen[0].a <= volume.opaque; ++i) {
#ifdef ILLUSTRATED
    fading = i == 0 && span.x < span.y ? volume.context_fade : 0.0;
#endif
    march(ray, shapes.parts[0], parts[i].x, parts[i].y, seen[i]);
  }
  front = seen[0];
  back = seen[1];
}
