#version 450 core
// As lenses.frag, a slab of it and what lies below.
#define SLABS
#include "volume/lens_march.glsl"
