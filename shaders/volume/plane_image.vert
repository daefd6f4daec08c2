#version 450 core
// A plane's polygon, in the scene frame.
#include "include/frame.glsl"

layout(location = 0) in vec3 position;

out vec3 place;  // N

void main() {
  place = position;
  gl_Position = frame.clip_from_scene * vec4(position, 1.0);
}
