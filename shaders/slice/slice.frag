#version 450 core
// A slice: a texel for each pixel, clear where the volume has no value.
layout(binding = 0) uniform sampler2D slice;

layout(location = 0) out vec4 color;

void main() {
  ivec2 size = textureSize(slice, 0);
  ivec2 at = ivec2(gl_FragCoord.xy);
  color = texelFetch(slice, ivec2(at.x, size.y - 1 - at.y), 0);  // rows from the top
}
