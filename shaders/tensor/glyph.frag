#version 450 core
// The lit surface of a tensor glyph.
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/shade.glsl"
#include "include/surface_light.glsl"

in Vertex {
  vec3 normal;
  vec3 to_eye;
  flat vec3 color;
} vertex;

layout(location = 0) uniform float opacity;

layout(location = 0) out vec4 color;

void main() {
  vec2 shine = surface_light(normalize(vertex.normal), light_direction(), normalize(vertex.to_eye));
  color = vec4(shade(vertex.color, shine.x, shine.y), opacity);
}
