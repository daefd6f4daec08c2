#version 450 core
// Each ray is split at the borders of lenses into stretches of context and focus, each marched in its own way.
// Variants (common/render/volume/volume_pass.cpp): MAGNIFIED some lenses enlarge; COLORED some parts have the colours of
// the voxels; SLABS a slab of the volume and what lies below; CONTEXT over a picture of the context; BLENDED, with
// CONTEXT, the values of some lenses go over into those outside.
#define SHADED
#include "include/frame.glsl"
#include "include/color.glsl"
#include "include/shade.glsl"
#include "volume/volume_block.glsl"
#include "volume/ray.glsl"
#include "volume/slope.glsl"
#ifdef SLABS
#include "volume/slab.glsl"
#endif
#include "volume/surface.glsl"
#include "volume/lens_segments.glsl"
#ifdef BLENDED
#include "volume/blend.glsl"
#endif
#include "volume/march.glsl"
#ifdef MAGNIFIED
#include "volume/magnify.glsl"
#endif
#ifdef CONTEXT
#include "volume/enlarge.glsl"
#endif
#ifdef LAYERS
#include "volume/layers.glsl"
#endif

layout(location = 0) out vec4 color;  // associated

#if defined(MAGNIFIED) || FIELDS > 1
// Whether lens `i` may show something where the context has no volume.
bool reaches_out(int i) {
#if FIELDS > 1
  if (volume.transfers[shapes.parts[i + 1].transfer].of_field > 0) return true;
#endif
#ifdef MAGNIFIED
  return magnifies(i);
#else
  return false;
#endif
}
#endif

void main() {
#ifndef CONTEXT
  if (is_saved()) discard;
#endif
  Ray ray = pixel_ray();
  vec2 inside[kLensRoom];
  vec2 span = lens_span(ray, inside);
  int count = volume.lens_count;
  float t = ray.first, end = ray.last;
#if defined(MAGNIFIED) || FIELDS > 1
  // What is seen enlarged reaches as far as its lens, out of the volume, too; another field as far as both.
  vec2 reach = ray.first < ray.last ? vec2(ray.first, ray.last) : vec2(1e30, -1e30);
  for (int i = 0; i < count; ++i) {
    if (reaches_out(i) && inside[i].x < inside[i].y) reach = vec2(min(reach.x, inside[i].x), max(reach.y, inside[i].y));
  }
  t = max(reach.x, ray.from);
  end = min(reach.y, ray.to);
#endif
#ifdef LAYERS
  begin_layers(ray);
  if (!(t < end) && layer == 0u) discard;
#else
  if (!(t < end)) discard;
#endif
  color = vec4(0.0);
#ifdef SLABS
  bool in_front;
  vec4 kept = enter_slab(ray, in_front);
  if (in_front) color = kept;
#endif
#ifdef CONTEXT
  vec4 behind;
  bool enlarged = enlarged_context(ray, span.x < span.y, color, behind);
  if (enlarged) {
    t = max(t, span.x);
    end = min(end, span.y);
  }
#endif

  for (int k = 0; k <= 2 * count && t < end && color.a <= volume.opaque; ++k) {
    // The first lens that holds t owns the stretch, up to its end or where one before it in the list begins.
    int owner = 0;
    float stop = end;
#ifdef LAYERS
    pass_layers(ray, t, color);
    stop = min(stop, layer_at);
#endif
    for (int i = 0; i < count; ++i) {
      if (!(inside[i].x < inside[i].y)) continue;
      if (inside[i].x > t) {
        stop = min(stop, inside[i].x);
      } else if (inside[i].y > t) {
        owner = i + 1;
        stop = min(stop, inside[i].y);
        break;
      }
    }
    bool seen = shapes.parts[owner].content != kCutAway;
#ifdef ILLUSTRATED
    fading = owner == 0 && t < span.x && span.x < span.y ? volume.context_fade : 0.0;
#endif
#ifdef BLENDED
    begin_blending(owner - 1);
#endif
#if FIELDS > 1
    Ray through = enter_field(ray, shapes.parts[owner].transfer);
#else
    Ray through = ray;
#endif
#ifdef MAGNIFIED
    if (seen && owner > 0 && magnifies(owner - 1)) {
      march_magnified(through, owner - 1, shapes.parts[owner], t, stop, color);
      seen = false;
    }
#endif
#if defined(MAGNIFIED) || FIELDS > 1
    float first = max(t, through.first), last = min(stop, through.last);
    if (seen && first < last) march(through, shapes.parts[owner], first, last, color);
#else
    if (seen) march(through, shapes.parts[owner], t, stop, color);
#endif
    t = stop;
#ifdef LAYERS
    if (stop == layer_at) --k;  // lenses alone make no more than 2 count + 1 stretches
#endif
  }
#ifdef LAYERS
  pass_layers(ray, 1e30, color);
#endif
#ifdef SLABS
  if (!in_front) color += (1.0 - color.a) * kept;
#endif
#ifdef CONTEXT
  if (enlarged) color += (1.0 - color.a) * behind;
#endif
}
