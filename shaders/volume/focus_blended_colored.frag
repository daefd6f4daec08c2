#version 450 core
// As focus_colored.frag, with lenses whose values go over into those outside.
#define CONTEXT
#define BLENDED
#define COLORED
#include "volume/lens_march.glsl"
