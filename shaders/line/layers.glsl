// Transparent lines as layers of each pixel, for passes that show something between them
// (common/render/line/line_layers.h). The list of a pixel begins with its head; 0 ends it, i is layers[i - 1].
struct Layer {
  float z;     // depth in the buffer, [0, 1]
  uint color;  // sRGB, 8 bits each, not associated
  uint cover;  // low 16 bits: samples of the pixel that it covers; high ones: opacity there
  uint next;
};
layout(std430, binding = 3) buffer Layers {
  uint layer_count;  // that were asked for; may be more than there is room for
  Layer layers[];
};
layout(std430, binding = 4) buffer Heads { uint heads[]; };  // row by row from the lower left corner
