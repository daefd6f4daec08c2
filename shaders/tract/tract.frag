#version 450 core
// Opaque tracts. No depth and no samples are written here, so that what is hidden is never shaded.
#include "tract/tract_color.glsl"

layout(location = 0) out vec4 color;

void main() { color = vec4(tract_color(), 1.0); }
