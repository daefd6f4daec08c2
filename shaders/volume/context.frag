#version 450 core
// The context alone.
#include "volume/context.glsl"
