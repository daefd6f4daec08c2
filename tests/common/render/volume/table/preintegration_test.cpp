#include "common/render/volume/table/preintegration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "common/render/gl/context.h"
#include "common/render/volume/table/gpu_preintegration.h"

namespace palpate {
namespace {

using Rgba = std::array<double, 4>;

// (1) by its definition: the trapezoidal rule in double precision, `steps` to a cell.
Rgba integrated(const std::vector<OpticalEntry>& entries, std::size_t front, std::size_t back, double length,
                int steps_of_cell) {
  const auto at = [&](double u) {
    const double s =
        static_cast<double>(front) + u * (static_cast<double>(back) - static_cast<double>(front));
    const auto cell = std::min(static_cast<std::size_t>(s), entries.size() - 2);
    const double part = s - static_cast<double>(cell);
    const OpticalEntry& a = entries[cell];
    const OpticalEntry& b = entries[cell + 1];
    Rgba result{};
    for (int c = 0; c < 3; ++c) {
      result[static_cast<std::size_t>(c)] =
          (1.0 - part) * static_cast<double>(a.color[c]) + part * static_cast<double>(b.color[c]);
    }
    result[3] = (1.0 - part) * static_cast<double>(a.depth) + part * static_cast<double>(b.depth);
    return result;
  };
  const int cells = std::max(std::abs(static_cast<int>(back) - static_cast<int>(front)), 1);
  const int steps = cells * steps_of_cell;
  Rgba sum{};
  double depth = 0.0;
  Rgba before = at(0.0);
  const double h = length / steps;
  for (int i = 1; i <= steps; ++i) {
    const Rgba here = at(static_cast<double>(i) / steps);
    const double next = depth + 0.5 * h * (before[3] + here[3]);
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] += 0.5 * h * (before[3] * before[c] * std::exp(-depth) + here[3] * here[c] * std::exp(-next));
    }
    depth = next;
    before = here;
  }
  sum[3] = 1.0 - std::exp(-depth);
  return sum;
}

struct Table {
  std::size_t count, lengths;
  std::vector<std::uint16_t> rgba;

  Table(const std::vector<OpticalEntry>& entries, std::size_t length_count, int threads = 0)
      : count(entries.size()), lengths(length_count), rgba(4 * count * count * lengths) {
    preintegrate(entries, lengths, threads, rgba);
  }
  Rgba at(std::size_t front, std::size_t back, std::size_t layer) const {
    Rgba result{};
    for (std::size_t c = 0; c < 4; ++c) {
      result[c] = rgba[4 * (front + count * (back + count * layer)) + c] / 65535.0;
    }
    return result;
  }
};

double worst(const Rgba& a, const Rgba& b) {
  double most = 0.0;
  for (std::size_t c = 0; c < 4; ++c) most = std::max(most, std::abs(a[c] - b[c]));
  return most;
}

// Piecewise linear with a corner at every entry, from clear to all but opaque.
std::vector<OpticalEntry> random_entries(std::size_t count, unsigned seed, float deepest) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  std::vector<OpticalEntry> entries(count);
  for (OpticalEntry& e : entries) {
    e.color = {unit(random), unit(random), unit(random)};
    const float u = unit(random);
    e.depth = u < 0.3F ? 0.0F : deepest * u * u * u;
  }
  return entries;
}

TEST(Preintegration, AgreesWithDirectIntegrationOfEverySegment) {
  const auto entries = random_entries(24, 1, 11.0F);
  const Table table(entries, 16);
  double most = 0.0;
  for (std::size_t back = 0; back < 24; ++back) {
    for (std::size_t front = 0; front < 24; ++front) {
      for (const std::size_t layer : {0U, 1U, 7U, 8U, 15U}) {
        const Rgba expected = integrated(entries, front, back, static_cast<double>(layer) / 15.0, 500);
        most = std::max(most, worst(table.at(front, back, layer), expected));
      }
    }
  }
  EXPECT_LT(most, 0.5 / 4096.0);
}

