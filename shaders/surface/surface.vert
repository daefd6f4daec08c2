#version 450 core
// An isosurface: triangles of the scene frame with normals, and numbers that colour them.
#include "include/frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;  // unit, towards higher values; zero where none is known
layout(location = 2) in float value;
layout(location = 3) in float lens_value;

out Vertex {
  vec3 normal;
  vec3 to_eye;
  vec3 place;  // N
  float value;
  float lens_value;
} result;

void main() {
  result.normal = normal;
  result.to_eye = frame.eye.w > 0.5 ? frame.eye.xyz - position : frame.back.xyz;
  result.place = position;
  result.value = value;
  result.lens_value = lens_value;
  gl_Position = frame.clip_from_scene * vec4(position, 1.0);
}
