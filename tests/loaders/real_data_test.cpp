// Real files through the helper programs. Expected figures: the data's own description (published dimensions
// and value ranges), not the code under test.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/load/load.h"
#include "tests/support/shared_data.h"

namespace palpate {
namespace {

struct Range {
  double lower = HUGE_VAL;
  double upper = -HUGE_VAL;
};

Range range_of(const DataArray& array) {
  Range range;
  for (std::size_t t = 0; t < array.tuples; ++t) {
    for (int c = 0; c < array.components; ++c) {
      range.lower = std::min(range.lower, array.at(t, c));
      range.upper = std::max(range.upper, array.at(t, c));
    }
  }
  return range;
}

std::vector<std::string> names_of(const Source& source) {
  std::vector<std::string> names;
  for (const ArrayInfo& array : source.arrays()) names.push_back(array.name);
  return names;
}

const DataArray& array_of(const DataSet& block, const std::string& name) {
  const DataArray* array = block.find(name, Association::kPoint);
  if (array == nullptr) throw std::runtime_error("no array " + name);
  return *array;
}

TEST(RealData, CarotidIsAnImageWithVectors) {
  PALPATE_NEED_DATA(path, "flow/carotid/carotid.vtk");
  Source source = Source::open({{path}, {}});
  EXPECT_EQ(source.info().format, "legacy VTK");
  ASSERT_EQ(source.info().blocks.size(), 1U);
  EXPECT_EQ(source.info().blocks[0].points, Index3(76, 49, 45));
  EXPECT_EQ(names_of(source), (std::vector<std::string>{"scalars", "vectors"}));

  const auto blocks = source.read({"scalars", "vectors"});
  const auto& grid = std::get<UniformTopology>(blocks.at(0).topology);
  EXPECT_EQ(grid.points, Index3(76, 49, 45));
  EXPECT_EQ(grid.origin, Vec3(100, 80, 1));
  EXPECT_EQ(grid.axes, Mat3(1.0));
  const Range scalars = range_of(array_of(blocks[0], "scalars"));
  EXPECT_EQ(scalars.lower, 0.0);
  EXPECT_EQ(scalars.upper, 580.0);
  const DataArray& vectors = array_of(blocks[0], "vectors");
  EXPECT_EQ(vectors.components, 3);
  EXPECT_EQ(vectors.tuples, 76U * 49U * 45U);
  EXPECT_NEAR(range_of(vectors).lower, -22.6, 0.05);
  EXPECT_NEAR(range_of(vectors).upper, 16.6, 0.05);
}

TEST(RealData, ArraysThatWereNotAskedForStayBehind) {
  PALPATE_NEED_DATA(path, "flow/carotid/carotid.vtk");
  Source source = Source::open({{path}, {}});
  const auto blocks = source.read({"vectors"});
  ASSERT_EQ(blocks.at(0).arrays.size(), 1U);
  EXPECT_EQ(blocks[0].arrays[0].name, "vectors");
}

TEST(RealData, BluntFinIsACurvilinearGridWithMomentum) {
  PALPATE_NEED_DATA(grid, "flow/bluntfin/bluntfinxyz.bin");
  PALPATE_NEED_DATA(solution, "flow/bluntfin/bluntfinq.bin");
  Source source = Source::open({{grid}, solution});
  EXPECT_EQ(source.info().format, "PLOT3D");
  ASSERT_EQ(source.info().blocks.size(), 1U);
  EXPECT_EQ(source.info().blocks[0].points, Index3(40, 32, 32));
  EXPECT_NE(source.info().notes.at(0).find("big endian"), std::string::npos);

  const auto blocks = source.read({"Density", "Momentum", "StagnationEnergy"});
  const auto& topology = std::get<StructuredTopology>(blocks.at(0).topology);
  EXPECT_EQ(topology.points, Index3(40, 32, 32));
  EXPECT_EQ(topology.positions.tuples, 40U * 32U * 32U);
  EXPECT_EQ(array_of(blocks[0], "Momentum").components, 3);
  // Free stream of Mach 2.95 in units of the free stream's density and speed of sound.
  const DataArray& momentum = array_of(blocks[0], "Momentum");
  const DataArray& density = array_of(blocks[0], "Density");
  double fastest = 0.0;
  for (std::size_t p = 0; p < momentum.tuples; ++p) {
    fastest = std::max(fastest,
                       std::hypot(momentum.at(p, 0), momentum.at(p, 1), momentum.at(p, 2)) / density.at(p));
  }
  EXPECT_GT(fastest, 2.9);
  EXPECT_LT(fastest, 3.2);
}

TEST(RealData, DiskIsHexahedraWithNodalVariables) {
  PALPATE_NEED_DATA(path, "flow/disk/disk_out_ref.ex2");
  Source source = Source::open({{path}, {}});
  EXPECT_EQ(source.info().format, "Exodus II");
  const auto blocks = source.read({"Temp", "V"});
  const auto& mesh = std::get<UnstructuredTopology>(blocks.at(0).topology);
  EXPECT_EQ(mesh.positions.tuples, 8499U);
  EXPECT_EQ(mesh.types.size(), 7472U);
  EXPECT_TRUE(
      std::all_of(mesh.types.begin(), mesh.types.end(), [](std::uint8_t type) { return type == 12; }));
  EXPECT_EQ(mesh.connectivity.size(), 8U * 7472U);
  EXPECT_NEAR(range_of(array_of(blocks[0], "Temp")).lower, 293.0, 0.5);
  EXPECT_NEAR(range_of(array_of(blocks[0], "Temp")).upper, 913.0, 0.5);
  EXPECT_EQ(array_of(blocks[0], "V").components, 3);
  EXPECT_EQ(blocks[0].arrays.size(), 2U);
}

TEST(RealData, IronProteinHasTheOldKeywordAspectRatio) {
  PALPATE_NEED_DATA(path, "grid/ironprot/ironProt.vtk");
  Source source = Source::open({{path}, {}});
  const auto blocks = source.read({"scalars"});
  EXPECT_EQ(std::get<UniformTopology>(blocks.at(0).topology).points, Index3(68, 68, 68));
  EXPECT_EQ(blocks[0].arrays.at(0).type, ScalarType::kUint8);
  EXPECT_EQ(range_of(blocks[0].arrays[0]).lower, 0.0);
  EXPECT_EQ(range_of(blocks[0].arrays[0]).upper, 255.0);
}

TEST(RealData, ToothIsBigEndianDetachedNrrd) {
  PALPATE_NEED_DATA(path, "grid/tooth/tooth.nhdr");
  Source source = Source::open({{path}, {}});
  EXPECT_EQ(source.info().loader, "palpate-load-nrrd");
  const auto blocks = source.read(names_of(source));
  EXPECT_EQ(std::get<UniformTopology>(blocks.at(0).topology).points, Index3(103, 94, 161));
  EXPECT_EQ(blocks[0].arrays.at(0).type, ScalarType::kUint16);
  EXPECT_EQ(range_of(blocks[0].arrays[0]).lower, 0.0);
  EXPECT_EQ(range_of(blocks[0].arrays[0]).upper, 1300.0);
}

TEST(RealData, TensorsOfTheHelixAreTurnedIntoRas) {
  PALPATE_NEED_DATA(path, "dtmri/helix-synthetic/helix-DTI.nhdr");
  Source source = Source::open({{path}, {}});
  const auto blocks = source.read(names_of(source));
  const auto& grid = std::get<UniformTopology>(blocks.at(0).topology);
  EXPECT_EQ(grid.points, Index3(64, 32, 16));
  EXPECT_EQ(grid.origin, Vec3(-98.4375, -96.875, -93.75));
  EXPECT_EQ(grid.axes, Mat3(Vec3(3.125, 0, 0), Vec3(0, 6.25, 0), Vec3(0, 0, 12.5)));
  const DataArray& tensors = blocks[0].arrays.at(0);
  ASSERT_EQ(tensors.name, "tensors");
  ASSERT_EQ(tensors.components, 7);
  std::size_t masked = 0;
  for (std::size_t p = 0; p < tensors.tuples; ++p) masked += tensors.at(p, 0) == 1.0 ? 1 : 0;
  EXPECT_EQ(masked, 546U) << "the mask is that of the file";
  // M D M^T of one sample of the bundle, with the header's frame M, computed apart.
  const std::array expected{2.992982964e-03, 3.950930708e-04, 1.313057400e-03,
                            2.159522969e-03, 3.540457460e-04, 1.896487876e-03};
  for (int c = 0; c < 6; ++c) {
    EXPECT_NEAR(tensors.at(29221, c + 1), expected[static_cast<std::size_t>(c)], 2e-9) << c;
  }
}

}  // namespace
}  // namespace palpate
