#version 450 core
// Where in the picture, and how far along rays, bricks that show something may lie: each brick as a rectangle, two
// triangles, in a picture of tiles of 8 x 8 pixels. With c the brick's middle seen from the eye (right, up, forward), E
// its three half edges, |n E| = sum_a |n . E_a| how far it reaches along n, r its radius and f the focal distance, all
// its points p have
//   |p_x / p_z - c_x / c_z| <= |(right - c_x / c_z forward) E| / (c_z - |forward E|)               (1)
//   |c| - s <= |p| <= |c| + s + r^2 / (2 (|c| - s)),   s = |c / |c| E|,   and |p| <= |c| + r        (2)
#include "include/frame.glsl"
#include "volume/volume_block.glsl"

layout(std430, binding = 0) readonly buffer Bricks { uint bricks[]; };  // x, y, z in 10 bits each
layout(location = 1) uniform mat4 scene_from_grid;
layout(location = 2) uniform vec4 half_cells;  // half edges of a brick; w: its radius, N
layout(location = 3) uniform vec2 tile_count;  // of the picture
flat out vec2 span;                            // minus the first and the last t

float reach_of(vec3 along_edges) { return dot(abs(along_edges), vec3(1.0)); }

void main() {
  const float kBrickCells = 8.0, kTilePixels = 8.0;
  uint place = bricks[gl_VertexID / 6];
  vec3 brick = vec3(place & 1023u, place >> 10 & 1023u, place >> 20 & 1023u);
  vec3 middle = (scene_from_grid * vec4(kBrickCells * (brick + 0.5), 1.0)).xyz - frame.eye.xyz;
  vec3 c = vec3(dot(middle, frame.right.xyz), dot(middle, frame.up.xyz), -dot(middle, frame.back.xyz));

  mat3 edges = mat3(scene_from_grid) * mat3(half_cells.x, 0.0, 0.0, 0.0, half_cells.y, 0.0, 0.0, 0.0, half_cells.z);
  vec3 right = frame.right.xyz * edges, up = frame.up.xyz * edges, forward = -frame.back.xyz * edges;
  float deep = reach_of(forward);
  vec2 at = c.xy, reach = vec2(reach_of(right), reach_of(up));  // on the plane through the focal point
  span = vec2(deep - c.z, deep + c.z);
  if (frame.eye.w > 0.5) {
    float t = length(c), radius = half_cells.w, s = reach_of(middle / max(t, 1e-30) * edges);
    float bend = t > s ? 0.5 * radius * radius / (t - s) : radius;
    span = vec2(s - t, t + min(s + bend, radius));  // (2)
    vec2 slope = c.xy / c.z;
    at = slope * frame.size.w + vec2(frame.right.w, frame.up.w);
    reach = vec2(reach_of(right - slope.x * forward), reach_of(up - slope.y * forward));
    reach *= frame.size.w / (c.z - deep);  // (1)
    // Beside or behind the eye a brick may be seen anywhere.
    if (c.z <= 1.01 * deep) {
      at = vec2(0.0);
      reach = frame.size.xy * frame.size.z;
    }
  }

  int corner = gl_VertexID % 6;
  vec2 side = vec2(corner == 1 || corner == 3 || corner == 4 ? 1.0 : -1.0, corner == 2 || corner >= 4 ? 1.0 : -1.0);
  // A tile counts where its middle is covered: half a tile more on every side, and some for rounding.
  vec2 pixel = 0.5 * frame.size.xy + (at + side * reach) / frame.size.z + side * (0.51 * kTilePixels);
  gl_Position = vec4(2.0 * pixel / (kTilePixels * tile_count) - 1.0, 0.0, 1.0);
}
