// Marches along a part of a ray, front to back, on samples at t = n d (volume_pass.h). A stretch between two
// samples, their values taken as the ends of a linear course, adds what the table of its length holds:
//   C <- C + (1 - A) C_table,   A <- A + (1 - A) A_table
// Needs volume/volume_block.glsl and volume/ray.glsl, and shaded() where rays are shaded.

// Table coordinate of the value at g; NaN where there is none.
float value_at(vec3 g) {
  return (texture(voxels, (g + 0.5) / volume.points.xyz).x - volume.lower.w) * volume.upper.w + volume.points.w;
}

// Where the ray leaves the empty bricks around its point at t; t itself where none is empty.
float end_of_empty(Ray ray, float t, float map) {
  const float kBrickCells = 8.0, kBeyond = 1e30;
  vec3 count = volume.bricks.xyz;
  vec3 brick = clamp(floor((ray.start + t * ray.speed) / kBrickCells), vec3(0.0), count - 1.0);
  float far = float(texelFetch(empty_bricks, ivec3(brick + vec3(0.0, 0.0, map * count.z)), 0).x);
  if (far == 0.0) return t;
  // The nearest brick that is not empty begins `far` bricks away: up to there all are empty, and nothing lies
  // outside the volume.
  vec3 lower = brick - (far - 1.0), upper = brick + far;
  vec3 low = mix(lower * kBrickCells, vec3(-kBeyond), lessThanEqual(lower, vec3(0.0)));
  vec3 high = mix(upper * kBrickCells, vec3(kBeyond), greaterThanEqual(upper, count));
  vec3 wall = mix(low, high, greaterThan(ray.speed, vec3(0.0)));
  vec3 speed = mix(ray.speed, vec3(1e-30), lessThan(abs(ray.speed), vec3(1e-30)));
  vec3 leave = mix((wall - ray.start) / speed, vec3(kBeyond), lessThan(abs(ray.speed), vec3(1e-30)));
  return max(t, min(leave.x, min(leave.y, leave.z)));
}

// A stretch of any length from the two layers about it.
vec4 short_stretch(vec2 ends, float first_layer, float stretch) {
  float place = min(stretch / volume.lengths.x, volume.lengths.y - 1.0);
  float below = min(floor(place), volume.lengths.y - 2.0);
  return mix(texture(tables, vec3(ends, first_layer + below)), texture(tables, vec3(ends, first_layer + below + 1.0)),
             place - below);
}

// Adds what lies between `from` and `to`.
void march(Ray ray, vec4 part, float from, float to, inout vec4 gathered) {
  const int kMostSteps = 65536;
  float first_layer = part.x * volume.lengths.y;
  // The longest length of the table that still takes `part.y` samples a voxel; some room for rounding.
  float layer = floor(1.0 / (part.y * length(ray.speed) * volume.lengths.x) + 1e-3);
  layer = clamp(layer, 1.0, volume.lengths.y - 1.0);
  float d = layer * volume.lengths.x;

  float n = floor(from / d) + 1.0;
  float t = from;
  float front = value_at(ray.start + t * ray.speed);
  bool clear = volume.bricks.w > 0.5;
  for (int i = 0; i < kMostSteps && t < to; ++i) {
    if (clear) {
      float leave = end_of_empty(ray, t, part.x);
      if (leave >= to) return;
      float inside = floor(leave / d);  // the last sample that is still in empty bricks
      if (inside >= n) {
        n = inside + 1.0;
        t = inside * d;
        front = value_at(ray.start + t * ray.speed);
      }
    }
    float next = min(n * d, to);
    float back = value_at(ray.start + next * ray.speed);
    vec4 seen = vec4(0.0);
    if (!isnan(front + back)) {
      vec2 ends = vec2(front, back);
      seen = abs(next - t - d) < 1e-3 * d ? texture(tables, vec3(ends, first_layer + layer))
                                          : short_stretch(ends, first_layer, next - t);
    }
    clear = seen.a == 0.0 && volume.bricks.w > 0.5;
#ifdef SHADED
    if (part.z > 0.5 && seen.a > 0.0) seen.rgb = shaded(seen, ray, 0.5 * (t + next));
#endif
    gathered += (1.0 - gathered.a) * seen;
    if (gathered.a > volume.lengths.z) return;
    t = next;
    n += 1.0;
    front = back;
  }
}
