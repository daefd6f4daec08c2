#version 450 core
// Rays for each pixel: of the whole picture, or of those tiles alone in which something may be seen, as points
// (draw_tiles of common/render/volume/tile_pass.h). Software rasterisers compute all of a ray that ends before it
// begins.
#include "include/frame.glsl"
#include "volume/volume_block.glsl"

void main() {
  vec2 at = vec2((gl_VertexID & 1) * 4 - 1, (gl_VertexID & 2) * 2 - 1);  // one triangle
#ifndef LAYERS  // lines are seen anywhere
  if (volume.asks_tiles > 0.5) {
    ivec2 count = textureSize(tiles, 0), place = ivec2(gl_VertexID % count.x, gl_VertexID / count.x);
    vec2 span = texelFetch(tiles, place, 0).xy;
    at = -span.x > span.y ? vec2(2.0) : 2.0 * (vec2(place) + 0.5) / vec2(count) - 1.0;
  }
#endif
  gl_Position = vec4(at, 0.0, 1.0);
}
