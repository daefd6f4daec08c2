#version 450 core
// As focus_magnified_colored.frag, with lenses whose values go over into those outside.
#define CONTEXT
#define BLENDED
#define MAGNIFIED
#define COLORED
#include "volume/lens_march.glsl"
