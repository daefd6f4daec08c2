// What the volume is divided by: its parts, planes that cut and the shapes of lenses, in the scene frame
// (common/render/volume/shape_block.h). Arrays have ROOM times the room that few shapes need; beyond what fits any
// driver's uniform blocks they are looked up in a storage buffer.
#ifndef ROOM
#define ROOM 1
#endif
const int kLensRoom = 8 * ROOM;
const int kFaceRoom = 256 * ROOM;
const int kCutRoom = 128 * ROOM;

const int kTransferColors = 0, kCutAway = 1, kVoxelColors = 2;  // contents of a part
const int kLit = 1, kShadows = 2, kIllustrated = 4;  // bits of its looks
// A part of the volume with a way of its own to be drawn.
struct Part {
  int transfer;  // number of its transfer function
  float samples;  // a voxel
  int looks;  // of the bits below
  int content;
};

#if ROOM > 2
layout(std430, binding = 2) readonly buffer Shapes {
#else
layout(std140, binding = 2) uniform Shapes {
#endif
  Part parts[1 + kLensRoom];        // the context, then the lenses
  vec4 cuts[kCutRoom];              // outward unit normal, offset, N: what lies beyond is cut away
  mat4 unit_from_scene[kLensRoom];  // quadric: |x| <= 1; its last element is 1 where there is one, else 0
  vec4 centers[kLensRoom];          // xyz: middle; w: magnification
  ivec4 faces[kLensRoom];           // x: first plane, y: planes
  vec4 planes[kFaceRoom];           // outward unit normal, offset
  vec4 circles[kLensRoom];          // on the screen, in heights of the picture: xy middle, z radius, 0: none; w transition
} shapes;
