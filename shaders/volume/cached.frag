#version 450 core
// The picture of the volume that was kept, where opaque things are as deep as they were (common/render/volume/cached_volume.h).
layout(binding = 3) uniform sampler2D opaque_depth;
layout(binding = 6) uniform sampler2D cached_picture;  // associated
layout(binding = 8) uniform sampler2D still_depth;
layout(location = 0) out vec4 color;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  color = texelFetch(cached_picture, pixel, 0);
  if (color.a == 0.0 || texelFetch(opaque_depth, pixel, 0).x != texelFetch(still_depth, pixel, 0).x) discard;
}
