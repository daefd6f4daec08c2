#version 450 core
// The values where a plane lies. With v the number there, trilinear, b that of black and w of the window,
//   grey = clamp((v - b) / w, 0, 1)                                                                  (1)
// and lines where v is a given number c: the nearest place of the line is |v - c| / |grad v| away, the gradient taken
// between neighbouring pixels. Inside lenses matter is enlarged where it is so in the volume, and the lens's colours lie
// over the grey as opaque as its transfer function says: the table has the opacity A of its longest stretch, l of the
// length for which transfer functions state theirs, hence that of the whole length is 1 - (1 - A)^(1/l). Where the lens
// shows another field, its colours are those of that one there.
#include "include/frame.glsl"
#include "include/contour.glsl"
#include "volume/volume_block.glsl"
#include "volume/ray.glsl"
#include "volume/lens_segments.glsl"
#include "volume/place_seen.glsl"

const int kMostContours = 16;

layout(location = 1) uniform vec2 grey;             // x: number of black; y: 1 / numbers from black to white
layout(location = 2) uniform bool shown;            // the values, not lines alone
layout(location = 3) uniform float longest_parts;   // 1 / l
layout(location = 4) uniform float line_width;      // [pixels]
layout(location = 5) uniform int contour_count;
layout(location = 6) uniform float contours[kMostContours];  // numbers

in vec3 place;  // N

layout(location = 0) out vec4 color;

bool inside_lens(int i, vec3 x) {
  if (circle_place(i, 0.0) > 1.0) return false;
  mat4 unit = shapes.unit_from_scene[i];
  if (unit[3][3] > 0.5 && length((unit * vec4(x, 1.0)).xyz) > 1.0) return false;
  ivec2 range = shapes.faces[i].xy;
  for (int k = range.x; k < range.x + range.y; ++k) {
    if (dot(shapes.planes[k].xyz, x) > shapes.planes[k].w) return false;
  }
  return true;
}

// Table coordinate of the value at g; NaN where there is none.
float value_at(vec3 g) { return (number_at(g) - field.first_number) * field.entries_a_number + field.first_entry; }

#ifdef REGIONS
#include "volume/slope.glsl"
layout(binding = 15) uniform sampler2DArray region_tables;  // colour times depth and depth: value, magnitude, number
#endif

// The colour at x in N, not associated, and its opacity along the whole length.
vec4 lens_color(Part part, vec3 x) {
  Transfer transfer = volume.transfers[part.transfer];
#if FIELDS > 1
  present = transfer.of_field;
#endif
  vec3 g = (field.grid_from_scene * vec4(x, 1.0)).xyz;
  if (any(lessThan(g, field.lower)) || any(greaterThan(g, field.upper))) return vec4(0.0);
  float entry = value_at(g);
  if (isnan(entry)) return vec4(0.0);
#ifdef REGIONS
  if (transfer.by_regions == 1) {
    float row = length(slope_in_scene(slope_at(g))) * field.rows_a_slope + field.first_row;
    vec4 matter = isnan(row) ? vec4(0.0) : texture(region_tables, vec3(entry, row, transfer.first_layer));
    return matter.a > 0.0 ? vec4(matter.rgb / matter.a, 1.0 - exp(-matter.a)) : vec4(0.0);
  }
#endif
  vec4 seen = texture(tables, vec3(entry, entry, float(transfer.first_layer) + volume.layer_count - 1.0));
  return seen.a > 0.0 ? vec4(seen.rgb / seen.a, 1.0 - pow(1.0 - min(seen.a, 1.0), longest_parts)) : vec4(0.0);
}

void main() {
  int lens = 0;
  while (lens < volume.lens_count && !inside_lens(lens, place)) ++lens;
  bool in_lens = lens < volume.lens_count;
  Part part = in_lens ? shapes.parts[lens + 1] : shapes.parts[0];
  vec3 x = in_lens && magnifies(lens) ? place_seen(lens, place) : place;
  vec3 g = (field.grid_from_scene * vec4(x, 1.0)).xyz;
  float number = number_at(g);
  float slope = length(vec2(dFdx(number), dFdy(number)));
  bool cut_away = in_lens && part.content == kCutAway;
  if (cut_away || isnan(number)) discard;

  color = vec4(vec3(clamp((number - grey.x) * grey.y, 0.0, 1.0)), 1.0);  // (1)
  if (in_lens && part.transfer > 0) {
    vec4 matter = lens_color(part, x);
    color.rgb = mix(color.rgb, matter.rgb, matter.a);
  }
  float nearest = 1e30;
  for (int i = 0; i < contour_count; ++i) nearest = min(nearest, abs(number - contours[i]));
  float away = slope > 0.0 ? nearest / slope : 1e30;
  if (!shown && contour_rim(away, line_width) + contour_line(away, line_width) <= 0.5) discard;
  const vec3 kLine = vec3(0.25, 0.85, 1.0);
  if (contour_count > 0) color.rgb = with_contour(color.rgb, kLine, away, line_width);
}
