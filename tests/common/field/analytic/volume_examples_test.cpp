#include "common/field/analytic/volume_examples.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/data_set_check.h"

namespace palpate {
namespace {

double value_at(const DataSet& block, int i, int j, int k) {
  const Index3 n = std::get<UniformTopology>(block.topology).points;
  return block.arrays.front().at(static_cast<std::size_t>(i + n.x * (j + n.y * k)));
}

TEST(VolumeExamples, AreWholeBlocksOfTheTypesThatFilesHave) {
  std::vector<ScalarType> types;
  for (const ExampleInfo& info : volume_examples()) {
    if (info.name == "sparse-shells") continue;  // has a test of its own
    const DataSet block = volume_example(info.name);
    EXPECT_NO_THROW(check_block(block, 0, 1, info.name));
    EXPECT_EQ(block.arrays.front().tuples, block.point_count()) << info.name;
    EXPECT_FALSE(info.summary.empty());
    types.push_back(block.arrays.front().type);
  }
  for (const ScalarType type : {ScalarType::kUint8, ScalarType::kUint16, ScalarType::kFloat32})
    EXPECT_NE(std::find(types.begin(), types.end(), type), types.end());
}

TEST(VolumeExamples, AreTheSameEveryTime) {
  for (const ExampleInfo& info : volume_examples()) {
    if (info.name == "sparse-shells") continue;  // made by the same formula; it takes seconds
    const DataSet a = volume_example(info.name);
    const DataSet b = volume_example(info.name);
    EXPECT_TRUE(std::ranges::equal(a.arrays[0].bytes, b.arrays[0].bytes)) << info.name;
  }
}

// On the axis r = 0: rho = cos(2 pi 6) = 1, so s = (1 - sin(pi z / 2) + 0.5) / 2.5.
TEST(VolumeExamples, MarschnerLobbHasItsValuesOnTheAxis) {
  const DataSet block = volume_example("marschner-lobb");
  EXPECT_NEAR(value_at(block, 20, 20, 0), 1.0, 1e-6);
  EXPECT_NEAR(value_at(block, 20, 20, 20), 0.6, 1e-6);
  EXPECT_NEAR(value_at(block, 20, 20, 40), 0.2, 1e-6);
}

TEST(VolumeExamples, ShellsAreCrossedFourTimesFromTheMiddleOut) {
  const DataSet block = volume_example("shells");
  std::vector<double> peaks;
  for (int i = 49; i < 95; ++i) {
    const double here = value_at(block, i, 48, 48);
    if (here > value_at(block, i - 1, 48, 48) && here >= value_at(block, i + 1, 48, 48))
      peaks.push_back(here);
  }
  ASSERT_EQ(peaks.size(), 4U);
  EXPECT_TRUE(std::is_sorted(peaks.rbegin(), peaks.rend()));
}

TEST(VolumeExamples, OneVoxelOfTheEmptyVolumeIsSetAndItIsTheMiddleOne) {
  const DataSet block = volume_example("voxel");
  double sum = 0.0;
  for (std::size_t p = 0; p < block.arrays[0].tuples; ++p) sum += block.arrays[0].at(p);
  EXPECT_EQ(sum, 255.0);
  EXPECT_EQ(value_at(block, 16, 16, 16), 255.0);
}

// 1024^3 points, 4.3 GB one by one. On the way out along a diagonal of the cube the pattern of holes of shell
// i has cos and sin of a = 5 / sqrt(3), and stands at 3 sin(a + i) cos(a).
TEST(VolumeExamples, SparseShellsTakeTheMemoryOfTheirShells) {
  const DataSet block = volume_example("sparse-shells");
  EXPECT_NO_THROW(check_block(block, 0, 1, "sparse-shells"));
  const DataArray& array = block.arrays.front();
  ASSERT_NE(array.sparse, nullptr);
  EXPECT_EQ(array.tuples, std::size_t{1} << 30U);
  EXPECT_LT(array.stored_bytes(), std::uint64_t{400} << 20U);
  SparseReader reader(*array.sparse);
  const double a = 5.0 / std::sqrt(3.0);
  for (int shell = 0; shell < 6; ++shell) {
    const double radius = 0.96 * (shell + 1) / 6.0,
                 part = std::clamp(0.5 + 12.0 * std::sin(a + shell) * std::cos(a), 0.0, 1.0);
    double most = 0.0;
    for (int i = 512; i < 1024; ++i) {
      const double off = std::abs(std::sqrt(3.0) * (2.0 * i / 1023.0 - 1.0) - radius) * 1023.0 / 4.0;
      const double expected = (1.0 - 0.12 * shell) * part * std::max(0.0, 1.0 - off);
      const double here = static_cast<double>(reader.at(Index3(i)));
      if (off < 8.0) {
        EXPECT_NEAR(here, expected, 1e-5) << shell << " " << i;
      }
      most = std::max(most, expected);
    }
    if (part > 0.0) {
      EXPECT_GT(most, 0.0) << shell;
    }
  }
}

TEST(VolumeExamples, AnUnknownNameListsTheKnownOnes) {
  try {
    (void)volume_example("tornado");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    for (const ExampleInfo& info : volume_examples())
      EXPECT_NE(std::string(error.what()).find(info.name), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate
