// The volume, its tables and its bricks (common/render/volume/volume_block.h).
// Grid coordinates g: whole numbers at the points. Table coordinate: of a number that the image stores, in
// [0, 1] from the middle of the first entry to that of the last one, but for half a texel at either end.
#ifndef FIELDS
#define FIELDS 1  // scalars of the scene, each on a grid of its own
#endif
const int kTransferRoom = 9;

struct Field {
  mat4 grid_from_scene;
  vec4 lower;   // xyz: corner of the volume, g; w: number at the first entry of a table
  vec4 upper;   // xyz: opposite corner; w: table coordinate a number
  vec4 points;  // xyz: voxels an axis; w: table coordinate of the first entry
  vec4 bricks;  // xyz: bricks an axis; w: samples a voxel from which on empty ones are left out
  vec4 slopes;  // x: row coordinate of region tables a table coordinate of values per N; y: that of the first row; z: reference lengths a unit of N
};
layout(std140, binding = 1) uniform Volume {
  vec4 lengths;   // x: length of layer 1 of a table in N; y: layers a table; z: opacity at which rays end; w: 1 ask tiles
  ivec4 counts;   // x: lenses, y: cuts
  vec4 far;       // x: nearest t of the volume of the context; y: 1 / depth of it in t; z: log2 of how many times as long steps are at its far end
  ivec4 transfers[kTransferRoom];  // x: field, y: 1 by regions, z: first layer of its tables, w: z of its map of empty bricks
  Field fields[FIELDS];
} volume;
#if FIELDS > 1
int present = 0;  // the field that is looked up: that of the context, or of a lens
#define field volume.fields[present]
#else
#define field volume.fields[0]
#endif

#include "volume/shape_block.glsl"
#include "volume/voxels.glsl"
layout(binding = 1) uniform sampler2DArray tables;   // associated colour and opacity: front entry, back entry, layer
layout(binding = 2) uniform usampler3D empty_bricks; // distances in bricks, one map after another along z
layout(binding = 3) uniform sampler2D opaque_depth;
layout(binding = 4) uniform sampler2D tiles;  // volume/tiles.vert
#ifdef COLORED
layout(binding = 5) uniform sampler3D colors;  // of the voxels, not associated
#endif
layout(location = 0) uniform bool has_opaque_depth;