// The size and contents of tables in use: a segment of the largest table among many.
TEST(Preintegration, AgreesWithDirectIntegrationInALargeTable) {
  const auto entries = random_entries(128, 2, 9.0F);
  const Table table(entries, 256);
  std::mt19937 random(3);
  std::uniform_int_distribution<std::size_t> entry(0, 127), length(0, 255);
  double most = 0.0;
  for (int i = 0; i < 400; ++i) {
    const std::size_t front = entry(random), back = entry(random), layer = length(random);
    const Rgba expected = integrated(entries, front, back, static_cast<double>(layer) / 255.0, 500);
    most = std::max(most, worst(table.at(front, back, layer), expected));
  }
  EXPECT_LT(most, 1.0 / 4096.0);
}

// A wall so dense that nothing passes its first part: only the front colour is left.
TEST(Preintegration, ShowsTheFrontOfWhatIsOpaque) {
  std::vector<OpticalEntry> entries(9, {Vec3f(0.2F, 0.4F, 0.6F), 5000.0F});
  entries[8].color = Vec3f(1.0F, 0.0F, 0.0F);
  const Table table(entries, 8);
  for (std::size_t back = 0; back < 8; ++back) {
    EXPECT_LT(worst(table.at(0, back, 7), {0.2, 0.4, 0.6, 1.0}), 1e-4) << back;
  }
  EXPECT_LT(worst(table.at(8, 0, 7), {1.0, 0.0, 0.0, 1.0}), 0.01);
}

TEST(Preintegration, OfNoLengthOrOfClearMatterShowsNothing) {
  const Table dense(random_entries(16, 4, 9.0F), 8);
  const Table clear(std::vector<OpticalEntry>(16, {Vec3f(1.0F), 0.0F}), 8);
  for (std::size_t back = 0; back < 16; ++back) {
    for (std::size_t front = 0; front < 16; ++front) {
      EXPECT_LT(worst(dense.at(front, back, 0), {}), 3e-5);
      EXPECT_LT(worst(clear.at(front, back, 7), {}), 3e-5);
    }
  }
}

// A step between two entries: the bound of the header, against the step itself at 200 times as many entries.
TEST(Preintegration, DrawsAStepBetweenEntriesWithinItsBound) {
  constexpr std::size_t kCoarse = 17, kFine = 3201;  // 200 fine cells to a coarse one
  const auto entry = [](double u) {
    return u < 0.533 ? OpticalEntry{Vec3f(0.9F, 0.1F, 0.3F), 0.0F}
                     : OpticalEntry{Vec3f(0.2F, 0.8F, 0.5F), 2.0F};
  };
  std::vector<OpticalEntry> coarse, fine;
  for (std::size_t i = 0; i < kCoarse; ++i) coarse.push_back(entry(static_cast<double>(i) / (kCoarse - 1)));
  for (std::size_t i = 0; i < kFine; ++i) fine.push_back(entry(static_cast<double>(i) / (kFine - 1)));
  const Table table(coarse, 8);
  double reached = 0.0;
  for (std::size_t back = 0; back < kCoarse; ++back) {
    for (std::size_t front = 0; front < kCoarse; ++front) {
      if (front == back) continue;
      const Rgba expected = integrated(fine, 200 * front, 200 * back, 1.0, 4);
      const double cells = std::abs(static_cast<double>(back) - static_cast<double>(front));
      const double off = worst(table.at(front, back, 7), expected);
      EXPECT_LT(off, 2.0 * 2.0 / cells + 0.002) << front << " " << back;
      reached = std::max(reached, off);
    }
  }
  EXPECT_GT(reached, 0.01);  // the step does matter
}

TEST(Preintegration, DoesNotDependOnTheNumberOfThreads) {
  const auto entries = random_entries(40, 5, 6.0F);
  EXPECT_EQ(Table(entries, 64, 1).rgba, Table(entries, 64, 4).rgba);
}

// `entries` with others from `range.first` to `range.last`.
std::vector<OpticalEntry> changed_in(std::vector<OpticalEntry> entries, const EntryRange& range) {
  for (std::size_t i = range.first; i <= range.last; ++i)
    entries[i] = {Vec3f(0.3F, 0.9F, 0.1F), 0.7F + static_cast<float>(i % 3)};
  return entries;
}

