#version 450 core
// Spheres without a mesh: one square an instance, facing the eye, just large enough for the silhouette
// and the halo around it. Seen from the distance D, a sphere of radius R touches the rays of a cone that
// cuts the plane through its centre at the radius
//   R D / sqrt(D^2 - R^2)   (perspective),   R   (orthographic)
#include "include/frame.glsl"

struct Sphere {
  vec4 place;  // xyz: centre in N; w: radius in N
  vec4 color;  // xyz: sRGB
};
layout(std430, binding = 0) readonly buffer Spheres { Sphere spheres[]; };

layout(location = 0) uniform float halo_width;  // beyond the silhouette, pixels

out Vertex {
  flat vec4 place;
  flat vec3 color;
  flat vec3 to_eye;       // from the centre, in N; a unit vector where orthographic
  flat float halo;        // width in N
  vec3 offset;            // of the point on the square from the centre, in N
} result;

void main() {
  Sphere sphere = spheres[gl_InstanceID];
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
  vec3 centre = sphere.place.xyz;
  float radius = sphere.place.w;
  bool perspective = frame.eye.w > 0.5;
  vec3 to_eye = perspective ? frame.eye.xyz - centre : frame.back.xyz;
  float far = length(to_eye);
  float depth = dot(frame.eye.xyz - centre, frame.back.xyz);
  float pixel = perspective ? frame.size.z * max(depth, 0.0) / frame.size.w : frame.size.z;

  result.place = sphere.place;
  result.color = sphere.color.rgb;
  result.to_eye = to_eye;
  result.halo = halo_width * pixel;
  result.offset = vec3(0.0);
  // An eye within the sphere, or before it, sees nothing of it.
  bool seen = !perspective || (far > 1.001 * radius && depth > 0.0);
  if (!seen) {
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
    return;
  }
  vec3 view = to_eye / far;
  vec3 right = normalize(cross(frame.up.xyz, view));
  vec3 up = cross(view, right);
  float cone = perspective ? far / sqrt(far * far - radius * radius) : 1.0;
  result.offset = (right * corner.x + up * corner.y) * (cone * (radius + result.halo));
  gl_Position = frame.clip_from_scene * vec4(centre + result.offset, 1.0);
}
