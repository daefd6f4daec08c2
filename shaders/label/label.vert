#version 450 core
// Triangles of signs in space (common/render/label/label_view.h).
#include "include/frame.glsl"

layout(location = 0) in vec3 place;        // N
layout(location = 1) in vec2 letter_place; // of the texture of letters
layout(location = 2) in vec4 label_color;   // sRGB, opacity

out Vertex {
  vec2 letter_place;
  flat vec4 color;
} result;

void main() {
  result.letter_place = letter_place;
  result.color = label_color;
  gl_Position = frame.clip_from_scene * vec4(place, 1.0);
}
