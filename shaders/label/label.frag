#version 450 core
// Signs in space: a colour, as opaque as the texture of letters says; its white corner stands for shapes.
layout(binding = 0) uniform sampler2D letters;  // r: how much a letter covers

in Vertex {
  vec2 letter_place;
  flat vec4 color;
} vertex;

layout(location = 0) out vec4 color;

void main() {
  color = vec4(vertex.color.rgb, vertex.color.a * texture(letters, vertex.letter_place).r);
}
