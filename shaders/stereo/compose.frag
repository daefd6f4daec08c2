#version 450 core
// One picture of two eyes' (common/render/stereo/stereo_pass.h).
#include "include/color.glsl"

layout(binding = 0) uniform sampler2D left_eye;   // sRGB
layout(binding = 1) uniform sampler2D right_eye;  // sRGB
layout(location = 0) uniform int mode;            // StereoMode
layout(location = 1) uniform ivec2 first;         // of the display's column and row at the upper left: odd?
layout(location = 0) out vec4 color;

const int kSideBySide = 1, kTopBottom = 2, kRows = 3, kColumns = 4, kAnaglyph = 5;

// Dubois 2009, red-cyan; rows as printed, so v * M here.
const mat3 kLeft = mat3(0.437, 0.449, 0.164, -0.062, -0.062, -0.024, -0.048, -0.050, -0.017);
const mat3 kRight = mat3(-0.011, -0.032, -0.007, 0.377, 0.761, 0.009, -0.026, -0.093, 1.234);
const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);  // ITU-R BT.709

vec3 eye_at(bool right, ivec2 place) {
  return right ? texelFetch(right_eye, place, 0).rgb : texelFetch(left_eye, place, 0).rgb;
}

void main() {
  ivec2 size = textureSize(left_eye, 0), at = ivec2(gl_FragCoord.xy);
  vec3 seen = vec3(0.0);
  if (mode == kSideBySide) {
    if (at.x < 2 * size.x) seen = eye_at(at.x >= size.x, ivec2(at.x % size.x, at.y));
  } else if (mode == kTopBottom) {
    if (at.y < 2 * size.y) seen = eye_at(at.y < size.y, ivec2(at.x, at.y % size.y));
  } else if (mode == kRows) {
    seen = eye_at((first.y + size.y - 1 - at.y) % 2 == 1, at);  // rows count from the top
  } else if (mode == kColumns) {
    seen = eye_at((first.x + at.x) % 2 == 1, at);
  } else {
    vec3 l = decode_srgb(eye_at(false, at)), r = decode_srgb(eye_at(true, at));
    seen = mode == kAnaglyph ? l * kLeft + r * kRight
                             : vec3(dot(l, kLuminance), vec2(dot(r, kLuminance)));
    seen = encode_srgb(seen);
  }
  color = vec4(seen, 1.0);
}
