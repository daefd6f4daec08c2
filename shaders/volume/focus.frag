#version 450 core
// As lenses.frag, over a picture of the context.
#define CONTEXT
#include "volume/lens_march.glsl"
