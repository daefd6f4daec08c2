#version 450 core
// Tiles of the picture of one kind (volume/context_tiles.frag), as points (draw_tiles of
// common/render/volume/tile_pass.h).
layout(binding = 9) uniform usampler2D tile_kinds;
layout(location = 5) uniform uint wanted;

void main() {
  ivec2 count = textureSize(tile_kinds, 0), place = ivec2(gl_VertexID % count.x, gl_VertexID / count.x);
  bool shown = texelFetch(tile_kinds, place, 0).x == wanted;
  gl_Position = vec4(shown ? 2.0 * (vec2(place) + 0.5) / vec2(count) - 1.0 : vec2(2.0), 0.0, 1.0);
}
