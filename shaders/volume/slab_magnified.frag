#version 450 core
// As magnified.frag, a slab of it and what lies below.
#define SLABS
#define MAGNIFIED
#include "volume/lens_march.glsl"
