#version 450 core
// Fills a preintegrated table (common/render/volume/preintegration.h): one work group makes all segments of k cells and
// one length, in the steps and the order of preintegration.cpp. Sums and products are rounded the same way everywhere;
// nothing is contracted (`precise`), no quotient is taken (the only ones come as cell_lengths), and powers of two are
// built from their bits. So the numbers are those of the processor to the bit; smaller ones than 2^-126, which a GPU may
// take for zero, are below what a table holds.
// ENTRIES: entries of the table an axis.

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Entries { vec4 entries[]; };      // colour c; depth: tau times the longest segment
layout(std430, binding = 1) readonly buffer Lengths { float cell_lengths[]; };  // a of k cells; of k = 0 that of all: k fastest, then lengths
layout(rgba16ui, binding = 0) writeonly uniform uimage2DArray table;          // front entry, back entry, length
layout(location = 0) uniform int first_layer;
layout(location = 1) uniform int group_lengths;  // lengths whose cells are cut into as many parts
layout(location = 2) uniform ivec2 changed;      // first and last entry that segments are made anew for

const int kCells = ENTRIES - 1;
const int kNumbers = 7;  // of a stretch both ways: T, then S from its lower end and from its upper one

// Joined cells: from the beginning of a block of k up to this one, and from this one to its end.
shared float begun[kNumbers * kCells];
shared float rest[kNumbers * kCells];

// exp(-x), as fading() there.
float fading(float x) {
  const float kLog2E = 1.44269504, kRounder = 12582912.0;
  precise float y = -kLog2E * x;
  y = y < -126.0 ? -126.0 : y;
  precise float rounded = y + kRounder;
  precise float f = y - (rounded - kRounder);
  precise float power =
      1.0 + f * (0.693147181 + f * (0.240226507 + f * (0.0555041087 + f * (0.00961812911 + f * (0.00133335581 + f * 0.000154035304)))));
  return intBitsToFloat(floatBitsToInt(power) + (floatBitsToInt(rounded) << 23));
}

// T, and S without the step of the colour, from the lower end and from the upper one of cell i.
vec3 cell_of(int i, float a, float longest_a) {
  const float kDepthOfPart = 0.25, kSixth = 0.16666667163372039794921875;
  const int kMostParts = 64;
  float lower = entries[i].w, upper = entries[i + 1].w;
  precise float depth = longest_a * max(lower, upper);
  int parts = 1;
  float share = 1.0;
  while (parts < kMostParts && depth > kDepthOfPart * float(parts)) {
    parts *= 2;
    share *= 0.5;
  }
  precise float slope = share * (upper - lower);
  precise float through = 1.0, mean_up = 0.0, mean_down = 0.0;
  for (int part = 0; part < parts; ++part) {
    precise float t0 = lower + float(part) * slope;
    precise float t1 = t0 + slope;
    precise float first_depth = a * (share * 0.125 * (3.0 * t0 + t1));
    precise float second_depth = a * (share * 0.125 * (t0 + 3.0 * t1));
    float first = fading(first_depth), second = fading(second_depth);
    precise float both = first * second;
    mean_up = mean_up + through * (1.0 + 4.0 * first + both);
    mean_down = (1.0 + 4.0 * second + both) + both * mean_down;
    through = through * both;
  }
  precise float sixth = share * kSixth;
  mean_up = mean_up * sixth;
  mean_down = mean_down * sixth;
  return vec3(through, mean_up, mean_down);
}

uint part_of(float x) {
  precise float scaled = 65535.0 * clamp(x, 0.0, 1.0) + 0.5;
  return uint(scaled);
}

// (1) of preintegration.h.
void write(int front, int back, int layer, float through, vec3 sum) {
  vec3 near = entries[front].rgb, far = entries[back].rgb;
  precise vec3 color = near - far * through + sum;
  precise float opacity = 1.0 - through;
  imageStore(table, ivec3(front, back, first_layer + layer),
             uvec4(part_of(color.r), part_of(color.g), part_of(color.b), part_of(opacity)));
}

