#version 450 core
// The context alone, under light.
#define SHADED
#include "volume/context.glsl"
