#version 450 core
// A volume of which parts have the colours of its voxels, with lenses or without.
#define COLORED
#include "volume/lens_march.glsl"