// One entry, some, all; at either end and between.
std::vector<EntryRange> ranges_of(std::size_t count) {
  return {
      {0, 0},        {0, count / 3}, {count / 2, count / 2}, {count / 3, count / 2}, {count - 1, count - 1},
      {0, count - 1}};
}

TEST(Preintegration, MakesSegmentsAnewThatMeetWhatChanged) {
  constexpr std::uint16_t kOld = 12345;  // of no meaning
  for (const std::size_t count : {2U, 3U, 24U, 41U}) {
    const auto before = random_entries(count, 6, 6.0F);
    for (const EntryRange& range : ranges_of(count)) {
      const auto now = changed_in(before, range);
      EXPECT_EQ(changed_entries(before, now), range);
      const Table expected(now, 16);
      Table made = expected;
      std::fill(made.rgba.begin(), made.rgba.end(), kOld);
      preintegrate(now, 16, 1, made.rgba, range);
      std::size_t off = 0, meeting = 0;
      for (std::size_t i = 0; i < made.rgba.size(); ++i) {
        const std::size_t pair = i / 4 % (count * count);
        const bool meets = range.meets(pair % count, pair / count);
        off += made.rgba[i] != (meets ? expected.rgba[i] : kOld) ? 1 : 0;
        meeting += meets ? 1 : 0;
      }
      EXPECT_EQ(off, 0U) << range.first << " to " << range.last << " of " << count;
      EXPECT_NEAR(share_of_segments(range, count),
                  static_cast<double>(meeting) / static_cast<double>(made.rgba.size()), 1e-12);
      // Beside it the table of before is the one of now.
      Table whole(before, 16);
      preintegrate(now, 16, 2, whole.rgba, range);
      EXPECT_EQ(whole.rgba, expected.rgba);
    }
    EXPECT_FALSE(changed_entries(before, before));
  }
}

// The layers from 2 on of a texture that the compute shader fills: with `before`, where there is some, and
// then with what changed.
std::vector<std::uint16_t> filled_by_gpu(GpuPreintegration& gpu, const std::vector<OpticalEntry>& entries,
                                         std::size_t lengths, const std::vector<OpticalEntry>& before = {},
                                         const EntryRange& changed = {}) {
  const auto n = static_cast<GLsizei>(entries.size()), layers = static_cast<GLsizei>(lengths);
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
  const GlTexture table(name);
  glTextureStorage3D(name, 1, GL_RGBA16, n, n, layers + 2);
  const EntryRange all{0, entries.size() - 1};
  if (!before.empty()) gpu.fill(before, lengths, table, 2, all);
  gpu.fill(entries, lengths, table, 2, before.empty() ? all : changed);
  std::vector<std::uint16_t> rgba(4 * entries.size() * entries.size() * lengths);
  glGetTextureSubImage(name, 0, 0, 0, 2, n, n, layers, GL_RGBA, GL_UNSIGNED_SHORT,
                       static_cast<GLsizei>(rgba.size() * sizeof(rgba[0])), rgba.data());
  return rgba;
}

// Clear, deep and opaque matter side by side, ramps and steps; tables of sizes that blocks of cells divide
// and leave over.
TEST(GpuPreintegration, FillsTheTableOfTheProcessorToTheBit) {
  const OffscreenContext context;
  GpuPreintegration gpu;
  struct Size {
    std::size_t count, lengths;
    int functions;
  };
  std::size_t numbers = 0, off = 0;
  for (const Size size : {Size{2, 8, 4}, Size{3, 8, 4}, Size{24, 16, 12}, Size{65, 8, 6}, Size{128, 8, 2}}) {
    for (int seed = 0; seed < size.functions; ++seed) {
      const float deepest =
          std::array{0.01F, 2.0F, 11.0F, 300.0F, 9000.0F}[static_cast<std::size_t>(seed % 5)];
      std::vector<OpticalEntry> entries =
          random_entries(size.count, 7U + static_cast<unsigned>(seed), deepest);
      if (seed % 3 == 2) {  // a step: nothing, then one matter
        for (std::size_t i = 0; i < size.count; ++i)
          entries[i] = i < size.count / 3 ? OpticalEntry{} : OpticalEntry{Vec3f(0.7F, 0.2F, 1.0F), deepest};
      }
      const std::vector<std::uint16_t> expected = Table(entries, size.lengths).rgba;
      const std::vector<std::uint16_t> filled = filled_by_gpu(gpu, entries, size.lengths);
      ASSERT_EQ(filled.size(), expected.size());
      for (std::size_t i = 0; i < filled.size(); ++i) off += filled[i] != expected[i] ? 1 : 0;
      numbers += filled.size();
    }
  }
  EXPECT_EQ(off, 0U) << "of " << numbers;
}

