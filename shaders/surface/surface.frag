#version 450 core
// A lit isosurface, the same from either side. Its alpha is the share of the pixel's samples that it covers.
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/shade.glsl"
#include "include/surface_light.glsl"

in Vertex {
  vec3 normal;
  vec3 to_eye;
} vertex;

layout(location = 0) uniform vec4 surface;  // sRGB, opacity

layout(location = 0) out vec4 color;

void main() {
  vec3 view = normalize(vertex.to_eye);
  // Where no normal is known, that of the triangle.
  vec3 flat_normal = cross(dFdx(vertex.to_eye), dFdy(vertex.to_eye));
  vec3 normal = dot(vertex.normal, vertex.normal) > 1e-6 ? vertex.normal : flat_normal;
  normal = dot(normal, normal) > 0.0 ? normalize(normal) : view;
  normal = faceforward(normal, -view, normal);
  vec2 shine = surface_light(normal, light_direction(), view);
  color = vec4(shade(surface.rgb, shine.x, 0.35 * shine.y), surface.a);
}
