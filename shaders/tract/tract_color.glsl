// The colour of a tract between its middle and its edges, as a round thing has it.
in Vertex {
  noperspective vec3 middle;  // sRGB
  noperspective vec3 edge;
  noperspective float across;
} vertex;

vec3 tract_color() {
  float facing = sqrt(max(0.0, 1.0 - vertex.across * vertex.across));
  return mix(vertex.edge, vertex.middle, facing);
}
