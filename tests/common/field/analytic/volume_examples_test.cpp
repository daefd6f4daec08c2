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
