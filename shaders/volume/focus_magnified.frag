#version 450 core
// As magnified.frag, over a picture of the context.
#define CONTEXT
#define MAGNIFIED
#include "volume/lens_march.glsl"
