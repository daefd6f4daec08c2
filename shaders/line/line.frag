#version 450 core
// Illuminated streamlines: the light of a line (line_light.glsl), rounded across its width. With LAYERS they are not drawn
// but put into the list of each pixel (line/layers.glsl), as far as nothing opaque hides them.
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/color_table.glsl"
#include "include/shade.glsl"
#include "include/line_light.glsl"
#ifdef LAYERS
#include "line/layers.glsl"
layout(early_fragment_tests) in;
#else
layout(location = 0) out vec4 color;
#endif

layout(location = 3) uniform bool has_values;
layout(location = 4) uniform int coloring;       // 0 colour map, 1 direction, 2 one colour, 3 one colour without light
layout(location = 5) uniform vec4 line_color;    // sRGB and opacity; rgb for colouring 2 and 3
layout(location = 6) uniform float fading;       // share of the depth cue
layout(location = 7) uniform vec4 halo_color;    // sRGB; a: 0 takes the background, 1 the colour
layout(location = 8) uniform float dimming;      // share of the background at any depth
layout(location = 10) uniform vec4 lens;         // a ball in N with colours of its own; no radius: none
layout(location = 11) uniform float clearing;    // share of the opacity that goes with the place in the colour map
layout(binding = 0) uniform sampler2D color_map; // one row, sRGB
layout(binding = 1) uniform sampler2D lens_map;

in Vertex {
  vec3 tangent;
  vec3 side;
  vec3 view;
  float across;
  float outer;
  float value;
  float lens_value;
  vec3 place;
  float depth;
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

vec3 base_color(vec3 t) {
  if (coloring == 1) return abs(t);
  if (coloring >= 2) return line_color.rgb;
  if (distance(vertex.place, lens.xyz) < lens.w) return table_color(lens_map, vertex.lens_value);
  return table_color(color_map, vertex.value);
}

void main() {
  vec3 t = length(vertex.tangent) > 0.0 ? normalize(vertex.tangent) : vec3(0.0);
  vec3 background = background_at(gl_FragCoord.xy);
  float u = abs(vertex.across);
  vec3 srgb = base_color(t);

  if (coloring != 3) {
    const float kDiffuseExponent = 1.6;  // less flat than 1, less stark than the 4.8 of Banks
    vec2 shine = line_light(t, light_direction(), normalize(vertex.view));
    // Towards its edges a round line turns away from the eye.
    float facing = sqrt(max(0.0, 1.0 - u * u));
    float diffuse = pow(shine.x, kDiffuseExponent) * mix(0.35, 1.0, facing);
    srgb = shade(srgb, diffuse, pow(shine.y, kShininess) * facing);
  }

  // Depth cue: farther lines take on the background.
  float far = mix(fading * fading_at(vertex.depth), 1.0, dimming);
  srgb = mix(srgb, background, far);
  vec3 rim = mix(background, mix(halo_color.rgb, background, far), halo_color.a);

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
