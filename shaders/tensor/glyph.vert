#version 450 core
// Tensor glyphs: a sphere of unit radius, latitude phi from its pole and longitude theta, bent to a superquadric
//   x = (cos^a theta sin^b phi, sin^a theta sin^b phi, cos^b phi)            (Kindlmann 2004, eq. 1)
// with signed powers, and stretched along the tensor's axes. a = b = 1 is an ellipsoid. Its normal is that with
// the exponents 2 - a and 2 - b, divided by the stretch.
#include "include/frame.glsl"

struct Glyph {
  vec4 center;  // xyz in N; w: exponent a
  vec4 axis_x;  // xyz: half axis in N; w: exponent b
  vec4 axis_y;
  vec4 axis_z;  // that of the pole
  vec4 color;   // xyz: sRGB
};
layout(std430, binding = 0) readonly buffer Glyphs { Glyph glyphs[]; };

layout(location = 0) in vec4 angles;  // cos theta, sin theta, cos phi, sin phi

out Vertex {
  vec3 normal;
  vec3 to_eye;
  flat vec3 color;
} result;

float signed_pow(float x, float exponent) { return sign(x) * pow(abs(x), exponent); }

vec3 bent(float a, float b) {
  float across = signed_pow(angles.w, b);
  return vec3(signed_pow(angles.x, a) * across, signed_pow(angles.y, a) * across, signed_pow(angles.z, b));
}

void main() {
  Glyph glyph = glyphs[gl_InstanceID];
  float a = glyph.center.w, b = glyph.axis_x.w;
  vec3 x = bent(a, b), n = bent(2.0 - a, 2.0 - b);
  vec3 position = glyph.center.xyz + x.x * glyph.axis_x.xyz + x.y * glyph.axis_y.xyz + x.z * glyph.axis_z.xyz;
  vec3 size = vec3(dot(glyph.axis_x.xyz, glyph.axis_x.xyz), dot(glyph.axis_y.xyz, glyph.axis_y.xyz),
                   dot(glyph.axis_z.xyz, glyph.axis_z.xyz));
  n /= size;
  result.normal = n.x * glyph.axis_x.xyz + n.y * glyph.axis_y.xyz + n.z * glyph.axis_z.xyz;
  result.to_eye = frame.eye.w > 0.5 ? frame.eye.xyz - position : frame.back.xyz;
  result.color = glyph.color.rgb;
  gl_Position = frame.clip_from_scene * vec4(position, 1.0);
}
