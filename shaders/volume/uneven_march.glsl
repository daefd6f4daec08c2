// As march_tables() of volume/march.glsl where steps are uneven: a stretch ends at the next wall between cells, as values
// bend there, and within a cell takes as many samples as it is long for the ray in its own voxels.
// Needs what march_tables() needs, and volume/lines.glsl.

// By how much of t places about a wall are told from it.
float wall_room(float t) { return 2e-6 * max(1.0, abs(t)); }

// Where the stretch that begins at t ends.
float uneven_stop(Ray ray, float t, float samples) {
  float room = wall_room(t), wall = 1e30;
  vec3 at = point_at(ray, t + 2.0 * room), cell_length = vec3(1.0);
  for (int a = 0; a < 3; ++a) {
    if (is_even(a)) continue;
    int cell = cell_about(a, at[a]);
    cell_length[a] = length_of_cell(a, cell);
    float leave = (axis_lines[first_line(a) + cell + (ray.speed[a] > 0.0 ? 1 : 0)] - ray.start[a]) * ray.pace[a] - room;
    if (leave > t + room) wall = min(wall, leave);
  }
  float stretch = min(1.0 / (samples * length(ray.speed / cell_length)), volume.layer_length * (volume.layer_count - 1.0));
  return max(min(t + stretch, wall), t + room);
}

// The value just behind t, in the cell that the ray enters there, where the one at t is none.
float entered_value(Ray ray, float t, float value) {
  return isnan(value) ? value_at(point_at(ray, t + 2.0 * wall_room(t))) : value;
}

// Shorter ones than a layer by their power of it: cells may be a thousandth of others.
vec4 uneven_stretch(float front, float back, float first_layer, float stretch) {
  if (stretch >= volume.layer_length || isnan(front + back)) return short_stretch(front, back, first_layer, stretch);
  vec4 layer = texture(tables, vec3(front, back, first_layer + 1.0));
  float opacity = 1.0 - pow(1.0 - min(layer.a, 0.9999), stretch / volume.layer_length);
  return layer * (layer.a > 0.0 ? opacity / layer.a : 0.0);
}

void march_tables(Ray ray, Part part, float from, float to, inout vec4 gathered) {
  Transfer transfer = volume.transfers[part.transfer];
  float first_layer = float(transfer.first_layer), map = float(transfer.first_brick);
  bool leaps = part.samples >= field.samples_to_leap;
#ifdef BLENDED
  leaps = leaps && blended < 0;
#endif
  float t = from, front = value_at(point_at(ray, t));
  while (t < to && gathered.a <= volume.opaque) {
    vec4 seen = vec4(0.0);
    float middle = t;
    for (int i = 0; i < 8 && t < to; ++i) {  // light costs most: on to the next stretch that is seen
      float inside = leaps ? end_of_empty(ray, t, map) : t;
      float next = min(max(uneven_stop(ray, t, part.samples), inside), to);
      float back = value_at(point_at(ray, next));
      if (!(inside > t)) seen = uneven_stretch(entered_value(ray, t, front), back, first_layer, next - t);
      middle = 0.5 * (t + next);
      t = next;
      front = back;
      if (seen.a > 0.0) break;
    }
    gather(seen, ray.direction, part, point_at(ray, middle), gathered);
  }
}
