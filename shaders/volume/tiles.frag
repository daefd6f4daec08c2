#version 450 core
// The largest of both numbers is kept for each tile: minus the first t and the last one.
flat in vec2 span;
layout(location = 0) out vec2 largest;

void main() { largest = span; }