void main() {
  int k = int(gl_WorkGroupID.x), layer = int(gl_WorkGroupID.y), thread = int(gl_LocalInvocationID.x);
  const int kThreads = int(gl_WorkGroupSize.x);
  float a = cell_lengths[ENTRIES * layer + k];
  if (k == 0) {
    for (int i = changed.x + thread; i <= changed.y; i += kThreads) {
      precise float depth = a * entries[i].w;
      write(i, i, layer, fading(depth), vec3(0.0));
    }
    return;
  }
  float longest_a = cell_lengths[ENTRIES * (layer / group_lengths * group_lengths + group_lengths - 1) + k];
  // Segments that meet what changed, from their first cells on, the blocks and all cells that these lie in.
  int first = max(changed.x - k, 0), last = min(changed.y, kCells - k);
  int first_block = first / k, end = last + k;
  for (int i = k * first_block + thread; i < end; i += kThreads) {
    vec3 cell = cell_of(i, a, longest_a);
    precise vec3 color_step = entries[i + 1].rgb - entries[i].rgb;
    begun[i] = rest[i] = cell.x;
    for (int c = 0; c < 3; ++c) {
      precise float up = color_step[c] * cell.y, down = -color_step[c] * cell.z;
      begun[(1 + c) * kCells + i] = rest[(1 + c) * kCells + i] = up;
      begun[(4 + c) * kCells + i] = rest[(4 + c) * kCells + i] = down;
    }
  }
  barrier();

  // Each block of k cells from its beginning on, and from its end back.
  int blocks = (end + k - 1) / k - first_block;
  for (int job = thread; job < 2 * blocks; job += kThreads) {
    int start = k * (first_block + job % blocks), stop = min(start + k, end);
    if (job < blocks) {
      for (int i = start + 1; i < stop; ++i) {
        float near = begun[i - 1], far = begun[i];
        for (int c = 1; c <= 3; ++c) {
          precise float up = begun[c * kCells + i - 1] + near * begun[c * kCells + i];
          precise float down = begun[(3 + c) * kCells + i] + far * begun[(3 + c) * kCells + i - 1];
          begun[c * kCells + i] = up;
          begun[(3 + c) * kCells + i] = down;
        }
        precise float through = near * far;
        begun[i] = through;
      }
    } else {
      for (int i = stop - 2; i >= start; --i) {
        float near = rest[i], far = rest[i + 1];
        for (int c = 1; c <= 3; ++c) {
          precise float up = rest[c * kCells + i] + near * rest[c * kCells + i + 1];
          precise float down = rest[(3 + c) * kCells + i + 1] + far * rest[(3 + c) * kCells + i];
          rest[c * kCells + i] = up;
          rest[(3 + c) * kCells + i] = down;
        }
        precise float through = near * far;
        rest[i] = through;
      }
    }
  }
  barrier();

  // Segments from entry s to s + k, and back: a block, or the rest of one and the beginning of the next.
  for (int s = first + thread; s <= last; s += kThreads) {
    int e = s + k - 1;
    precise float through = begun[e];
    precise vec3 up = vec3(begun[kCells + e], begun[2 * kCells + e], begun[3 * kCells + e]);
    precise vec3 down = vec3(begun[4 * kCells + e], begun[5 * kCells + e], begun[6 * kCells + e]);
    if (s % k != 0) {
      vec3 rest_up = vec3(rest[kCells + s], rest[2 * kCells + s], rest[3 * kCells + s]);
      vec3 rest_down = vec3(rest[4 * kCells + s], rest[5 * kCells + s], rest[6 * kCells + s]);
      up = rest_up + rest[s] * up;
      down = down + through * rest_down;
      through = rest[s] * through;
    }
    write(s, s + k, layer, through, up);
    write(s + k, s, layer, through, down);
  }
}
