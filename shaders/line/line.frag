#version 450 core
// Illuminated streamlines: the light of a line (line_light.glsl), rounded across its width. With LAYERS they are not drawn
// but put into the list of each pixel (line/layers.glsl), as far as nothing opaque hides them. With LENS there is a ball in
// which they have colours of their own.
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/shade.glsl"
#ifdef LAYERS
#include "line/layers.glsl"
layout(early_fragment_tests) in;
#else
layout(location = 0) out vec4 color;
#endif

layout(location = 4) uniform int coloring;       // as in line.vert; 3: one colour without light
layout(location = 5) uniform vec4 line_color;    // its opacity alone
layout(location = 7) uniform vec4 halo_color;    // sRGB; a: 0 takes the background, 1 the colour
layout(binding = 0) uniform sampler2D color_map; // one row, linear light
#ifdef LENS
layout(location = 10) uniform vec4 lens;         // a ball in N with colours of its own; no radius: none
layout(binding = 1) uniform sampler2D lens_map;
#endif
layout(location = 11) uniform float clearing;    // share of the opacity that goes with the place in the colour map

in Vertex {
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
} vertex;
noperspective in float halo_z;

#ifdef LAYERS
void keep_layer(vec4 color) {
  uint cover = uint(gl_SampleMaskIn[0]) & 0xffffu;
  uint opacity = uint(clamp(color.a, 0.0, 1.0) * 65535.0 + 0.5);
  if (cover == 0u || opacity == 0u) return;
  uint place = atomicAdd(layer_count, 1u);
  if (place >= uint(layers.length())) return;
  uint pixel = uint(gl_FragCoord.y) * uint(frame.size.x) + uint(gl_FragCoord.x);
  layers[place] = Layer(gl_FragCoord.z, packUnorm4x8(vec4(color.rgb, 0.0)), cover | opacity << 16u,
                        atomicExchange(heads[pixel], place + 1u));
}
#endif

// The entry next to t in [0, 1] of a table of one row in linear light, as glossy_color() (shade.glsl) has it: for fragments of which
// there are many. Grey where there is no number.
vec4 table_entry(sampler2D table, float t) {
  if (isnan(t)) return glossy_color(decode_srgb(vec3(0.5)));
  int entries = textureSize(table, 0).x;
  return texelFetch(table, ivec2(int(clamp(t, 0.0, 1.0) * float(entries - 1) + 0.5), 0), 0);
}

void main() {
  vec3 background = background_at(gl_FragCoord.xy);
  float u = abs(vertex.across);
  vec4 linear = coloring == 0 ? table_entry(color_map, vertex.value) : vertex.linear;
#ifdef LENS
  if (coloring == 0 && distance(vertex.place, lens.xyz) < lens.w) linear = table_entry(lens_map, vertex.lens_value);
#endif

  // Towards its edges a round line turns away from the eye.
  float facing = sqrt(max(0.0, 1.0 - u * u));
  vec3 lit = lit_glossy(linear, vertex.shine.x * mix(0.35, 1.0, facing), vertex.shine.y * facing);
  vec3 srgb = encode_srgb_fast(coloring == 3 ? linear.rgb : lit);

  // Depth cue: farther lines take on the background.
  srgb = mix(srgb, background, vertex.far);
  vec3 rim = mix(background, mix(halo_color.rgb, background, vertex.far), halo_color.a);

  // Halo beyond the edge; the border between the two is smoothed over one pixel.
  float soft = 0.5 * fwidth(vertex.across);
  float halo = vertex.outer > 1.0 ? smoothstep(1.0 - soft, 1.0 + soft, u) : 0.0;
  vec4 seen = vec4(mix(srgb, rim, halo), line_color.a * mix(1.0, clamp(vertex.value, 0.0, 1.0), clearing));
#ifdef LAYERS
  keep_layer(seen);  // transparent lines have no halos
#else
  color = seen;
  float sink = vertex.outer > 1.0 ? clamp((u - 1.0) / (vertex.outer - 1.0), 0.0, 1.0) : 0.0;
  gl_FragDepth = mix(gl_FragCoord.z, max(halo_z, gl_FragCoord.z), sink);
#endif
}
