// A slab of the volume, n.x between two borders, and with it the picture of what lies below it
// (common/render/volume/slab_cache.h). On each ray both borders are moved to the next sample.
// Needs volume/volume_block.glsl and volume/ray.glsl.
layout(location = 1) uniform vec3 slab_normal;       // n, unit
layout(location = 2) uniform vec2 slab_borders;      // of n.x, N
layout(binding = 6) uniform sampler2D cached_picture;  // what lies below the slab, associated
layout(binding = 7) uniform sampler2D cached_depth;    // opaque_depth when that was drawn

vec2 slab_interval = vec2(-1e30, 1e30);  // t in the slab, before borders are moved

// What lies below the slab; nothing where opaque things have moved: the ray is cast all along.
// @param in_front whether the ray meets it before the slab
vec4 enter_slab(Ray ray, out bool in_front) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float speed = dot(slab_normal, ray.direction);
  vec2 room = slab_borders - dot(slab_normal, ray.origin);
  in_front = speed > 0.0;
  if (has_opaque_depth && texelFetch(opaque_depth, pixel, 0).x != texelFetch(cached_depth, pixel, 0).x)
    return vec4(0.0);
  vec2 t = room / speed;
  slab_interval = in_front ? t : t.yx;
  // Along the slab a ray is all in it or not at all.
  if (speed == 0.0) slab_interval = room.x <= 0.0 && room.y > 0.0 ? vec2(-1e30, 1e30) : vec2(1e30, -1e30);
  return texelFetch(cached_picture, pixel, 0);
}

// The part of a stretch that lies in the slab, for samples at n d; from == to where there is none.
void stay_in_slab(float d, inout float from, inout float to) {
  vec2 at = clamp(ceil(slab_interval / d) * d, vec2(from), vec2(max(from, to)));
  from = at.x;
  to = max(at.x, at.y);
}
