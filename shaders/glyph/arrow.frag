#version 450 core
// A lit surface with interpolated normals.
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
  vec3 view = normalize(vertex.to_eye);
  vec3 normal = normalize(vertex.normal);
  vec2 shine = surface_light(normal, light_direction(), view);
  color = vec4(shade(vertex.color, shine.x, shine.y), opacity);
}
