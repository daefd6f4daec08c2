// The voxels, whole or in bricks (common/render/volume/voxels/voxel_bricks.h), and their numbers at any place.
// Needs the uniform block of volume/volume_block.glsl and volume/lines.glsl.
#ifdef PINNED
layout(binding = 0) uniform PINNED voxels;  // in memory (common/render/volume/voxels/pinned_voxels.h), x fastest

// As textures give it: in [0, 1] of whole numbers.
float stored_number(int at) { return (float(texelFetch(voxels, at).x) - PINNED_LOWEST) / PINNED_UNIT; }

// Number at g, trilinear; beyond the points that of the nearest place.
float first_number_at(vec3 g) {
  vec3 last = field.points - 1.0, inside = clamp(g, vec3(0.0), last);
  vec3 cell = min(floor(inside), max(last - 1.0, vec3(0.0))), u = inside - cell;
  ivec3 n = ivec3(field.points), c = ivec3(cell), beside = min(n - 1, ivec3(1)) * ivec3(1, n.x, n.x * n.y);
  int at = c.x + n.x * (c.y + n.y * c.z), above = at + beside.z;
  vec4 low = vec4(stored_number(at), stored_number(at + beside.y), stored_number(above), stored_number(above + beside.y));
  at += beside.x, above += beside.x;
  vec4 high = vec4(stored_number(at), stored_number(at + beside.y), stored_number(above), stored_number(above + beside.y));
  vec4 along_x = mix(low, high, u.x);
  vec2 along_y = mix(along_x.xz, along_x.yw, u.y);
  return mix(along_y.x, along_y.y, u.z);
}
#else
layout(binding = 0) uniform sampler3D voxels;  // of the volume, or the pool of bricks
#endif

#ifdef BRICKED  // cells of a brick an axis
layout(binding = 11) uniform sampler3D brick_index;  // xyz: voxel of the pool at which the brick begins; w: see below

// Number at g, trilinear; beyond the points that of the nearest place. With b the brick, p where it begins in the pool,
//   b = floor(g / cells),   pool coordinate of g = p + (g - b cells) / s,   s = 8 where a coarse brick stands in, else 1
// neighbours share the points between them. The last brick owns the upper end. Places keep clear of the brick's faces by
// so little that texture units with weights in steps of 1/256 are one step off at most, and enough that no voxel of
// another brick gets a weight: it may be NaN.
float first_number_at(vec3 g) {
  const float kCells = float(BRICKED), kLower = 1.0 / 1024.0, kUpper = 1.0 / 480.0, kCoarse = 8.0;
  vec3 brick = clamp(floor(g / kCells), vec3(0.0), vec3(textureSize(brick_index, 0) - 1));
  vec3 cells = min(vec3(kCells), max(field.points - 1.0, vec3(1.0)));
  vec4 place = texelFetch(brick_index, ivec3(brick), 0);
  float scale = place.w < -3.4e38 ? 1.0 / kCoarse : 1.0;  // a coarse brick stands in
  vec3 inside = clamp((g - kCells * brick) * scale, vec3(kLower), ceil(cells * scale) - kUpper);
  float number = texture(voxels, (place.xyz + inside + 0.5) / vec3(textureSize(voxels, 0))).x;
  return isinf(place.w) ? number : place.w;  // not in the pool: a number that stands for all of the brick
}
#elif !defined(PINNED)
// Number at g, trilinear; beyond the points that of the nearest place.
float first_number_at(vec3 g) { return texture(voxels, (g + 0.5) / field.points).x; }
#endif

#if FIELDS > 1
// Those of other fields, which stand as a whole. A sampler must be chosen by what is the same for all pixels.
layout(binding = 12) uniform sampler3D field_voxels_1;
#if FIELDS > 2
layout(binding = 13) uniform sampler3D field_voxels_2;
#endif
#if FIELDS > 3
layout(binding = 14) uniform sampler3D field_voxels_3;
#endif

float lattice_number(vec3 g) {
  if (present == 0) return first_number_at(g);
  vec3 place = (g + 0.5) / field.points;
#if FIELDS > 3
  if (present == 3) return texture(field_voxels_3, place).x;
#endif
#if FIELDS > 2
  if (present == 2) return texture(field_voxels_2, place).x;
#endif
  return texture(field_voxels_1, place).x;
}
#else
float lattice_number(vec3 g) { return first_number_at(g); }
#endif

// Number at a place.
float number_at(vec3 m) { return lattice_number(lattice(m)); }
