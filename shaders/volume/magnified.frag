#version 450 core
// A volume with lenses, of which some enlarge.
#define MAGNIFIED
#include "volume/lens_march.glsl"
