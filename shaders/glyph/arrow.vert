#version 450 core
// Arrows and tubes: a mesh of revolution about its axis, scaled part by part for each instance, so that
// shaft and head keep their own proportions. With the unit axis a and a radial unit vector r(phi):
//   position = origin + (t.x L_s + t.y L_h) a + (q.x R_s + q.y R_h) r
//   normal   = -n.x a + n.y r + n.z (L_h r + R_h a) / |(L_h, R_h)|
#include "include/frame.glsl"

struct Arrow {
  vec4 origin;  // xyz in N; w: radius of the shaft, R_s
  vec4 axis;    // xyz: unit; w: length of the shaft, L_s
  vec4 head;    // x: radius R_h; y: length L_h
  vec4 color;   // xyz: sRGB
};
layout(std430, binding = 0) readonly buffer Arrows { Arrow arrows[]; };

layout(location = 0) in vec2 circle;  // cos phi, sin phi
layout(location = 1) in vec2 along;   // t
layout(location = 2) in vec2 radial;  // q
layout(location = 3) in vec3 facing;  // n: cap, shaft, cone

out Vertex {
  vec3 normal;
  vec3 to_eye;
  flat vec3 color;
} result;

void main() {
  Arrow arrow = arrows[gl_InstanceID];
  vec3 a = arrow.axis.xyz;
  // Any direction across the axis will do: the one away from its smallest component is the safest.
  vec3 size = abs(a);
  vec3 least = size.x <= size.y && size.x <= size.z ? vec3(1.0, 0.0, 0.0)
               : size.y <= size.z                   ? vec3(0.0, 1.0, 0.0)
                                                    : vec3(0.0, 0.0, 1.0);
  vec3 u = normalize(cross(a, least));
  vec3 r = circle.x * u + circle.y * cross(a, u);
  vec2 parts = vec2(arrow.axis.w, arrow.head.y);
  vec2 radii = vec2(arrow.origin.w, arrow.head.x);
  vec3 position = arrow.origin.xyz + dot(along, parts) * a + dot(radial, radii) * r;
  vec3 cone = arrow.head.y * r + arrow.head.x * a;
  float steep = length(cone);

  result.normal = -facing.x * a + facing.y * r + facing.z * (steep > 0.0 ? cone / steep : a);
  result.to_eye = frame.eye.w > 0.5 ? frame.eye.xyz - position : frame.back.xyz;
  result.color = arrow.color.rgb;
  gl_Position = frame.clip_from_scene * vec4(position, 1.0);
}
