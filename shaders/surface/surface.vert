#version 450 core
// An isosurface: triangles of the scene frame with normals.
#include "include/frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;  // unit, towards higher values; zero where none is known

out Vertex {
  vec3 normal;
  vec3 to_eye;
} result;

void main() {
  result.normal = normal;
  result.to_eye = frame.eye.w > 0.5 ? frame.eye.xyz - position : frame.back.xyz;
  gl_Position = frame.clip_from_scene * vec4(position, 1.0);
}
