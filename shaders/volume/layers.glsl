// Transparent lines in the volume: what a ray has gathered up to one of them is before it, what it gathers from there
// on is seen through it. With T_i the light that gets through to sample i of the pixel and m_i whether a layer of colour
// c and opacity a covers it,
//   C <- C + a c mean(m_i T_i),   T_i <- (1 - a m_i) T_i
// Matter weakens all T_i alike: they are (1 - A) times shares of mean 1.
// Needs volume/ray.glsl.
#include "line/layers.glsl"

uint layer = 0u;           // the next one; 0: there are no more
float layer_at = 1e30;     // its t
vec4 shares = vec4(1.0);

void find_layer(Ray ray) { layer_at = layer > 0u ? opaque_distance(ray, layers[layer - 1u].z, 1e30) : 1e30; }

void begin_layers(Ray ray) {
  ivec2 pixel = opaque_pixel();
  layer = heads[pixel.y * textureSize(opaque_depth, 0).x + pixel.x];
  find_layer(ray);
}

void pass_layer(Ray ray, inout vec4 gathered) {
  Layer passed = layers[layer - 1u];
  float opacity = float(passed.cover >> 16u) / 65535.0;
  vec4 covered = vec4((uvec4(passed.cover) >> uvec4(0u, 1u, 2u, 3u)) & 1u);
  vec4 taken = opacity * covered * shares, left = shares - taken;
  float light = 1.0 - gathered.a, rest = dot(left, vec4(0.25));
  gathered.rgb += light * dot(taken, vec4(0.25)) * unpackUnorm4x8(passed.color).rgb;
  gathered.a = 1.0 - light * rest;
  shares = rest > 0.0 ? left / rest : vec4(1.0);
  layer = passed.next;
  find_layer(ray);
}

// Those up to t, as far as light comes from there.
void pass_layers(Ray ray, float t, inout vec4 gathered) {
  while (layer > 0u && layer_at <= t && gathered.a <= volume.opaque) pass_layer(ray, gathered);
}
