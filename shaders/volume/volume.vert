#version 450 core
// Rays for each pixel: of the whole picture, or of those tiles alone in which something may be seen (two triangles
// each). Software rasterisers compute all of a ray that ends before it begins.
#include "include/frame.glsl"
#include "volume/volume_block.glsl"

void main() {
  const float kTilePixels = 8.0;
  int corner = gl_VertexID % 6;
  vec2 at = vec2(corner == 1 || corner == 3 || corner == 4 ? 1.0 : 0.0, corner == 2 || corner >= 4 ? 1.0 : 0.0);
  if (volume.lengths.w > 0.5) {
    int columns = textureSize(tiles, 0).x, tile = gl_VertexID / 6;
    ivec2 place = ivec2(tile % columns, tile / columns);
    vec2 span = texelFetch(tiles, place, 0).xy;
    at = min((vec2(place) + at) * kTilePixels / frame.size.xy, 1.0);
    if (-span.x > span.y) at = vec2(-1.0);  // all corners in one place
  }
  gl_Position = vec4(2.0 * at - 1.0, 0.0, 1.0);
}
