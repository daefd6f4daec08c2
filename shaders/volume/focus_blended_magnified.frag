#version 450 core
// As focus_magnified.frag, with lenses whose values go over into those outside.
#define CONTEXT
#define BLENDED
#define MAGNIFIED
#include "volume/lens_march.glsl"
