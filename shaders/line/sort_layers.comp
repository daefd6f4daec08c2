#version 450 core
// Orders the layers of each pixel from front to back, so that the list does not tell in which order they came: by depth,
// then by what they look like. Insertion: lists that are sorted either way take a step a layer.
#include "line/layers.glsl"
layout(local_size_x = 64) in;

bool before(uint a, uint b) {
  Layer p = layers[a - 1u], q = layers[b - 1u];
  if (p.z != q.z) return p.z < q.z;
  return p.color != q.color ? p.color < q.color : p.cover < q.cover;
}

void main() {
  uint pixel = gl_GlobalInvocationID.x;
  if (pixel >= uint(heads.length())) return;
  uint rest = heads[pixel];
  if (rest == 0u || layers[rest - 1u].next == 0u) return;
  uint first = rest, last = rest;
  rest = layers[rest - 1u].next;
  layers[first - 1u].next = 0u;
  while (rest != 0u) {
    uint taken = rest;
    rest = layers[taken - 1u].next;
    if (!before(taken, last)) {
      layers[taken - 1u].next = 0u;
      layers[last - 1u].next = taken;
      last = taken;
    } else if (before(taken, first)) {
      layers[taken - 1u].next = first;
      first = taken;
    } else {
      uint at = first;
      for (uint next = layers[at - 1u].next; !before(taken, next); next = layers[at - 1u].next) at = next;
      layers[taken - 1u].next = layers[at - 1u].next;
      layers[at - 1u].next = taken;
    }
  }
  heads[pixel] = first;
}
