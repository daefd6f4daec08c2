// The ray of a pixel and where it meets the volume. Needs include/frame.glsl and volume/volume_block.glsl.
struct Ray {
  vec3 origin;     // N: the eye, or in an orthographic view a point of the plane through it
  vec3 direction;  // N, unit
  vec3 start;      // g at t = 0
  vec3 speed;      // g a unit of t
  vec3 pace;       // its reciprocal, large where there is no speed
  float first;     // t between which the ray runs in the volume and may see something; first > last: nowhere
  float last;
  float from;      // t between which nothing opaque, no eye and no cut is in the way, be it in the volume or not
  float to;
};

// The point at t, in g. To the last bit the same in every program, so that cut and kept pictures see the same voxels:
// GPUs weigh neighbouring voxels in steps of 1/256, and a last bit may be one step.
vec3 point_at(Ray ray, float t) {
  precise vec3 g = ray.start + t * ray.speed;
  return g;
}

// The place of this pixel in the picture, and the pixel of opaque_depth that lies there.
const float kTilePixels = 8.0;
layout(location = 41) uniform vec3 depth_pixel = vec3(1.0, 0.0, 0.0);  // pixels there are those here times x, plus yz
ivec2 opaque_pixel() {
  ivec2 place = ivec2(floor(gl_FragCoord.xy * depth_pixel.x + depth_pixel.yz));
  return clamp(place, ivec2(0), textureSize(opaque_depth, 0) - 1);
}

#ifndef CONTEXT
// Whether this pixel shows the volume already, as it was kept (common/render/volume/cached_volume.h): what is opaque there
// has not moved.
layout(location = 40) uniform bool has_saved;
layout(binding = 8) uniform sampler2D still_depth;  // opaque_depth when it was kept
bool is_saved() {
  return has_saved && texelFetch(opaque_depth, opaque_pixel(), 0).x == texelFetch(still_depth, opaque_pixel(), 0).x;
}
#endif

#ifdef TILES
vec2 picture_pixel() { return kTilePixels * gl_FragCoord.xy; }
#else
vec2 picture_pixel() { return gl_FragCoord.xy; }
#endif

// The t at which an opaque thing of this depth lies: depth z of the buffer gives the clip coordinate
// Z = 2 z - 1 = (z0 + t z1) / (w0 + t w1), with clip coordinates (z0, w0) of the origin and (z1, w1) of the
// direction.
float opaque_distance(Ray ray, float z, float none) {
  if (z >= 1.0) return none;
  vec4 from = frame.clip_from_scene * vec4(ray.origin, 1.0);
  vec4 along = frame.clip_from_scene * vec4(ray.direction, 0.0);
  float clip = 2.0 * z - 1.0;
  return (from.z - clip * from.w) / (clip * along.w - along.z);
}

// Where the ray runs through the field that is looked up.
void find_volume(inout Ray ray) {
  ray.start = (field.grid_from_scene * vec4(ray.origin, 1.0)).xyz;
  ray.speed = mat3(field.grid_from_scene) * ray.direction;

  ray.pace = 1.0 / mix(ray.speed, vec3(1e-30), lessThan(abs(ray.speed), vec3(1e-30)));
  vec3 a = (field.lower - ray.start) * ray.pace, b = (field.upper - ray.start) * ray.pace;
  vec3 near = min(a, b), far = max(a, b);
  ray.first = max(near.x, max(near.y, near.z));
  ray.last = min(far.x, min(far.y, far.z));
}

#if FIELDS > 1
// The same ray through the field of a transfer function, which is looked up from now on.
Ray enter_field(Ray ray, int transfer) {
  present = volume.transfers[transfer].of_field;
  find_volume(ray);
  ray.first = max(ray.first, ray.from);
  ray.last = min(ray.last, ray.to);
  return ray;
}
#endif

Ray pixel_ray() {
  vec2 at = (picture_pixel() - 0.5 * frame.size.xy) * frame.size.z;
  vec3 across = at.x * frame.right.xyz + at.y * frame.up.xyz;
  bool perspective = frame.eye.w > 0.5;
  Ray ray;
  ray.origin = perspective ? frame.eye.xyz : frame.eye.xyz + across;
  vec3 off_axis = frame.right.w * frame.right.xyz + frame.up.w * frame.up.xyz;
  ray.direction = perspective ? normalize(across - off_axis - frame.size.w * frame.back.xyz) : -frame.back.xyz;
  find_volume(ray);
  ray.from = perspective ? 0.0 : -1e30;
  ray.to = 1e30;
  if (has_opaque_depth) ray.to = opaque_distance(ray, texelFetch(opaque_depth, opaque_pixel(), 0).x, ray.to);
  for (int i = 0; i < volume.cut_count; ++i) {
    float speed = dot(shapes.cuts[i].xyz, ray.direction), room = shapes.cuts[i].w - dot(shapes.cuts[i].xyz, ray.origin);
    if (speed > 0.0) ray.to = min(ray.to, room / speed);
    if (speed < 0.0) ray.from = max(ray.from, room / speed);
    if (speed == 0.0 && room < 0.0) ray.to = -1e30;
  }
  ray.first = max(ray.first, ray.from);
  if (volume.asks_tiles > 0.5) {
    vec2 span = texelFetch(tiles, ivec2(gl_FragCoord.xy) / int(kTilePixels), 0).xy;
    // Tiles know the shell of what is seen; a ray that begins in the volume may begin within the shell.
    if (!perspective || ray.first > 0.0) ray.first = max(ray.first, -span.x);
    ray.last = min(ray.last, span.y);
  }
  ray.last = min(ray.last, ray.to);
  return ray;
}
