#version 450 core
// As volume.frag, a slab of it and what lies below.
#define SLABS
#include "volume/plain_march.glsl"
