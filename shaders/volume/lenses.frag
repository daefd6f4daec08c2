#version 450 core
// A volume with lenses.
#include "volume/lens_march.glsl"
