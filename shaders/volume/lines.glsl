// Axes of uneven steps (common/field/grid/lattice_lines.h): a place m, in mean steps, lies between two points of each
// axis, i at m_i and i + 1, so that g = i + (m - m_i) / (m_i+1 - m_i). A table of equal buckets says where to look for i
// (common/render/volume/voxels/axis_tables.h): there and in the next 2^UNEVEN - 1 cells. Elsewhere g = m.
// Needs the uniform block of volume/volume_block.glsl.
#ifdef UNEVEN
layout(std430, binding = 5) readonly buffer AxisLines { float axis_lines[]; };

bool is_even(int axis) { return field.lines[axis] < 0; }

// Where m of the points of an axis stands.
int first_line(int axis) { return field.lines[axis] + field.buckets[axis]; }

// The first point of the cell about m = place; the outermost ones beyond the ends.
int cell_about(int axis, float place) {
  int buckets = field.buckets[axis], first = first_line(axis), last = int(field.points[axis]) - 2;
  int bucket = clamp(int(place * float(buckets) / float(last + 1)), 0, buckets - 1);
  int low = int(axis_lines[field.lines[axis] + bucket]);
  for (int far = 1 << (UNEVEN - 1); far > 0; far >>= 1) {  // unrolled
    int next = low + far;
    if (next <= last && axis_lines[first + min(next, last)] <= place) low = next;
  }
  return low;
}

// Software rasterisers compute pixels beside the edge of a triangle, too, and have them read zeros from buffers: their rays
// must not go on for ever, as that ends those of their neighbours.
float length_of_cell(int axis, int cell) {
  int last = int(field.points[axis]) - 2, at = first_line(axis) + clamp(cell, 0, last);
  float size = axis_lines[at + 1] - axis_lines[at];
  return size > 0.0 ? size : 1.0;
}

// g of a place in m.
vec3 lattice(vec3 m) {
  vec3 g = m;
  for (int a = 0; a < 3; ++a) {
    if (is_even(a)) continue;
    int cell = cell_about(a, m[a]);
    g[a] = float(cell) + (m[a] - axis_lines[first_line(a) + cell]) / length_of_cell(a, cell);
  }
  return g;
}

// How far in m the places one voxel before and behind are.
void steps_beside(vec3 m, out vec3 before, out vec3 behind) {
  before = vec3(1.0);
  behind = vec3(1.0);
  for (int a = 0; a < 3; ++a) {
    if (is_even(a)) continue;
    int cell = cell_about(a, m[a]);
    float own = length_of_cell(a, cell), part = (m[a] - axis_lines[first_line(a) + cell]) / own;
    before[a] = mix(length_of_cell(a, cell - 1), own, part);
    behind[a] = mix(own, length_of_cell(a, cell + 1), part);
  }
}

// m of a wall of bricks, in g.
vec3 place_of_wall(vec3 g) {
  vec3 m = g;
  for (int a = 0; a < 3; ++a) {
    if (is_even(a)) continue;
    float last = field.points[a] - 1.0;
    int point = int(clamp(g[a], 0.0, last));
    m[a] = axis_lines[first_line(a) + point] + (g[a] - float(point));  // beyond the ends all of it is left
  }
  return m;
}
#else
vec3 lattice(vec3 m) { return m; }
#endif
