// Sparse numbers are those that dense arrays hold, wherever they are read, and no damage leads out of them.
#include "common/field/grid/sparse/sparse_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/grid/sparse/sparse_builder.h"
#include "common/field/grid/sparse/sparse_statistics.h"
#include "common/field/scalar_field.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/sparse_numbers.h"

namespace palpate {
namespace {

constexpr float kBackground = 0.25F;

std::size_t index_in(const Index3& p, const Index3& n) {
  return static_cast<std::size_t>(p.x) +
         static_cast<std::size_t>(n.x) *
             (static_cast<std::size_t>(p.y) + static_cast<std::size_t>(n.y) * static_cast<std::size_t>(p.z));
}

template <typename F>
void for_each_point(const Index3& n, F f) {
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) f(Index3(x, y, z));
    }
  }
}

// Two balls of varied numbers, a box of one other number, a hole of NaN, background elsewhere.
std::vector<float> sample_numbers(const Index3& n) {
  std::vector<float> numbers;
  for_each_point(n, [&](const Index3& p) {
    const Vec3 x(p);
    float v = kBackground;
    if (glm::distance(x, Vec3(9.0, 11.0, 8.0)) < 6.5 || glm::distance(x, Vec3(n) - 4.0) < 7.0)
      v = static_cast<float>(std::sin(0.3 * x.x) + 0.1 * x.y * std::cos(0.2 * x.z));
    if (p.x >= 20 && p.y < 12 && p.z >= 10) v = -3.0F;
    if (p == Index3(9, 10, 11)) v = std::numeric_limits<float>::quiet_NaN();
    numbers.push_back(v);
  });
  return numbers;
}

bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

DataSet block_of(DataArray array, const Index3& points) {
  DataSet block;
  UniformTopology grid;
  grid.points = points;
  grid.origin = {1.0, -2.0, 0.5};
  grid.axes = Mat3(0.5, 0.0, 0.0, 0.0, 0.25, 0.0, 0.0, 0.0, 0.125);
  block.topology = grid;
  array.name = "s";
  block.arrays.push_back(std::move(array));
  return block;
}

DataArray sparse_array(std::shared_ptr<const SparseNumbers> numbers) {
  DataArray array;
  array.tuples = numbers->size();
  array.sparse = std::move(numbers);
  return array;
}

TEST(SparseNumbers, AreThoseOfTheDenseArrayHoweverTheyAreRead) {
  for (const Index3& n : {Index3(33, 29, 41), Index3(8, 24, 16), Index3(1, 40, 3)}) {
    for (const Index3& shift : {Index3(0), Index3(5, 0, 7), Index3(7)}) {
      const std::vector<float> dense = sample_numbers(n);
      const auto sparse = test::make_sparse(dense, n, kBackground, shift);
      ASSERT_EQ(sparse->size(), dense.size());
      SparseReader reader(*sparse);
      for (std::size_t i = 0; i < dense.size(); ++i) ASSERT_TRUE(same((*sparse)[i], dense[i])) << i;
      for_each_point(n, [&](const Index3& p) { ASSERT_TRUE(same(reader.at(p), dense[index_in(p, n)])); });
      const PointBox box{n / 4, n - n / 5};
      std::vector<float> part(box.count());
      sparse->copy(box, part.data());
      std::size_t i = 0;
      for_each_point(box.end - box.first, [&](const Index3& p) {
        ASSERT_TRUE(same(part[i++], dense[index_in(box.first + p, n)]));
      });
    }
  }
}

TEST(SparseNumbers, PartsOfOneNumberCostNothing) {
  // 1024^3 points: one voxel, and a cube of 512^3 of another number than the background.
  SparseBuilder builder(Index3(0), Index3(1024), 0.0F);
  std::array<float, kBlockVoxels> block{};
  block[block_offset({3, 4, 5})] = 1.0F;
  builder.put({100, 90, 80}, block);
  for_each_point(Index3(64), [&](const Index3& b) { builder.put(b, 7.0F); });
  const auto numbers = builder.finish();
  EXPECT_LT(numbers->bytes().size(), 400U << 10U) << "an upper node, a lower one, a leaf";
  SparseReader reader(*numbers);
  EXPECT_EQ(reader.at({803, 724, 645}), 1.0F);
  EXPECT_EQ(reader.at({803, 724, 646}), 0.0F);
  EXPECT_EQ(reader.at({511, 511, 511}), 7.0F);
  EXPECT_EQ(reader.at({512, 511, 511}), 0.0F);
  EXPECT_EQ(reader.at(Index3(1023)), 0.0F);
  const SparseRange range = range_of(*numbers, 2);
  EXPECT_EQ(range.lowest, 0.0);
  EXPECT_EQ(range.highest, 7.0);
  const ValueHistogram histogram = count_values(
      *numbers, [](double v) { return 2.0 * v; }, 0.0, 14.0, 14, 2);
  EXPECT_EQ(histogram.counts[13], std::uint64_t{512} * 512 * 512);
  EXPECT_EQ(histogram.counts[2], 1U);
  EXPECT_EQ(histogram.total, std::uint64_t{1024} * 1024 * 1024);
}

