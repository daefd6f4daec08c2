#version 450 core
// A sphere, or with HALO what surrounds it. From the point o of the square (relative to the centre) the ray comes closest
// to the centre at p = o - (o.d) d, d toward the eye, and leaves the sphere at
//   x = p + sqrt(R^2 - p.p) d,   normal x / R
// All relative to the centre: differences of large squares would cost the digits that small spheres need. The silhouette
// is asked for each sample, light and depth are found once a pixel.
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/shade.glsl"
#include "include/surface_light.glsl"

in Vertex {
  flat vec4 place;
  flat vec3 color;
  flat vec3 to_eye;
  flat float halo;
  vec3 offset;
} vertex;

layout(location = 1) uniform float opacity;

layout(location = 0) out vec4 color;

float depth_of(vec3 offset) {
  vec4 clip = frame.clip_from_scene * vec4(vertex.place.xyz + offset, 1.0);
  return 0.5 + 0.5 * clamp(clip.z / clip.w, -1.0, 1.0);
}

void main() {
  float radius = vertex.place.w;
  int mask = 0;
  for (int i = 0; i < gl_NumSamples; ++i) {
    vec3 o = interpolateAtSample(vertex.offset, i);
    vec3 d = frame.eye.w > 0.5 ? vertex.to_eye - o : vertex.to_eye;  // of any length here
    float od = dot(o, d), square = dot(o, o) - od * od / dot(d, d);  // p.p; o lies nearly across d
#ifdef HALO
    float reach = radius + vertex.halo;
    bool covers = square > radius * radius && square <= reach * reach;
#else
    bool covers = square <= radius * radius;
#endif
    mask |= covers ? 1 << i : 0;
  }
  if ((mask & gl_SampleMaskIn[0]) == 0) discard;
  gl_SampleMask[0] = mask;

  vec3 view = frame.eye.w > 0.5 ? normalize(vertex.to_eye - vertex.offset) : vertex.to_eye;
  vec3 p = vertex.offset - dot(vertex.offset, view) * view;
#ifdef HALO
  // It lies behind the sphere, so that a line through its centre reaches it uncut.
  color = vec4(background_at(gl_FragCoord.xy), 1.0);
  gl_FragDepth = depth_of(p - 2.0 * radius * view);
#else
  vec3 hit = p + sqrt(max(0.0, radius * radius - dot(p, p))) * view;
  vec2 shine = surface_light(normalize(hit), light_direction(), view);
  color = vec4(shade(vertex.color, shine.x, shine.y), opacity);
  gl_FragDepth = depth_of(hit);
#endif
}
