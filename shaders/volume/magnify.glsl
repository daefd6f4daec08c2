// Marches through lenses that enlarge. The ray is bent: it gathers along y(x(t)) of volume/place_seen.glsl, whose own
// length counts, so that matter enlarged is as opaque as it is. (Ikits 2006, sec. 5.7.1, displaces samples across the
// view alone: borders toward the eye jump.)
// Needs volume/volume_block.glsl, volume/ray.glsl, volume/march.glsl and volume/lens_segments.glsl.
#include "volume/place_seen.glsl"

// Adds what lens `i` shows between `from` and `to`, on samples at t = n d. Near its border matter is squeezed by up to
// f'(1) < 2 / (1 - a), and bent stretches are so much longer than straight ones.
void march_magnified(Ray ray, int i, Part part, float from, float to, inout vec4 gathered) {
  const float kSqueezed = 2.0 / (1.0 - kCore);
  float first_layer = float(volume.transfers[part.transfer].first_layer), longest = volume.layer_length * (volume.layer_count - 1.0);
  float d = volume.layer_length * max(1.0, floor(layer_for(part.samples, ray) / kSqueezed));
#ifdef SLABS
  stay_in_slab(d, from, to);
#endif
  float t = from;
  vec3 x = place_seen(i, ray.origin + from * ray.direction);
  while (t < to && gathered.a <= volume.opaque) {
    float next = min((floor(t / d + 1e-3) + 1.0) * d, to);
    vec3 y = place_seen(i, ray.origin + next * ray.direction);
    // The part of the stretch that lies in the volume.
    vec3 g = (field.grid_from_scene * vec4(x, 1.0)).xyz, h = (field.grid_from_scene * vec4(y, 1.0)).xyz;
    vec3 way = h - g, pace = 1.0 / mix(way, vec3(1e-20), lessThan(abs(way), vec3(1e-20)));
    vec3 a = (field.lower - g) * pace, b = (field.upper - g) * pace;
    vec3 near = min(a, b), far = max(a, b);
    vec2 part_in = clamp(vec2(max(near.x, max(near.y, near.z)), min(far.x, min(far.y, far.z))), 0.0, 1.0);
    vec4 seen = vec4(0.0);
    if (part_in.x < part_in.y) {
      float stretch = (part_in.y - part_in.x) * distance(x, y);
      vec3 begin = g + part_in.x * way, end = g + part_in.y * way;
#ifdef REGIONS
      if (by_regions(part)) {
        seen = stretch_by_regions(sample_at(begin).entry, sample_at(end).entry, first_layer, stretch);
      } else
#endif
      {
        seen = short_stretch(value_at(begin), value_at(end), first_layer, stretch);
        // Longer than all of the table: as several of its longest.
        float over = max(1.0, stretch / longest);
        seen *= over > 1.0 && seen.a > 0.0 ? (1.0 - pow(1.0 - seen.a, over)) / seen.a : 1.0;
      }
    }
    gather(seen, ray.direction, part, g + 0.5 * (part_in.x + part_in.y) * way, gathered);
    t = next;
    x = y;
  }
}
