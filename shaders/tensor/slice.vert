#version 450 core
// One slice of an image: the rectangle of its voxels in the plane g[axis] = place. With `u` and `v` the two axes
// that follow in turn, corners are (lower, lower), (upper, lower), (lower, upper), (upper, upper).
#include "include/frame.glsl"
#include "tensor/slice_block.glsl"

out vec3 grid;  // g

void main() {
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  vec3 g = cross_at;
  g[u] = (gl_VertexID & 1) != 0 ? points[u] - 0.5 : -0.5;
  g[v] = (gl_VertexID & 2) != 0 ? points[v] - 0.5 : -0.5;
  grid = g;
  gl_Position = frame.clip_from_scene * (scene_from_grid * vec4(g, 1.0));
}
