#version 450 core
// A lit isosurface, the same from either side. Its alpha is the share of the pixel's samples that it covers.
//
// Coloured by a number u that is linear in each triangle: at (u - lower) scale in its table, of logarithms perhaps; other
// numbers and another table inside a ball. Lines where u is a multiple of d: u lies |u/d - [u/d]| d away from the nearest,
// which is that over the length of its gradient in pixels. They are drawn in a pass of their own, over lines on the surface.
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/color_table.glsl"
#include "include/contour.glsl"
#include "include/shade.glsl"
#include "include/surface_light.glsl"

in Vertex {
  vec3 normal;
  vec3 to_eye;
  vec3 place;
  float value;
  float lens_value;
} vertex;

layout(location = 0) uniform vec4 surface;        // sRGB, opacity
layout(location = 1) uniform bool has_values;     // they colour it
layout(location = 2) uniform vec3 scale;          // x: lower; y: 1 / (upper - lower); z: 1 of logarithms
layout(location = 3) uniform vec3 lens_scale;
layout(location = 4) uniform vec4 lens;           // centre and radius in N; no radius: none
layout(location = 5) uniform vec2 contours;       // x: distance of lines of equal value, 0: none; y: width [pixels]
layout(location = 6) uniform bool over;           // these lines alone, and the border of the ball
layout(binding = 0) uniform sampler2D color_map;
layout(binding = 1) uniform sampler2D lens_map;

layout(location = 0) out vec4 color;

float coordinate(float value, vec3 scale) {
  return clamp(((scale.z > 0.5 ? log(value) : value) - scale.x) * scale.y, 0.0, 1.0);
}

void main() {
  vec3 view = normalize(vertex.to_eye);
  // Where no normal is known, that of the triangle.
  vec3 flat_normal = cross(dFdx(vertex.to_eye), dFdy(vertex.to_eye));
  vec3 normal = dot(vertex.normal, vertex.normal) > 1e-6 ? vertex.normal : flat_normal;
  normal = dot(normal, normal) > 0.0 ? normalize(normal) : view;
  normal = faceforward(normal, -view, normal);
  vec2 shine = surface_light(normal, light_direction(), view);

  float u = vertex.value;
  float slope = length(vec2(dFdx(u), dFdy(u)));
  float from_lens = distance(vertex.place, lens.xyz) - lens.w, rise = length(vec2(dFdx(from_lens), dFdy(from_lens)));
  bool in_lens = from_lens < 0.0;
  if (over) {
    // Where nothing changes over a thousand pixels, lines would be those of rounding.
    bool crosses = contours.x > 0.0 && !in_lens && slope > 1e-3 * contours.x;
    float away = crosses ? abs(u / contours.x - round(u / contours.x)) * contours.x / slope : 1e30;
    if (lens.w > 0.0 && rise > 0.0) away = min(away, abs(from_lens) / rise);
    float cover = clamp(0.5 * contours.y + 1.5 - away, 0.0, 1.0);
    if (cover <= 0.0) discard;
    color = vec4(mix(kContourRim, vec3(0.94), contour_line(away, contours.y)), cover * surface.a);
    return;
  }
  vec3 own = surface.rgb;
  if (has_values && in_lens) own = isnan(vertex.lens_value) ? vec3(0.5) : table_color(lens_map, coordinate(vertex.lens_value, lens_scale));
  if (has_values && !in_lens) own = isnan(u) ? vec3(0.5) : table_color(color_map, coordinate(u, scale));
  color = vec4(shade(own, shine.x, 0.35 * shine.y), surface.a);
}
