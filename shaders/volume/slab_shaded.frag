#version 450 core
// As shaded.frag, a slab of it and what lies below.
#define SLABS
#define SHADED
#include "volume/plain_march.glsl"
