// Marches along a part of a ray, front to back, on samples at t = n d (volume_pass.h). A stretch between two
// samples, their values taken as the ends of a linear course, adds what the table of its length holds:
//   C <- C + (1 - A) C_table,   A <- A + (1 - A) A_table
// Software rasterisers compute both branches of an `if`: a step reads one voxel and one entry of a table whichever way
// it goes, bricks are asked every other step (before each one where rays look for the next stretch that light falls on),
// light is computed once a stretch that is seen, and stretches cut short by borders come before and after the loop.
// Needs volume/volume_block.glsl and volume/ray.glsl, volume/slope.glsl and shaded() where rays are shaded and volume/blend.glsl where values
// are blended.

// Table coordinate of the value at g; NaN where there is none.
float value_at(vec3 g) {
  float number = number_at(g);
#ifdef BLENDED
  number = blended_number(number, g);
#endif
  return (number - field.first_number) * field.entries_a_number + field.first_entry;
}

// Where the ray leaves the empty bricks around its point at t; no more than t where none is empty.
// @param map where that of the transfer function begins, along z
float end_of_empty(Ray ray, float t, float map) {
  const float kBrickCells = 8.0;
  vec3 brick = clamp(floor(lattice(point_at(ray, t)) / kBrickCells), vec3(0.0), field.bricks - 1.0);
  float far = float(texelFetch(empty_bricks, ivec3(brick + vec3(0.0, 0.0, map)), 0).x);
  // The nearest brick that is not empty begins `far` bricks away: up to there all are empty.
  vec3 wall = kBrickCells * (brick + mix(vec3(1.0 - far), vec3(far), greaterThan(ray.speed, vec3(0.0))));
#ifdef UNEVEN
  wall = place_of_wall(wall);
#endif
  vec3 leave = (wall - ray.start) * ray.pace;
  return far > 0.0 ? min(leave.x, min(leave.y, leave.z)) : t;
}

// What a stretch of any length shows, from the two layers of the table about its length.
vec4 short_stretch(float front, float back, float first_layer, float stretch) {
  if (isnan(front + back)) return vec4(0.0);
  float place = clamp(stretch / volume.layer_length, 0.0, volume.layer_count - 1.0);
  float below = min(floor(place), volume.layer_count - 2.0);
  return mix(texture(tables, vec3(front, back, first_layer + below)),
             texture(tables, vec3(front, back, first_layer + below + 1.0)), place - below);
}

// The colour of a stretch about g: where the part has those of the voxels, opacities stay those of the table.
vec3 painted(vec4 seen, Part part, vec3 g) {
#ifdef COLORED
  if (part.content == kVoxelColors) return seen.a * texture(colors, (lattice(g) + 0.5) / field.points).rgb;
#endif
  return seen.rgb;
}

// @param g middle of the stretch, `direction` of the ray in N
void gather(vec4 seen, vec3 direction, Part part, vec3 g, inout vec4 gathered) {
  seen.rgb = painted(seen, part, g);
#ifdef SHADED
  seen = shaded(seen, direction, part, g);
#endif
  gathered += (1.0 - gathered.a) * seen;
}

// The layer of the longest length that still takes `samples` a voxel; some room for rounding.
float layer_for(float samples, Ray ray) {
  float layer = floor(1.0 / (samples * length(ray.speed) * volume.layer_length) + 1e-3);
  return clamp(layer, 1.0, volume.layer_count - 1.0);
}

#ifdef FAR
#include "volume/far.glsl"
#endif
#ifdef UNEVEN
#include "volume/uneven_march.glsl"
#elif defined(SLABS)
#include "volume/slab_march.glsl"
#else
// Samples at whole n, between which stretches have the length of a layer.
struct Walk {
  float d;
  float layer;  // of all tables
#ifdef FAR
  float tables;   // where its tables begin, `step` the layer of d there
  float step;
  float stretch;  // samples that the last step went over
#endif
  float n;      // the present sample, and its value
  float front;
  float last;   // the sample at which the walk ends
};

// The last sample that is still in empty bricks; the present one or one before it where none is empty.
float last_empty(Walk walk, Ray ray, float map) { return floor(end_of_empty(ray, walk.n * walk.d, map) / walk.d); }

