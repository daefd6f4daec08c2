#version 450 core
// As colored.frag, over a picture of the context.
#define CONTEXT
#define COLORED
#include "volume/lens_march.glsl"
