#version 450 core
// Which tiles of 8 x 8 pixels need more than a picture of the context enlarged: 1 where lenses may be seen, or where
// opaque things begin or end, else 0. It counts what the pixels of the context around the tile show, too.
//
// With x'(t) on the ray through the middle of the tile and D the focal distance, a point x(t) on any of its rays is
// at most s = t h / D away (orthographic: h), where h is how far they are apart at the focal point. So no lens is
// met by any of them where the ray through the middle meets none that has grown by s on all sides.
#define TILES
#include "include/frame.glsl"
#include "volume/volume_block.glsl"
#include "volume/ray.glsl"
#include "volume/lens_segments.glsl"
#include "volume/enlarge.glsl"

layout(location = 6) uniform float farthest;  // t at which lenses may be seen
layout(location = 0) out uint kind;

void main() {
  int border = int(ceil(1.0 / context_pixel.x)) + 1;
  Ray ray = pixel_ray();
  float pixels = (0.5 * kTilePixels + float(border)) * sqrt(2.0), slack = pixels * frame.size.z;
  if (frame.eye.w > 0.5) slack *= farthest / frame.size.w;
  kind = 0u;
  for (int i = 0; i < volume.lens_count; ++i) {
    vec2 inside = lens_interval(i, ray, slack, pixels);
    if (inside.x < inside.y && (inside.y > 0.0 || frame.eye.w < 0.5)) kind = 1u;
  }
  if (!has_opaque_depth) return;
  ivec2 corner = ivec2(gl_FragCoord.xy) * int(kTilePixels) - border, last = textureSize(opaque_depth, 0) - 1;
  vec2 range = vec2(1.0, 0.0);
  for (int y = 0; y < int(kTilePixels) + 2 * border; ++y) {
    for (int x = 0; x < int(kTilePixels) + 2 * border; ++x) {
      float z = texelFetch(opaque_depth, clamp(corner + ivec2(x, y), ivec2(0), last), 0).x;
      range = vec2(min(range.x, z), max(range.y, z));
    }
  }
  float near = opaque_distance(ray, range.x, 1e30), far = opaque_distance(ray, range.y, 1e30);
  if (!(abs(far - near) <= same_distance(near))) kind = 1u;
}
