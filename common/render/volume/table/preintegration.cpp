#include "common/render/volume/table/preintegration.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/base/ledger.h"
#include "common/base/parallel.h"

// Wider registers where the processor has them. No fused multiply-add: the same bits everywhere.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define PALPATE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define PALPATE_WIDE
#endif
// Vectors never cross a call that is not inlined: how they would be passed does not matter.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace palpate {
namespace {

// One number for each length of a group.
using Lanes = float __attribute__((vector_size(kLengthGroup * sizeof(float))));
using IntLanes = std::int32_t __attribute__((vector_size(kLengthGroup * sizeof(float))));

[[gnu::always_inline]] inline Lanes all(float x) { return x - Lanes{}; }

// exp(-x) for x >= 0: 2^n 2^f with |f| <= 1/2, relative error below 2e-7. Beyond the smallest normal number
// it stays there.
[[gnu::always_inline]] inline Lanes fading(const Lanes& x) {
  constexpr float kLog2E = 1.44269504F, kRounder = 12582912.0F;  // 1.5 * 2^23: rounds to integers
  Lanes y = -kLog2E * x;
  y = y < -126.0F ? all(-126.0F) : y;
  const Lanes rounded = y + kRounder;
  const Lanes f = y - (rounded - kRounder);
  const Lanes power =
      1.0F +
      f * (0.693147181F +
           f * (0.240226507F +
                f * (0.0555041087F + f * (0.00961812911F + f * (0.00133335581F + f * 0.000154035304F)))));
  return __builtin_bit_cast(
      Lanes, __builtin_bit_cast(IntLanes, power) + (__builtin_bit_cast(IntLanes, rounded) << 23));
}

// What light does on its way through a stretch of cells: (T, S) of the header. Aligned for the widest
// registers, whichever the file is compiled for.
struct alignas(sizeof(Lanes)) Stretch {
  Lanes through;
  Lanes red, green, blue;
};

[[gnu::always_inline]] inline Stretch joined(const Stretch& near, const Stretch& far) {
  return {near.through * far.through, near.red + near.through * far.red,
          near.green + near.through * far.green, near.blue + near.through * far.blue};
}

// A cell seen from its lower end (`up`) and from its upper one (`down`).
struct Cell {
  Stretch up, down;
};

// `a` is the length of the cell in units of the longest segment.
[[gnu::always_inline]] inline Cell make_cell(const OpticalEntry& lower, const OpticalEntry& upper,
                                             const Lanes& a, float longest_a) {
  constexpr float kDepthOfPart = 0.25F;
  constexpr int kMostParts = 64;
  const Vec3f step = upper.color - lower.color;
  const float depth = longest_a * std::max(lower.depth, upper.depth);
  int parts = 1;
  while (parts < kMostParts && depth > kDepthOfPart * static_cast<float>(parts)) parts *= 2;

  Lanes through = all(1.0F), mean_up = all(0.0F), mean_down = all(0.0F);
  const float share = 1.0F / static_cast<float>(parts);
  const float slope = share * (upper.depth - lower.depth);
  for (int part = 0; part < parts; ++part) {
    const float t0 = lower.depth + static_cast<float>(part) * slope, t1 = t0 + slope;
    // Both halves of the part: integrals of a linear function.
    const Lanes first = fading(a * (share * 0.125F * (3.0F * t0 + t1)));
    const Lanes second = fading(a * (share * 0.125F * (t0 + 3.0F * t1)));
    const Lanes both = first * second;
    mean_up += through * (1.0F + 4.0F * first + both);
    mean_down = (1.0F + 4.0F * second + both) + both * mean_down;
    through *= both;
  }
  mean_up *= share / 6.0F;
  mean_down *= share / 6.0F;
  return {{through, step.x * mean_up, step.y * mean_up, step.z * mean_up},
          {through, -step.x * mean_down, -step.y * mean_down, -step.z * mean_down}};
}

// Writes the lengths of one group.
class TableWriter {
 public:
  TableWriter(std::span<const OpticalEntry> entries, std::uint16_t* group)
      : entries_(entries), group_(reinterpret_cast<unsigned char*>(group)), count_(entries.size()) {}

