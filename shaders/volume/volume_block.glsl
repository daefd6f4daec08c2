// The volume, its tables and its bricks (common/render/volume/volume_block.h).
// Grid coordinates g: whole numbers at the points; at uneven steps (UNEVEN) mean coordinates m stand in their place, but
// where voxels are looked up (volume/lines.glsl). Table coordinate: of a number that the image stores, in
// [0, 1] from the middle of the first entry to that of the last one, but for half a texel at either end.
#ifndef FIELDS
#define FIELDS 1  // scalars of the scene, each on a grid of its own
#endif
const int kTransferRoom = 9;

struct Field {
  mat4 grid_from_scene;
  vec3 lower;  // corner of the volume, g
  float first_number;  // at the first entry of a table
  vec3 upper;  // opposite corner
  float entries_a_number;  // table coordinate a number
  vec3 points;  // voxels an axis
  float first_entry;  // its table coordinate
  vec3 bricks;  // an axis
  float samples_to_leap;  // a voxel, from which on empty bricks are left out
  float rows_a_slope;  // row coordinate of region tables a table coordinate of values per N
  float first_row;  // its row coordinate
  float reference_lengths;  // a unit of N
  ivec4 lines;  // where the table of each axis begins; -1: even steps
  ivec4 buckets;  // of these tables
};
struct Transfer {
  int of_field;
  int by_regions;  // 1: of value and gradient magnitude
  int first_layer;  // of its tables
  int first_brick;  // z of its map of empty bricks
};
layout(std140, binding = 1) uniform Volume {
  float layer_length;  // of layer 1 of a table, N
  float layer_count;  // of a table
  float opaque;  // opacity at which rays end
  float asks_tiles;  // 1 or 0
  int lens_count;
  int cut_count;
  float far_first;  // nearest t of the volume of the context
  float far_rate;  // 1 / depth of it in t
  float far_doublings;  // log2 of how many times as long steps are at its far end
  float context_fade;  // share of its opacity that matter before a lens loses
  Transfer transfers[kTransferRoom];
  Field fields[FIELDS];
} volume;
#if FIELDS > 1
int present = 0;  // the field that is looked up: that of the context, or of a lens
#define field volume.fields[present]
#else
#define field volume.fields[0]
#endif

#include "volume/shape_block.glsl"
#include "volume/lines.glsl"
#include "volume/voxels.glsl"
layout(binding = 1) uniform sampler2DArray tables;   // associated colour and opacity: front entry, back entry, layer
layout(binding = 2) uniform usampler3D empty_bricks; // distances in bricks, one map after another along z
layout(binding = 3) uniform sampler2D opaque_depth;
layout(binding = 4) uniform sampler2D tiles;  // volume/tiles.vert
#ifdef COLORED
layout(binding = 5) uniform sampler3D colors;  // of the voxels, not associated
#endif
layout(location = 0) uniform bool has_opaque_depth;
