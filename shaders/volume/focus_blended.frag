#version 450 core
// As focus.frag, with lenses whose values go over into those outside.
#define CONTEXT
#define BLENDED
#include "volume/lens_march.glsl"
