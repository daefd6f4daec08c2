#version 450 core
// Tracts as ribbons that face the viewer, a strip of triangles for many lines: each point gives two vertices,
// one on either side.
//   side = T x V / |T x V|,  T tangent, V to the eye
// Between two lines lies a point whose vertices are the last of the one and the first of the other: triangles
// without area, which are not drawn.
// Their light is that of lines (line_light.glsl) in the colour of their direction, found here for the middle of
// the ribbon and for its edges: millions of lines have many more fragments than points.
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/shade.glsl"
#include "include/line_light.glsl"

struct Point {
  float x, y, z;  // in N
  uint tangent;   // unit; three signed numbers of ten bits each from the lowest on, of 511; two bits: 1 between lines
};
layout(std430, binding = 0) readonly buffer Points { Point points[]; };

#ifdef COLORED
// Of each point: sRGB in three numbers of eight bits, of 255, from the lowest on; bit 31: by direction.
layout(std430, binding = 1) readonly buffer Colors { uint colors[]; };
#endif

layout(location = 0) uniform float width;    // at the focal point, pixels
layout(location = 1) uniform float fading;   // share of the depth cue
layout(location = 2) uniform float dimming;  // share of the background at any depth
#ifdef SLAB
// What lies within a slab about a plane alone, in N: |n . p - d| < half; farther from it closer to the background.
layout(location = 5) uniform vec4 slab;  // n, d
layout(location = 6) uniform float slab_half;
out float gl_ClipDistance[2];
#endif

out Vertex {
  noperspective vec3 middle;   // sRGB
  noperspective vec3 edge;     // sRGB
  noperspective float across;  // -1 and 1 at the edges of the line
} result;

void main() {
  int index = gl_VertexID >> 1;
  int at_side = gl_VertexID & 1;
  uint packed_tangent = points[index].tangent;
  if ((packed_tangent >> 30u) != 0u) {
    index += 2 * at_side - 1;
    at_side = 1 - at_side;
    packed_tangent = points[index].tangent;
  }
  vec3 p = vec3(points[index].x, points[index].y, points[index].z);
  int bits = int(packed_tangent);
  vec3 t = vec3(ivec3(bits << 22, bits << 12, bits << 2) >> 22) / 511.0;
  bool perspective = frame.eye.w > 0.5;
  vec3 to_eye = frame.eye.xyz - p;
  float depth = dot(to_eye, frame.back.xyz);
  vec3 view = perspective ? normalize(to_eye) : frame.back.xyz;

  // A line that runs straight toward the eye has no side of its own: the camera's right will do.
  vec3 side = cross(t, view);
  float size = length(side);
  side = size > 2e-3 ? side / size : frame.right.xyz;

  // Never narrower than a pixel.
  float pixel = perspective ? frame.size.z * max(depth, 0.0) / frame.size.w : frame.size.z;
  float radius = 0.5 * max(width * frame.size.z, pixel);
  float sign_of_side = float(at_side) * 2.0 - 1.0;
  gl_Position = frame.clip_from_scene * vec4(p + side * (sign_of_side * radius), 1.0);

  // Towards its edges a round line turns away from the eye: there it has less light, and no highlight.
  const float kDiffuseExponent = 1.6;  // less flat than 1, less stark than the 4.8 of Banks
  const float kEdge = 0.35;
  vec2 shine = line_light(dot(t, light_direction()), dot(t, view));
  float diffuse = pow(shine.x, kDiffuseExponent);
  vec3 matter = abs(t);
#ifdef COLORED
  if ((colors[index] >> 31u) == 0u) matter = unpackUnorm4x8(colors[index]).rgb;
#endif
  vec3 middle = shade(matter, diffuse, pow(shine.y, kShininess));
  vec3 edge = shade(matter, kEdge * diffuse, 0.0);
  // Depth cue: farther lines take on the background, which is linear in the picture.
  float far = mix(fading * fading_at(depth), 1.0, dimming);
#ifdef SLAB
  const float kFaded = 0.8;
  float above = dot(slab.xyz, p) - slab.w;
  gl_ClipDistance[0] = slab_half - above;
  gl_ClipDistance[1] = slab_half + above;
  far = max(far, kFaded * min(1.0, abs(above) / slab_half));
#endif
  vec2 pixels = (0.5 + 0.5 * gl_Position.xy / gl_Position.w) * frame.size.xy;
  vec3 background = background_at(pixels);
  result.middle = mix(middle, background, far);
  result.edge = mix(edge, background, far);
  result.across = sign_of_side;
}
