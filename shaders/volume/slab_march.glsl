// As march_tables() of volume/march.glsl, for the few steps in a slab: one loop for whole stretches and for those that a
// border cuts short, so that rays that see nothing in the slab cost one step and no more.
// Needs volume/slab.glsl and what march_tables() needs.
void march_tables(Ray ray, Part part, float from, float to, inout vec4 gathered) {
  Transfer transfer = volume.transfers[part.transfer];
  float first_layer = float(transfer.first_layer), map = float(transfer.first_brick);
  float d = layer_for(part.samples, ray) * volume.layer_length;
  stay_in_slab(d, from, to);
  bool leaps = part.samples >= field.samples_to_leap;
  float t = from, front = value_at(point_at(ray, t));
  while (t < to && gathered.a <= volume.opaque) {
    vec4 seen = vec4(0.0);
    float middle = t;
    for (int i = 0; i < 8; ++i) {  // light costs most: on to the next stretch that is seen
      float n = floor(t / d + 1e-3);
      // The last sample that is still in empty bricks.
      float inside = leaps ? floor(end_of_empty(ray, t, map) / d) : n;
      float next = min(max(n + 1.0, inside) * d, to);
      float back = value_at(point_at(ray, next));
      if (!(inside > n)) seen = short_stretch(front, back, first_layer, next - t);
      // As march_tables() has it, to the last bit.
      middle = t == n * d && next == (n + 1.0) * d ? (n + 0.5) * d : 0.5 * (t + next);
      t = next;
      front = back;
      if (seen.a > 0.0 || !(t < to)) break;
    }
    gather(seen, ray.direction, part, point_at(ray, middle), gathered);
  }
}