  // (1) for the segments from entry `front` to entry `back`.
  [[gnu::always_inline]] void write(std::size_t front, std::size_t back, const Stretch& s) const {
    const Vec3f& near = entries_[front].color;
    const Vec3f& far = entries_[back].color;
    const IntLanes red = parts_of(near.x - far.x * s.through + s.red);
    const IntLanes green = parts_of(near.y - far.y * s.through + s.green);
    const IntLanes blue = parts_of(near.z - far.z * s.through + s.blue);
    const IntLanes opacity = parts_of(1.0F - s.through);
    const IntLanes low = red | (green << 16), high = blue | (opacity << 16);
    unsigned char* place = group_ + kBytes * (count_ * back + front);
    for (std::size_t l = 0; l < kLengthGroup; ++l) {
      const std::uint64_t both = static_cast<std::uint64_t>(static_cast<std::uint32_t>(high[l])) << 32U |
                                 static_cast<std::uint32_t>(low[l]);
      std::memcpy(place + kBytes * count_ * count_ * l, &both, kBytes);
    }
  }

 private:
  static constexpr std::size_t kBytes = 4 * sizeof(std::uint16_t);

  [[gnu::always_inline]] static IntLanes parts_of(const Lanes& x) {
    Lanes bounded = x < 0.0F ? all(0.0F) : x;
    bounded = bounded > 1.0F ? all(1.0F) : bounded;
    return __builtin_convertvector(65535.0F * bounded + 0.5F, IntLanes);
  }

  std::span<const OpticalEntry> entries_;
  unsigned char* group_;
  std::size_t count_;
};

// All pairs of entries that meet `changed`, for one group of lengths; the longest segment is 1.
PALPATE_WIDE void fill_group(std::span<const OpticalEntry> entries, const float* lengths,
                             const EntryRange& changed, std::vector<Cell>& kept, std::uint16_t* group) {
  const TableWriter writer(entries, group);
  const std::size_t count = entries.size(), cells = count - 1;
  Lanes length;
  std::memcpy(&length, lengths, sizeof length);

  for (std::size_t f = changed.first; f <= changed.last; ++f) {
    const Lanes zero = all(0.0F);
    writer.write(f, f, {fading(length * entries[f].depth), zero, zero, zero});
  }
  for (std::size_t k = 1; k < count; ++k) {
    // Windows from the first to the last one that meets what changed, and their cells.
    const std::size_t first = changed.first > k ? changed.first - k : 0;
    const std::size_t last = std::min(changed.last, cells - k);
    if (first > last) continue;
    const std::size_t begin = first - first % k, end = last + k;
    const Lanes a = length / static_cast<float>(k);
    const float longest_a = lengths[kLengthGroup - 1] / static_cast<float>(k);
    // Blocks of k cells: a window reaches from one block into the next. `kept[r]` joins the cells of the
    // block before from its r-th one to its end; `begun` those of this block up to the present one.
    for (std::size_t start = begin; start < end; start += k) {
      const std::size_t stop = std::min(start + k, end);
      Cell begun{};
      for (std::size_t i = start; i < stop; ++i) {
        const Cell cell = make_cell(entries[i], entries[i + 1], a, longest_a);
        begun = i == start ? cell : Cell{joined(begun.up, cell.up), joined(cell.down, begun.down)};
        const std::size_t r = i - start + 1;
        if (r < k && start > begin && i + 1 >= first + k) {
          const Cell& rest = kept[r];
          writer.write(i + 1 - k, i + 1, joined(rest.up, begun.up));
          writer.write(i + 1, i + 1 - k, joined(begun.down, rest.down));
        }
        kept[r - 1] = cell;  // its place in the list was read a step before
      }
      if (stop - start < k) break;
      if (start >= first) {
        writer.write(start, stop, begun.up);
        writer.write(stop, start, begun.down);
      }
      for (std::size_t r = k - 1; r-- > 0;) {
        kept[r] = {joined(kept[r].up, kept[r + 1].up), joined(kept[r + 1].down, kept[r].down)};
      }
    }
  }
}

}  // namespace

