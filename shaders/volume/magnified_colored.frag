#version 450 core
// A volume with lenses, of which some enlarge and some have the colours of the voxels.
#define MAGNIFIED
#define COLORED
#include "volume/lens_march.glsl"
