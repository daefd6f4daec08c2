#version 450 core
// A volume without lenses under light.
#define SHADED
#include "volume/plain_march.glsl"