std::vector<OpticalEntry> optical_entries(const ColorTransfer& transfer, double lower, double upper,
                                          std::size_t count, double lengths) {
  std::vector<OpticalEntry> entries;
  entries.reserve(count);
  for (const ColorSample& sample : transfer.table(lower, upper, count)) {
    entries.push_back({sample.color, static_cast<float>(optical_depth(sample.opacity) * lengths)});
  }
  return entries;
}

std::optional<EntryRange> changed_entries(std::span<const OpticalEntry> before,
                                          std::span<const OpticalEntry> now) noexcept {
  const auto differ = std::mismatch(before.begin(), before.end(), now.begin(), now.end());
  if (differ.first == before.end()) return std::nullopt;
  const auto back = std::mismatch(before.rbegin(), before.rend(), now.rbegin(), now.rend());
  return EntryRange{as_size(differ.first - before.begin()), as_size(before.rend() - back.first) - 1};
}

double share_of_segments(const EntryRange& range, std::size_t count) noexcept {
  const auto below = static_cast<double>(range.first), above = static_cast<double>(count - 1 - range.last);
  const auto all = static_cast<double>(count);
  return 1.0 - (below * below + above * above) / (all * all);
}

void preintegrate(std::span<const OpticalEntry> entries, std::size_t lengths, int threads,
                  std::span<std::uint16_t> rgba) {
  PALPATE_CHECK(!entries.empty());
  preintegrate(entries, lengths, threads, rgba, {0, entries.size() - 1});
}

void preintegrate(std::span<const OpticalEntry> entries, std::size_t lengths, int threads,
                  std::span<std::uint16_t> rgba, const EntryRange& changed) {
  PALPATE_CHECK(entries.size() >= 2 && lengths >= kLengthGroup && lengths % kLengthGroup == 0);
  PALPATE_CHECK(changed.first <= changed.last && changed.last < entries.size());
  const std::size_t layer = 4 * entries.size() * entries.size();
  PALPATE_CHECK(rgba.size() == layer * lengths);
  Work work("preintegrated tables", "opacity and colour of a ray's pieces");
  work.takes(rgba.size_bytes());
  parallel_for(lengths / kLengthGroup, threads, [&](std::size_t first, std::size_t last) {
    std::vector<Cell> kept(entries.size());
    for (std::size_t group = first; group < last; ++group) {
      float group_lengths[kLengthGroup];
      for (std::size_t l = 0; l < kLengthGroup; ++l) {
        group_lengths[l] = segment_length(group * kLengthGroup + l, lengths);
      }
      fill_group(entries, group_lengths, changed, kept, rgba.data() + layer * group * kLengthGroup);
    }
  });
}

void classify_fronts(std::span<const OpticalEntry> entries, std::size_t lengths,
                     std::span<std::uint16_t> rgba) {
  const std::size_t count = entries.size();
  PALPATE_CHECK(lengths >= 2 && rgba.size() == 4 * count * count * lengths);
  const auto part_of = [](float x) { return static_cast<std::uint16_t>(std::lround(65535.0F * x)); };
  std::uint16_t* to = rgba.data();
  for (std::size_t l = 0; l < lengths; ++l) {
    for (std::size_t back = 0; back < count; ++back) {
      for (const OpticalEntry& front : entries) {
        const float opacity = 1.0F - std::exp(-segment_length(l, lengths) * front.depth);
        for (int c = 0; c < 3; ++c) *to++ = part_of(opacity * front.color[c]);
        *to++ = part_of(opacity);
      }
    }
  }
}

}  // namespace palpate
