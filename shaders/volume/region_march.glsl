// Marches by value and gradient magnitude (common/render/volume/voxels/region_table.h). A transfer function of both has no
// preintegrated table; between two samples of the ray's lattice, value and magnitude are taken to run linearly, and are
// classified at places so dense that hardly an entry of the table is passed over. With tau l the depth that the table
// holds for the reference length l, a place that stands for a stretch of length h adds
//   C <- C + (1 - A) c (1 - e^-(tau h)),   A <- 1 - (1 - A) e^-(tau h)
// Needs what volume/march.glsl needs, and volume/slope.glsl.

layout(binding = 15) uniform sampler2DArray region_tables;  // colour times depth and depth: value, magnitude, number

struct Sample {
  vec2 entry;  // table coordinates of value and gradient magnitude; NaN where there is no value next to it
  vec3 slope;  // table coordinates a voxel
};

Sample sample_at(vec3 g) {
  vec3 slope = slope_at(g);
  return Sample(vec2(value_at(g), length(slope_in_scene(slope)) * field.rows_a_slope + field.first_row), slope);
}

bool by_regions(Part part) { return volume.transfers[part.transfer].by_regions == 1; }

// What a stretch shows, from end to end. @param table number of the table
vec4 stretch_by_regions(vec2 front, vec2 back, float table, float stretch) {
  const float kEntriesAPlace = 1.5, kMostPlaces = 24.0;
  if (isnan(front.x + front.y + back.x + back.y)) return vec4(0.0);
  vec2 passed = abs(back - front) * vec2(textureSize(region_tables, 0).xy);
  float places = clamp(ceil(max(passed.x, passed.y) / kEntriesAPlace), 1.0, kMostPlaces);
  float depth_scale = stretch / places * field.reference_lengths;
  vec4 seen = vec4(0.0);
  for (float i = 0.5; i < places; ++i) {
    vec4 matter = texture(region_tables, vec3(mix(front, back, i / places), table));
    float opacity = 1.0 - exp(-matter.a * depth_scale);
    seen += (1.0 - seen.a) * (matter.a > 0.0 ? opacity / matter.a : 0.0) * vec4(matter.rgb, matter.a);
  }
  return seen;
}

// Adds what lies between `from` and `to`, on samples at t = n d.
void march_regions(Ray ray, Part part, float from, float to, inout vec4 gathered) {
  Transfer transfer = volume.transfers[part.transfer];
  const float kDenser = 2.0;  // than from preintegrated tables
  float d = layer_for(kDenser * part.samples, ray) * volume.layer_length;
  bool leaps = part.samples >= field.samples_to_leap;
#ifdef BLENDED
  leaps = leaps && blended < 0;
#endif
  float t = from;
  Sample front = sample_at(point_at(ray, t));
  while (t < to && gathered.a <= volume.opaque) {
#ifdef UNEVEN
    float at = t, inside = leaps ? end_of_empty(ray, t, float(transfer.first_brick)) : t;
    float next = min(max(uneven_stop(ray, t, kDenser * part.samples), inside), to);
    if (isnan(front.entry.x)) front = sample_at(point_at(ray, t + 2.0 * wall_room(t)));
#else
    float n = floor(t / d + 1e-3), at = n;
    // The last sample that is still in empty bricks.
    float inside = leaps ? floor(end_of_empty(ray, t, float(transfer.first_brick)) / d) : n;
#ifdef FAR
    float next = min(max(n + far_stride(n, d, 64.0), inside) * d, to);
#else
    float next = min(max(n + 1.0, inside) * d, to);
#endif
#endif
    Sample back = sample_at(point_at(ray, next));
    vec4 seen = vec4(0.0);
    if (!(inside > at)) seen = stretch_by_regions(front.entry, back.entry, float(transfer.first_layer), next - t);
    seen.rgb = painted(seen, part, point_at(ray, 0.5 * (t + next)));
#ifdef SHADED
    seen = looked_at(seen, ray.direction, part, point_at(ray, 0.5 * (t + next)), 0.5 * (front.slope + back.slope));
#endif
    gathered += (1.0 - gathered.a) * seen;
    t = next;
    front = back;
  }
}
