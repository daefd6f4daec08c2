// The context before and behind the lenses of a ray, from a smaller picture of it
// (common/render/volume/context_picture.h).
// Needs include/frame.glsl and volume/ray.glsl.
layout(location = 4) uniform vec3 context_pixel;  // pixels there are those here times x, plus yz
layout(binding = 6) uniform sampler2D context_front;
layout(binding = 7) uniform sampler2D context_back;
layout(binding = 8) uniform sampler2D context_kind;

// How far opaque things that belong together may be apart from pixel to pixel of the context.
float same_distance(float to) {
  const float kSteepest = 4.0;
  float pixel = frame.size.z / context_pixel.x;
  return kSteepest * pixel * (frame.eye.w > 0.5 ? max(to, 0.0) / frame.size.w : 1.0);
}

// @param meets a lens. @return false where no pixel around shows the same.
bool enlarged_context(Ray ray, bool meets, out vec4 before, out vec4 behind) {
  const float kLeast = 1e-3;  // of a weight
  vec2 at = gl_FragCoord.xy * context_pixel.x + context_pixel.yz - 0.5;
  vec2 corner = floor(at), part = at - corner;
  ivec2 last = textureSize(context_kind, 0) - 1;
  float sum = 0.0;
  before = behind = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 side = ivec2(i & 1, i >> 1);
    ivec2 place = clamp(ivec2(corner) + side, ivec2(0), last);
    vec2 kind = texelFetch(context_kind, place, 0).xy;
    bool same = kind.x > 1.5 || (kind.x > 0.5) == meets && abs(kind.y - ray.to) <= same_distance(ray.to);
    vec2 share = mix(1.0 - part, part, vec2(side));
    float weight = same ? share.x * share.y + kLeast : 0.0;
    before += weight * texelFetch(context_front, place, 0);
    behind += weight * texelFetch(context_back, place, 0);
    sum += weight;
  }
  if (!(sum > 0.0)) return false;
  before /= sum;
  behind /= sum;
  return true;
}