// Goes to the next sample, over samples up to `inside` in one step; at the last one it stays.
vec4 walk_on(inout Walk walk, Ray ray, float inside) {
#ifdef FAR
  float stride = far_stride(walk.n, walk.d, (volume.layer_count - 1.0) / walk.step);
  float next = min(max(walk.n + stride, inside), walk.last);
  walk.stretch = next - walk.n;
  walk.layer = walk.tables + walk.step * min(walk.stretch, stride);
#else
  float next = min(max(walk.n + 1.0, inside), walk.last);
#endif
  float back = value_at(point_at(ray, next * walk.d));
  bool blank = inside > walk.n || next == walk.n || isnan(walk.front + back);
  vec4 seen = texture(tables, vec3(walk.front, back, walk.layer)) * (blank ? 0.0 : 1.0);
  walk.n = next;
  walk.front = back;
  return seen;
}

// Adds what lies between `from` and `to`, from preintegrated tables.
void march_tables(Ray ray, Part part, float from, float to, inout vec4 gathered) {
  Transfer transfer = volume.transfers[part.transfer];
  float first_layer = float(transfer.first_layer), map = float(transfer.first_brick);
  float layer = layer_for(part.samples, ray);
  Walk walk;
  walk.d = layer * volume.layer_length;
  walk.layer = first_layer + layer;
  walk.n = floor(from / walk.d) + 1.0;
  walk.last = ceil(to / walk.d) - 1.0;
#ifdef FAR
  walk.tables = first_layer;
  walk.step = layer;
  walk.stretch = 1.0;
#endif
  bool leaps = part.samples >= field.samples_to_leap;
#ifdef BLENDED
  leaps = leaps && blended < 0;  // coarser voxels reach into bricks that are empty
#endif

  float t = min(walk.n * walk.d, to);
  walk.front = value_at(point_at(ray, t));
  gather(short_stretch(value_at(point_at(ray, from)), walk.front, first_layer, t - from),
         ray.direction, part, point_at(ray, 0.5 * (from + t)), gathered);

#ifdef SHADED
  while (walk.n < walk.last && gathered.a <= volume.opaque) {
    vec4 seen;
    for (int i = 0; i < 8 && walk.n < walk.last; ++i) {  // light costs most: on to the next stretch that is seen
      seen = walk_on(walk, ray, leaps ? last_empty(walk, ray, map) : walk.n);
      if (seen.a > 0.0) break;
    }
#ifdef FAR
    float middle = walk.n - 0.5 * walk.stretch;
#else
    float middle = walk.n - 0.5;
#endif
    gather(seen, ray.direction, part, point_at(ray, middle * walk.d), gathered);
  }
#else
  // Two loops, as only one that no ray enters takes no time.
  while (leaps && walk.n < walk.last && gathered.a <= volume.opaque) {
    float inside = last_empty(walk, ray, map);
    gather(walk_on(walk, ray, inside), ray.direction, part, vec3(0.0), gathered);
    gather(walk_on(walk, ray, inside), ray.direction, part, vec3(0.0), gathered);
  }
  while (walk.n < walk.last && gathered.a <= volume.opaque) {
    gather(walk_on(walk, ray, walk.n), ray.direction, part, vec3(0.0), gathered);
    gather(walk_on(walk, ray, walk.n), ray.direction, part, vec3(0.0), gathered);
  }
#endif

  if (walk.n == walk.last && gathered.a <= volume.opaque) {
    t = walk.n * walk.d;
    gather(short_stretch(walk.front, value_at(point_at(ray, to)), first_layer, to - t),
           ray.direction, part, point_at(ray, 0.5 * (t + to)), gathered);
  }
}
#endif

#ifdef REGIONS
#include "volume/region_march.glsl"
#endif

// Adds what lies between `from` and `to` in the way of a part.
void march(Ray ray, Part part, float from, float to, inout vec4 gathered) {
#ifdef REGIONS
  if (by_regions(part)) {
    march_regions(ray, part, from, to, gathered);
    return;
  }
#endif
  march_tables(ray, part, from, to, gathered);
}
