#version 450 core
// A volume without lenses that shines by itself: colour and opacity along the ray of each pixel.
#include "volume/plain_march.glsl"
