#version 450 core
// As magnified_colored.frag, over a picture of the context.
#define CONTEXT
#define MAGNIFIED
#define COLORED
#include "volume/lens_march.glsl"
