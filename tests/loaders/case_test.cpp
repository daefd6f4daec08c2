// EnSight and OpenFOAM cases through the helper program.
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/loaders/case_fixtures.h"

namespace palpate {
namespace {

/// Reads steps forth and back and compares every number with what was written.
void expect_cube_steps(Source& source, const std::vector<int>& steps) {
  for (const int step : steps) {
    SCOPED_TRACE(step);
    const auto blocks = source.read({"velocity", "pressure"}, static_cast<std::size_t>(step));
    ASSERT_EQ(blocks.size(), 1U);
    const auto& mesh = std::get<UnstructuredTopology>(blocks[0].topology);
    ASSERT_EQ(mesh.types, (std::vector<std::uint8_t>{12}));
    ASSERT_EQ(mesh.connectivity, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7}));
    const DataArray* velocity = blocks[0].find("velocity", Association::kPoint);
    ASSERT_NE(velocity, nullptr);
    ASSERT_EQ(velocity->components, 3);
    for (std::size_t corner = 0; corner < 8; ++corner) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(velocity->at(corner, c), test::cube_velocity(corner, step)[static_cast<std::size_t>(c)]);
        EXPECT_EQ(mesh.positions.at(corner, c), test::kCube[corner][static_cast<std::size_t>(c)]);
      }
    }
    const DataArray* pressure = blocks[0].find("pressure", Association::kCell);
    ASSERT_NE(pressure, nullptr);
    EXPECT_EQ(pressure->at(0), 7.0 + step);
  }
}

TEST(Ensight, GoldTextCaseGivesItsStepsOneByOne) {
  const test::TempFolder folder;
  Source source = Source::open({{test::write_ensight_text(folder)}, {}});
  EXPECT_EQ(source.info().format, "EnSight");
  EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 0.5}));
  expect_cube_steps(source, {0, 1, 0});
}

TEST(Ensight, BinaryVariablesOfEitherByteOrderGiveTheirSteps) {
  for (const bool big_endian : {false, true}) {
    SCOPED_TRACE(big_endian);
    const test::TempFolder folder;
    Source source = Source::open({{test::write_ensight_binary_steps(folder, big_endian)}, {}});
    EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 0.5, 2.0}));
    expect_cube_steps(source, {2, 0, 1, 2});
  }
}

// VTK's reader takes what is there of a short variable file.
TEST(Ensight, ATruncatedBinaryVariableIsRefused) {
  const test::TempFolder folder;
  Source source = Source::open({{test::write_ensight_binary_steps(folder, false)}, {}});
  std::filesystem::resize_file(folder.path("b.vel1"), 300);
  EXPECT_NO_THROW((void)source.read({"velocity"}, 0));
  EXPECT_THROW((void)source.read({"velocity"}, 1), Error);
}

TEST(Ensight, BinaryGeometryIsRead) {
  const test::TempFolder folder;
  Source source = Source::open({{test::write_ensight_binary(folder, 8)}, {}});
  EXPECT_EQ(source.info().blocks.at(0).point_count, 8U);
  EXPECT_EQ(source.info().blocks.at(0).cell_count, 1U);
}

TEST(OpenFoam, FolderAndFoamFileGiveTheSameCase) {
  const test::TempFolder folder;
  const auto marker = test::write_openfoam(folder);
  for (const auto& path : {marker, folder.path(), folder.path("system/controlDict")}) {
    SCOPED_TRACE(path);
    Source source = Source::open({{path}, {}});
    EXPECT_EQ(source.info().format, "OpenFOAM");
    EXPECT_EQ(source.info().times, (std::vector<double>{0.0, 0.5}));
    ASSERT_EQ(source.info().blocks.size(), 1U);
    for (const int step : {0, 1}) {
      const auto blocks = source.read({"U"}, static_cast<std::size_t>(step));
      const DataArray* velocity = blocks.at(0).find("U", Association::kCell);
      ASSERT_NE(velocity, nullptr);
      EXPECT_EQ(Vec3(velocity->at(0, 0), velocity->at(0, 1), velocity->at(0, 2)), Vec3(1, 2, 3) + 3.0 * step);
      EXPECT_EQ(std::get<UnstructuredTopology>(blocks[0].topology).types.size(), 1U);
    }
  }
}

}  // namespace
}  // namespace palpate
