// Lines that would take more memory than they may: which seeds are left, and that nothing else changes.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/trace/trace.h"
#include "tests/common/trace/linear_fields.h"

namespace palpate::test {
namespace {

constexpr std::size_t kSeeds = 1500;
// That may be begun before what they take is known.
constexpr std::uint64_t kBatch = 64;

std::uint64_t bytes_of(const std::vector<Line>& lines) {
  std::uint64_t bytes = sizeof(Line) * lines.size();
  for (const Line& line : lines) bytes += sizeof(LinePoint) * line.points.size();
  return bytes;
}

// Circles about the z axis, longer ones outside.
class MemoryOfLines : public ::testing::Test {
 protected:
  MemoryOfLines() {
    for (std::size_t i = 0; i < kSeeds; ++i)
      seeds_.emplace_back(0.1 + 0.8 * static_cast<double>(i) / kSeeds, 0.0, 0.0);
    options_.tolerance = 1e-5;
  }
  [[nodiscard]] TraceResult trace(std::uint64_t memory, int threads) {
    options_.memory = memory;
    options_.threads = threads;
    return trace_lines(*field_, seeds_, options_);
  }

  std::shared_ptr<const VectorField> field_ =
      make_vector_field(std::make_shared<LinearField>(rows(0, -1, 0, 1, 0, 0, 0, 0, 0), Vec3{0.0}));
  std::vector<Vec3> seeds_;
  TraceOptions options_;
};

TEST_F(MemoryOfLines, SeedsBeyondItBeginNoneAndTheOthersAreSpreadOverAll) {
  const TraceResult all = trace(0, 2);
  ASSERT_EQ(all.lines.size(), kSeeds);
  EXPECT_EQ(all.seeds_left_out, 0U);
  const std::uint64_t memory = bytes_of(all.lines) / 4;
  std::vector<std::uint32_t> kept_before;
  for (const int threads : {1, 3}) {
    const TraceResult part = trace(memory, threads);
    EXPECT_EQ(part.lines.size() + part.seeds_left_out, kSeeds);
    EXPECT_TRUE(part.outside_seeds.empty()) << "those that were not begun are not outside";
    const std::uint64_t bytes = bytes_of(part.lines), most = bytes_of(all.lines) * 2 * kBatch / kSeeds;
    EXPECT_GE(bytes, memory);
    EXPECT_LE(bytes, memory + most);
    std::vector<std::uint32_t> kept;
    std::uint32_t gap = 0;
    for (const Line& line : part.lines) {
      gap = std::max(gap, line.seed - (kept.empty() ? 0 : kept.back()));
      kept.push_back(line.seed);
      const Line& same = all.lines[line.seed];
      ASSERT_EQ(line.points.size(), same.points.size());
      EXPECT_EQ(line.points.back().position, same.points.back().position);
    }
    EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
    EXPECT_LE(gap, 12U) << "every fourth on average, evenly";
    if (threads == 1) kept_before = kept;
    EXPECT_EQ(kept, kept_before) << "whatever the threads";
  }
}

TEST_F(MemoryOfLines, EnoughOfItChangesNothing) {
  const TraceResult all = trace(0, 2), enough = trace(std::uint64_t{1} << 40, 2);
  EXPECT_EQ(enough.seeds_left_out, 0U);
  ASSERT_EQ(enough.lines.size(), all.lines.size());
  EXPECT_EQ(enough.points, all.points);
  EXPECT_EQ(enough.steps, all.steps);
  for (std::size_t i = 0; i < all.lines.size(); ++i) EXPECT_EQ(enough.lines[i].seed, all.lines[i].seed);
}

TEST_F(MemoryOfLines, TheFirstSeedsAreBegunHoweverLittleThereIs) {
  const TraceResult few = trace(1, 2);
  EXPECT_EQ(few.lines.size(), kBatch);
  EXPECT_EQ(few.seeds_left_out, kSeeds - kBatch);
}

}  // namespace
}  // namespace palpate::test