TEST(GpuPreintegration, MakesSegmentsAnewThatMeetWhatChanged) {
  const OffscreenContext context;
  GpuPreintegration gpu;
  for (const std::size_t count : {2U, 3U, 41U}) {
    const auto before = random_entries(count, 6, 6.0F);
    for (const EntryRange& range : ranges_of(count)) {
      const auto now = changed_in(before, range);
      EXPECT_EQ(filled_by_gpu(gpu, now, 8, before, range), Table(now, 8).rgba)
          << range.first << " to " << range.last << " of " << count;
    }
  }
}

TEST(GpuPreintegration, IsPossibleWhereALineOfCellsFitsWhatAWorkGroupShares) {
  const OffscreenContext context;
  EXPECT_TRUE(GpuPreintegration::possible(256));
  EXPECT_TRUE(GpuPreintegration::possible(GpuPreintegration::kMostEntries));
  EXPECT_FALSE(GpuPreintegration::possible(GpuPreintegration::kMostEntries + 1));
}

TEST(TableChoice, TimesBothOnceAndTakesTheFaster) {
  for (const double gpu : {3.0, 30.0}) {
    TableChoice choice;
    EXPECT_EQ(choice.next(TableMaker::kFaster, true, false), TableMaker::kProcessor);
    EXPECT_TRUE(choice.timed());
    choice.filled(18.0);
    EXPECT_EQ(choice.next(TableMaker::kFaster, true, false), TableMaker::kGpu);
    choice.filled(500.0);  // compiles
    EXPECT_EQ(choice.next(TableMaker::kFaster, true, false), TableMaker::kGpu);
    choice.filled(gpu);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(choice.next(TableMaker::kFaster, true, false),
                gpu < 18.0 ? TableMaker::kGpu : TableMaker::kProcessor);
      EXPECT_FALSE(choice.timed());
      choice.filled(1e3);
    }
    EXPECT_NE(choice.text().find("the processor 18.0 ms"), std::string::npos) << choice.text();
  }
}

TEST(TableChoice, LeavesSoftwareRasterisersToTheProcessorUnlessAsked) {
  TableChoice choice;
  EXPECT_EQ(choice.next(TableMaker::kFaster, true, true), TableMaker::kProcessor);
  EXPECT_FALSE(choice.timed());
  EXPECT_NE(choice.text().find("software"), std::string::npos) << choice.text();
  EXPECT_EQ(choice.next(TableMaker::kGpu, true, true), TableMaker::kGpu);
  EXPECT_EQ(choice.next(TableMaker::kProcessor, true, false), TableMaker::kProcessor);
  EXPECT_EQ(choice.next(TableMaker::kGpu, false, false), TableMaker::kProcessor) << "it cannot";
}

TEST(OpticalEntries, SampleTheTransferFunctionForTheLongestSegment) {
  const ColorTransfer transfer({{10.0, Vec3f(0.0F), 0.0}, {20.0, {1.0F, 0.5F, 0.0F}, 0.5}});
  const auto entries = optical_entries(transfer, 10.0, 20.0, 3, 4.0);
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0].depth, 0.0F);
  EXPECT_FLOAT_EQ(entries[1].depth, static_cast<float>(-4.0 * std::log(0.75)));
  EXPECT_FLOAT_EQ(entries[2].color.y, 0.5F);
}

}  // namespace
}  // namespace palpate
