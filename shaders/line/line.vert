#version 450 core
// Ribbons that face the viewer: each point of a line gives two vertices, one on either side.
//   side = T x V / |T x V|,  T tangent, V to the eye
// What changes little along a line is found here and not for each fragment, of which there are many more:
// the light of a line (line_light.glsl), and the depth cue.
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/shade.glsl"
#include "include/line_light.glsl"

struct Point {
  vec4 position;  // xyz in N
  vec4 tangent;   // xyz, unit or zero
};
layout(std430, binding = 0) readonly buffer Points { Point points[]; };
layout(std430, binding = 1) readonly buffer Values { float values[]; };  // place in the colour map, or NaN
layout(std430, binding = 2) readonly buffer LensValues { float lens_values[]; };  // likewise, inside the ball

layout(location = 0) uniform float width;       // at the focal point, pixels
layout(location = 1) uniform float halo_width;  // beyond either edge, pixels
layout(location = 2) uniform float min_width;   // pixels, wherever the point lies
layout(location = 3) uniform bool has_values;
layout(location = 4) uniform int coloring;      // 0 colour map, 1 direction, 2 one colour, 3 one colour without light
layout(location = 5) uniform vec4 line_color;   // sRGB and opacity; rgb for colouring 2 and 3
layout(location = 6) uniform float fading;      // share of the depth cue
layout(location = 8) uniform float dimming;     // share of the background at any depth
layout(location = 10) uniform vec4 lens;        // centre and radius in N of a ball; no radius: none
layout(location = 9) uniform float lift;        // toward the eye, in depth alone, half widths

out Vertex {
  vec4 linear;         // its colour as glossy_color() has it, where it is not that of a map
  vec2 shine;          // diffuse and specular light in its middle
  float far;           // share of the background
  float across;        // -1 and 1 at the edges of the line, beyond in its halo
  float outer;         // |across| at the outer edge of the halo
  float value;
#ifdef LENS
  float lens_value;
  vec3 place;          // of the middle of the line, in N
#endif
} result;
noperspective out float halo_z;  // depth of the halo's outer edge in the depth buffer, [0, 1]

void main() {
  int index = gl_VertexID >> 1;
  float sign_of_side = float(gl_VertexID & 1) * 2.0 - 1.0;
  vec3 p = points[index].position.xyz;
  vec3 t = points[index].tangent.xyz;
  bool perspective = frame.eye.w > 0.5;
  vec3 to_eye = frame.eye.xyz - p;
  float depth = dot(to_eye, frame.back.xyz);
  vec3 view = perspective ? normalize(to_eye) : frame.back.xyz;

  // A line that runs straight toward the eye has no side of its own: the camera's right will do.
  vec3 side = cross(t, view);
  float size = length(side);
  side = size > 1e-4 ? side / size : frame.right.xyz;

  float pixel = perspective ? frame.size.z * max(depth, 0.0) / frame.size.w : frame.size.z;
  float radius = 0.5 * max(width * frame.size.z, min_width * pixel);
  float outer = radius + halo_width * pixel;
  vec3 corner = p + side * (sign_of_side * outer);

  float value = has_values ? values[index] : 0.5;
  result.linear = glossy_color(decode_srgb(coloring == 1 ? abs(t) : line_color.rgb));
  vec2 shine = line_light(dot(t, light_direction()), dot(t, view));
  const float kDiffuseExponent = 1.6;  // less flat than 1, less stark than the 4.8 of Banks
  result.shine = vec2(pow(shine.x, kDiffuseExponent), shininess(shine.y));
  result.far = mix(fading * fading_at(depth), 1.0, dimming);
  result.across = sign_of_side * outer / radius;
  result.outer = outer / radius;
  result.value = value;
#ifdef LENS
  result.lens_value = lens.w > 0.0 ? lens_values[index] : 0.5;
  result.place = p;
#endif
  gl_Position = frame.clip_from_scene * vec4(corner, 1.0);
  if (lift > 0.0) {
    vec4 lifted = frame.clip_from_scene * vec4(corner + view * (lift * radius), 1.0);
    if (lifted.w > 0.0) gl_Position.z = lifted.z / lifted.w * gl_Position.w;
  }
  // Halos sink with the distance from the line (Everts, Bekker, Roerdink, Isenberg 2009), here by up to
  // three widths, so that close neighbours join into a bundle and only far ones are cut.
  vec4 sunk = frame.clip_from_scene * vec4(corner - view * (6.0 * outer), 1.0);
  halo_z = 0.5 + 0.5 * clamp(sunk.z / sunk.w, -1.0, 1.0);
}
