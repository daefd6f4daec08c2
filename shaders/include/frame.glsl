// What all passes of one picture share. Scene frame N: centred on the domain, lengths near one.
layout(std140, binding = 0) uniform Frame {
  mat4 clip_from_scene;
  vec4 eye;                // xyz: position of the eye in N; w: 1 perspective, 0 orthographic
  vec4 right;              // xyz: unit axis of the camera in N; w: how far the eye lies off the middle along it
  vec4 up;                 // likewise
  vec4 back;               // toward the viewer
  vec4 size;               // x, y: picture in pixels; z: N units a pixel at the focal point; w: focal distance
  vec4 depth_cue;          // x, y: depths between which lines fade; z: share of fading at the far end; w: strength of highlights
  vec4 background_top;     // sRGB
  vec4 background_bottom;  // sRGB
} frame;

// The background where the fragment at `pixel` (from the lower left corner) lies, sRGB.
vec3 background_at(vec2 pixel) {
  return mix(frame.background_bottom.rgb, frame.background_top.rgb, pixel.y / frame.size.y);
}
