#version 450 core
// The picture of the context where nothing else is seen.
#include "include/frame.glsl"
layout(location = 4) uniform vec3 context_pixel;  // pixels there are those here times x, plus yz
layout(binding = 6) uniform sampler2D context_front;
layout(location = 0) out vec4 color;  // associated

void main() {
  color = texture(context_front, (gl_FragCoord.xy * context_pixel.x + context_pixel.yz) / textureSize(context_front, 0));
}
