#version 450 core
// Where in the picture, and how far along rays, bricks that show something may lie: each brick as the square about its
// bounding sphere, two triangles, in a picture of tiles of 8 x 8 pixels. With c the sphere's centre seen from the eye
// (right, up, forward), r its radius and f the focal distance, all its points p have
//   |p_x / p_z - c_x / c_z| <= r (1 + |c_x| / c_z) / (c_z - r)                                   (1)
#include "include/frame.glsl"
#include "volume/volume_block.glsl"

layout(std430, binding = 0) readonly buffer Bricks { uint bricks[]; };  // x, y, z in 10 bits each
layout(location = 1) uniform mat4 scene_from_grid;
layout(location = 2) uniform float radius;    // of a brick, N
layout(location = 3) uniform vec2 tile_count;  // of the picture
flat out vec2 span;                            // minus the first and the last t

void main() {
  const float kBrickCells = 8.0, kTilePixels = 8.0;
  uint place = bricks[gl_VertexID / 6];
  vec3 brick = vec3(place & 1023u, place >> 10 & 1023u, place >> 20 & 1023u);
  vec3 middle = (scene_from_grid * vec4(kBrickCells * (brick + 0.5), 1.0)).xyz - frame.eye.xyz;
  vec3 c = vec3(dot(middle, frame.right.xyz), dot(middle, frame.up.xyz), -dot(middle, frame.back.xyz));

  vec2 at = c.xy, reach = vec2(radius);  // on the plane through the focal point
  float t = c.z;
  if (frame.eye.w > 0.5) {
    t = length(c);
    at = c.xy * (frame.size.w / c.z) + vec2(frame.right.w, frame.up.w);
    reach = radius * (1.0 + abs(c.xy) / c.z) / (c.z - radius) * frame.size.w;  // (1)
    // Beside or behind the eye a sphere may be seen anywhere.
    if (c.z <= 1.01 * radius) {
      at = vec2(0.0);
      reach = frame.size.xy * frame.size.z;
    }
  }
  span = vec2(radius - t, radius + t);

  int corner = gl_VertexID % 6;
  vec2 side = vec2(corner == 1 || corner == 3 || corner == 4 ? 1.0 : -1.0, corner == 2 || corner >= 4 ? 1.0 : -1.0);
  // A tile counts where its middle is covered: half a tile more on every side, and some for rounding.
  vec2 pixel = 0.5 * frame.size.xy + (at + side * reach) / frame.size.z + side * (0.51 * kTilePixels);
  gl_Position = vec4(2.0 * pixel / (kTilePixels * tile_count) - 1.0, 0.0, 1.0);
}