TEST(SparseNumbers, RangesAndHistogramsAreThoseOfTheDenseArray) {
  const Index3 n(33, 29, 41);
  const std::vector<float> dense = sample_numbers(n);
  // What lies beyond the box must not count: a shift leaves background there, which the dense numbers have,
  // too.
  const auto sparse = test::make_sparse(dense, n, kBackground, {3, 0, 6});
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const float v : dense) {
    if (!std::isfinite(v)) continue;
    lowest = std::min(lowest, static_cast<double>(v));
    highest = std::max(highest, static_cast<double>(v));
  }
  const SparseRange range = range_of(*sparse, 2);
  EXPECT_EQ(range.lowest, lowest);
  EXPECT_EQ(range.highest, highest);
  EXPECT_EQ(range.not_finite, 1U);
  EXPECT_FALSE(range.has_infinite);
  const auto expected = count_values(
      dense.size(), [&](std::size_t i) { return static_cast<double>(dense[i]); }, lowest, highest, 64, 1);
  const auto found = count_values(
      *sparse, [](double v) { return v; }, lowest, highest, 64, 2);
  EXPECT_EQ(found.counts, expected.counts);
  EXPECT_EQ(found.total, expected.total);
}

TEST(SparseNumbers, AreMappedOneByOne) {
  const Index3 n(33, 29, 41);
  const std::vector<float> dense = sample_numbers(n);
  const auto mapped = test::make_sparse(dense, n, kBackground)->mapped([](float v) { return 2.0F * v; });
  for (std::size_t i = 0; i < dense.size(); ++i) ASSERT_TRUE(same((*mapped)[i], 2.0F * dense[i]));
}

TEST(SparseNumbers, WhatIsDamagedIsRefusedOrReadWithinItsMemory) {
  const Index3 n(33, 29, 41);
  const auto whole = test::make_sparse(sample_numbers(n), n, kBackground);
  const std::size_t size = whole->bytes().size();
  const auto open = [&](const std::vector<SparseChunk>& chunks, std::size_t bytes, const Index3& points) {
    const auto kept = std::make_shared<std::vector<SparseChunk>>(chunks);
    return SparseNumbers(std::as_bytes(std::span(*kept)).first(bytes), kept, Index3(0), points);
  };
  std::vector<SparseChunk> chunks((size + sizeof(SparseChunk) - 1) / sizeof(SparseChunk));
  std::memcpy(chunks.data(), whole->bytes().data(), size);
  EXPECT_NO_THROW((void)open(chunks, size, n));
  for (const std::size_t cut : {std::size_t{0}, std::size_t{100}, std::size_t{700}, size / 2, size - 1})
    EXPECT_THROW((void)open(chunks, cut, n), std::invalid_argument) << cut;
  EXPECT_THROW((void)open(chunks, size, {0, 1, 1}), std::invalid_argument);
  EXPECT_THROW((void)open(chunks, size, Index3(1 << 20)), std::invalid_argument);

  std::mt19937 random{7};
  int refused = 0;
  constexpr std::size_t kHeads = 1600;  // grid, tree, root and its tile: where offsets and counts are
  for (int round = 0; round < 300; ++round) {
    std::vector<SparseChunk> damaged = chunks;
    auto* bytes = reinterpret_cast<unsigned char*>(damaged.data());
    for (int flip = 0; flip < 4; ++flip)
      bytes[random() % (round % 2 == 0 ? kHeads : size)] = static_cast<unsigned char>(random());
    try {
      const SparseNumbers numbers = open(damaged, size, n);
      double sum = 0.0;
      for (std::size_t i = 0; i < numbers.size(); i += 7) sum += static_cast<double>(numbers[i]);
      EXPECT_NE(sum, 1.25);  // is read
    } catch (const std::invalid_argument&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10);
}

// Fields on sparse numbers, beside those on the same numbers as an array: the same bits, without allocation.
TEST(SparseField, SamplesAndDerivativesAreThoseOfTheDenseOne) {
  const Index3 n(33, 29, 41);
  const std::vector<float> numbers = sample_numbers(n);
  const ScalarChoice choice{.array = "s"};
  const auto dense = make_scalar_field(
      {block_of(make_array("s", Association::kPoint, 1, std::span<const float>(numbers)), n)}, choice,
      "dense");
  const auto sparse = make_scalar_field(
      {block_of(sparse_array(test::make_sparse(numbers, n, kBackground, {2, 5, 0})), n)}, choice, "sparse");
  ASSERT_NE(std::get_if<SparseSpan>(&sparse->values().values), nullptr) << "was made dense";
  EXPECT_EQ(sparse->lowest(), dense->lowest());
  EXPECT_EQ(sparse->highest(), dense->highest());
  EXPECT_EQ(sparse->value_scale(), dense->value_scale());
  EXPECT_EQ(sparse->notes().bad_values, 1U);
  std::mt19937 random{5};
  const Box box = dense->bounds();
  CellHint hint, other;
  const test::AllocationGuard guard;
  for (int i = 0; i < 20000; ++i) {
    const auto part = [&] { return std::uniform_real_distribution<double>{-0.02, 1.02}(random); };
    const Vec3 x = box.lower + box.size() * Vec3(part(), part(), part());
    const ScalarSample a = dense->sample(x, hint), b = sparse->sample(x, other);
    ASSERT_EQ(a.status, b.status);
    ASSERT_EQ(a.value, b.value);
    ASSERT_EQ(dense->gradient(x, hint).value, sparse->gradient(x, other).value);
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate
