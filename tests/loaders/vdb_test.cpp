// Files that OpenVDB itself has written, read through the helper program.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

constexpr int kSide = 20;
const openvdb::CoordBBox kBox({-3, 5, 7}, {-4 + kSide, 4 + kSide, 6 + kSide});

float value_at(int x, int y, int z) { return std::sin(0.3F * x) + std::cos(0.2F * y) * 0.1F * z; }

// A ball of values in kBox, sheared, turned and moved.
openvdb::FloatGrid::Ptr ball() {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(-9.0F);
  grid->setName("ball");
  auto voxels = grid->getAccessor();
  const Vec3 middle = 0.5 * Vec3(kSide - 1);
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        // Touches each face of the box.
        if (glm::distance(Vec3(x, y, z), middle) < 0.5 * kSide + 0.6)
          voxels.setValue(kBox.min() + openvdb::Coord(x, y, z), value_at(x, y, z));
      }
    }
  }
  openvdb::Mat4d place = openvdb::Mat4d::identity();
  place.setRow(0, {0.5, 0.1, 0.0, 0.0});  // rows: where the axes go
  place.setRow(1, {0.0, 2.0, 0.0, 0.0});
  place.setRow(2, {0.0, 0.3, 1.5, 0.0});
  place.setRow(3, {10.0, 20.0, 30.0, 1.0});
  grid->setTransform(openvdb::math::Transform::createLinearTransform(place));
  return grid;
}

std::filesystem::path write(const test::TempFolder& folder, const std::string& name,
                            const openvdb::GridCPtrVec& grids) {
  const auto file = folder.path(name);
  openvdb::io::File(file.string()).write(grids);
  return file;
}

std::string refusal(const std::filesystem::path& file) {
  try {
    Source source = Source::open({{file}, {}});
    std::vector<std::string> names;
    for (const ArrayInfo& array : source.arrays()) names.push_back(array.name);
    (void)source.read(names);
  } catch (const Error& error) {
    const std::string line = error.what();
    EXPECT_EQ(error.code(), ExitCode::kBadInput) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_NE(line.find(file.string()), std::string::npos) << line;
    return line;
  }
  return {};
}

TEST(Vdb, AGridComesBackAsItsVoxelsWithItsBackgroundAroundThemAtItsPlace) {
  const test::TempFolder folder;
  Source source = Source::open({{write(folder, "a.vdb", {ball()})}, {}});
  EXPECT_EQ(source.info().format, "OpenVDB");
  EXPECT_EQ(source.info().loader, "palpate-load-vdb");
  const DataSet block = source.read({"ball"}).at(0);
  const auto& topology = std::get<UniformTopology>(block.topology);
  ASSERT_EQ(topology.points, Index3(kSide));
  const Vec3 row[3] = {{0.5, 0.1, 0.0}, {0.0, 2.0, 0.0}, {0.0, 0.3, 1.5}};
  for (int a = 0; a < 3; ++a) EXPECT_LT(glm::distance(topology.axes[a], row[a]), 1e-13);
  const Vec3 origin = -3.0 * row[0] + 5.0 * row[1] + 7.0 * row[2] + Vec3(10.0, 20.0, 30.0);
  EXPECT_LT(glm::distance(topology.origin, origin), 1e-12);
  ASSERT_EQ(block.arrays.at(0).type, ScalarType::kFloat32);
  const Vec3 middle = 0.5 * Vec3(kSide - 1);
  std::size_t p = 0;
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x, ++p) {
        const bool inside = glm::distance(Vec3(x, y, z), middle) < 0.5 * kSide + 0.6;
        ASSERT_EQ(block.arrays[0].at(p), inside ? value_at(x, y, z) : -9.0F) << x << " " << y << " " << z;
      }
    }
  }
}

TEST(Vdb, GridsOfOneLatticeAreReadTogetherAndThoseOfAnotherByThemselves) {
  const test::TempFolder folder;
  const auto first = ball();
  auto wind = openvdb::Vec3SGrid::create();
  wind->setName("wind");
  wind->setTransform(first->transform().copy());
  wind->tree().setValue(kBox.min() + openvdb::Coord(0, 0, kSide + 4), {1.0F, 2.0F, 3.0F});
  auto mask = openvdb::BoolGrid::create();
  mask->setName("mask");
  mask->setTransform(first->transform().copy());
  mask->tree().setValue(kBox.min(), true);
  auto coarse = openvdb::DoubleGrid::create();
  coarse->setName("coarse");
  coarse->tree().setValue({0, 0, 0}, 1.0);
  coarse->tree().setValue({2, 1, 3}, 7.0);
  auto drift = openvdb::Vec3DGrid::create();
  drift->setName("drift");
  drift->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
  drift->tree().setValue({4, 4, 4}, {1.0, 2.0, 3.0});
  drift->tree().setValue({6, 7, 8}, {4.0, 5.0, 6.0});
  auto faces = openvdb::Vec3SGrid::create();
  faces->setName("faces");
  faces->setTransform(first->transform().copy());
  faces->setGridClass(openvdb::GRID_STAGGERED);
  faces->tree().setValue({0, 0, 0}, {1.0F, 2.0F, 3.0F});
  auto none = openvdb::Int32Grid::create();
  none->setName("none");
  Source source =
      Source::open({{write(folder, "a.vdb", {first, wind, mask, coarse, drift, faces, none})}, {}});
  std::vector<std::string> names;
  for (const ArrayInfo& array : source.arrays()) names.push_back(array.name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"ball", "coarse", "drift", "mask", "wind"}));
  std::string notes;
  for (const std::string& note : source.info().notes) notes += note + "\n";
  for (const char* said :
       {"grids lie on 3 lattices", "\"faces\" is staggered", "\"none\" has no active voxel"})
    EXPECT_NE(notes.find(said), std::string::npos) << notes;

  std::vector<std::string> lattices;
  for (const BlockInfo& block : source.info().blocks) lattices.push_back(block.name);
  std::sort(lattices.begin(), lattices.end());
  EXPECT_EQ(lattices, (std::vector<std::string>{"ball, wind, mask", "coarse", "drift"}));

  // Each on its own lattice, and nothing of the others.
  const std::vector<DataSet> alone = source.read({"coarse"});
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_EQ(std::get<UniformTopology>(alone[0].topology).points, Index3(3, 2, 4));
  EXPECT_EQ(alone[0].arrays.at(0).at(23), 7.0);
  const std::vector<DataSet> moving = source.read({"drift"});
  ASSERT_EQ(moving.size(), 1U);
  const auto& finer = std::get<UniformTopology>(moving[0].topology);
  EXPECT_EQ(finer.points, Index3(3, 4, 5));
  EXPECT_EQ(finer.origin, Vec3(1.0));
  EXPECT_EQ(finer.axes[1], Vec3(0.0, 0.25, 0.0));
  EXPECT_EQ(moving[0].arrays.at(0).at(59, 2), 6.0);
  EXPECT_EQ(source.read({"coarse", "drift"}).size(), 2U);

  const DataSet block = source.read({"wind", "mask"}).at(0);
  EXPECT_EQ(std::get<UniformTopology>(block.topology).points, Index3(kSide, kSide, kSide + 5));
  const DataArray* vectors = block.find("wind", Association::kPoint);
  ASSERT_EQ(vectors->components, 3);
  const auto there = static_cast<std::size_t>(kSide * kSide * (kSide + 4));
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(vectors->at(there, c), c + 1.0);
    EXPECT_EQ(vectors->at(there - 1, c), 0.0);
  }
  const DataArray* marked = block.find("mask", Association::kPoint);
  EXPECT_EQ(marked->type, ScalarType::kUint8);
  EXPECT_EQ(marked->at(0), 1.0);
  EXPECT_EQ(marked->at(1), 0.0);
}

// A ball of 60 voxels, solid by tiles, in one corner of a box of 1024^3, a voxel in the other: some MB, not
// 4.3 GB.
TEST(Vdb, ASparseGridOfSinglePrecisionStaysSparse) {
  openvdb::initialize();
  const test::TempFolder folder;
  const auto grid = openvdb::FloatGrid::create(0.5F);
  grid->setName("solid");
  grid->sparseFill(openvdb::CoordBBox(openvdb::Coord(-13), openvdb::Coord(47)), 2.0F);
  grid->tree().setValue(openvdb::Coord(1010), 3.0F);
  grid->tree().setValueOff(openvdb::Coord(7, 8, 9), -1.0F);
  Source source = Source::open({{write(folder, "sparse.vdb", {grid})}, {}});
  ASSERT_EQ(source.arrays().size(), 1U);
  EXPECT_GT(source.arrays().front().sparse_bytes, 0U);
  const DataSet block = source.read({"solid"}).at(0);
  const DataArray& array = block.arrays.front();
  ASSERT_NE(array.sparse, nullptr);
  EXPECT_EQ(array.tuples, std::size_t{1} << 30U);
  EXPECT_LT(array.stored_bytes(), std::uint64_t{4} << 20U);
  SparseReader reader(*array.sparse);
  const auto at = [&](int x, int y, int z) { return reader.at(Index3(x, y, z) + 13); };
  EXPECT_EQ(at(-13, -13, -13), 2.0F);
  EXPECT_EQ(at(20, 21, 22), 2.0F);
  EXPECT_EQ(at(47, 47, 47), 2.0F);
  EXPECT_EQ(at(48, 47, 47), 0.5F);
  EXPECT_EQ(at(7, 8, 9), -1.0F) << "values that are not active count as well";
  EXPECT_EQ(at(1010, 1010, 1010), 3.0F);
  EXPECT_EQ(at(1009, 1010, 1010), 0.5F);
  EXPECT_EQ(array.at(array.tuples - 1), 3.0);
}

TEST(Vdb, HalvesPackingsAndLevelSetsAreRead) {
  const test::TempFolder folder;
  const auto grid = ball();
  grid->setSaveFloatAsHalf(true);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  for (const int packing : std::initializer_list<int>{
           openvdb::io::COMPRESS_NONE, openvdb::io::COMPRESS_ZIP, openvdb::io::COMPRESS_BLOSC,
           openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_ZIP}) {
    const auto file = folder.path("p" + std::to_string(packing) + ".vdb");
    openvdb::io::File out(file.string());
    out.setCompression(static_cast<std::uint32_t>(packing));
    out.write(openvdb::GridCPtrVec{grid});
    out.close();
    Source source = Source::open({{file}, {}});
    EXPECT_NE(source.info().notes.at(0).find("level set"), std::string::npos);
    const DataSet block = source.read({"ball"}).at(0);
    const std::size_t at = kSide / 2 + kSide * (kSide / 2 + kSide * 3);
    EXPECT_NEAR(block.arrays.at(0).at(at), value_at(kSide / 2, kSide / 2, 3), 1e-3) << packing;
  }
}

TEST(Vdb, WhatHasNoLinearPlaceOrNoVoxelIsRefused) {
  const test::TempFolder folder;
  const auto grid = ball();
  grid->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd({0.0, 0.0, 0.0}, {10.0, 10.0, 10.0}), 0.5, 10.0));
  EXPECT_NE(refusal(write(folder, "frustum.vdb", {grid})).find("not linear"), std::string::npos);
  EXPECT_NE(refusal(write(folder, "empty.vdb", {openvdb::FloatGrid::create()})).find("no active voxel"),
            std::string::npos);
  // Two voxels far apart are a small file of a box that nothing holds.
  const auto apart = openvdb::FloatGrid::create();
  apart->tree().setValue(openvdb::Coord(-2000000000), 1.0F);
  apart->tree().setValue(openvdb::Coord(2000000000), 1.0F);
  EXPECT_NE(refusal(write(folder, "apart.vdb", {apart})).find("4000000001 x 4000000001 x 4000000001"),
            std::string::npos);
}

// Its table has as many blocks as the box, and most of what NanoVDB parts space into lies beyond it.
TEST(Vdb, ALongThinBoxTakesNoLongerThanItsBlocks) {
  const test::TempFolder folder;
  openvdb::initialize();
  constexpr int kFar = 1 << 28;
  const auto thin = openvdb::FloatGrid::create();
  thin->setName("thin");
  thin->tree().setValue(openvdb::Coord(0), 1.0F);
  thin->tree().setValue(openvdb::Coord(kFar, 0, 0), 2.0F);
  Source source = Source::open({{write(folder, "thin.vdb", {thin})}, {}});
  const DataSet block = source.read({"thin"}).front();
  const DataArray& array = block.arrays.front();
  ASSERT_EQ(array.tuples, std::size_t{kFar} + 1);
  EXPECT_EQ(array.at(0, 0), 1.0);
  EXPECT_EQ(array.at(kFar / 2, 0), 0.0);
  EXPECT_EQ(array.at(kFar, 0), 2.0);
}

TEST(Vdb, GridsAreReadFromWhereTheirHeadsSayThatTheyStand) {
  const test::TempFolder folder;
  const auto second = ball();
  second->setName("second");
  std::string content = test::read_file(write(folder, "two.vdb", {ball(), second}));
  // Bytes of nobody before the second head: where the first grid ends, and all of the second stands, moves by them.
  const std::size_t head = content.find("second") - 4;
  constexpr std::int64_t kMoved = 24;
  const auto offset_at = [&](std::size_t name, std::size_t which) {
    std::size_t at = name;
    for (int text = 0; text < 3; ++text) {  // name, type, parent
      std::uint32_t size = 0;
      std::memcpy(&size, content.data() + at, sizeof(size));
      at += sizeof(size) + size;
    }
    return at + which * sizeof(std::int64_t);
  };
  const auto move = [&](std::size_t at) {
    std::int64_t offset = 0;
    std::memcpy(&offset, content.data() + at, sizeof(offset));
    offset += kMoved;
    std::memcpy(content.data() + at, &offset, sizeof(offset));
  };
  move(offset_at(content.find("ball") - 4, 2));
  for (const std::size_t which : {0, 1, 2}) move(offset_at(head, which));
  content.insert(head, kMoved, '\x7f');
  Source source = Source::open({{folder.write("moved.vdb", content)}, {}});
  const DataSet block = source.read({"ball", "second"}).front();
  ASSERT_EQ(block.arrays.size(), 2U);
  for (const DataArray& array : block.arrays) EXPECT_EQ(array.tuples, std::size_t{kSide * kSide * kSide});
}

TEST(Vdb, FilesCutOffAreRefusedAndDamagedOnesDoNoMoreThanFail) {
  const test::TempFolder folder;
  const std::string whole = test::read_file(write(folder, "a.vdb", {ball()}));
  const auto damaged = [&](const std::string& content) {
    return refusal(folder.write("damaged.vdb", content));
  };
  for (const std::size_t size : {std::size_t{12}, std::size_t{30}, std::size_t{100}, whole.size() / 4,
                                 whole.size() / 2, whole.size() - 1})
    EXPECT_FALSE(damaged(whole.substr(0, size)).empty()) << size;
  // A name as long as a file can say: nothing is made for it.
  std::string long_name = whole;
  const std::size_t name_at = whole.find("ball");
  ASSERT_NE(name_at, std::string::npos);
  long_name.replace(name_at - 4, 4, "\xff\xff\xff\x7f");
  EXPECT_NE(damaged(long_name).find("go on beyond"), std::string::npos) << damaged(long_name);
  // Found by fuzzing: numbers that are not packed, of a size that OpenVDB takes before it looks at it.
  EXPECT_NE(refusal(test::source_folder() / "tests/fuzz/seeds/vdb/beyond_place")
                .find("more numbers than their place holds"),
            std::string::npos);
  std::mt19937 random{7};
  for (int round = 0; round < 6; ++round) {
    std::string content = whole;
    for (int flip = 0; flip < 1 + 3 * round; ++flip)
      content[8 + random() % (content.size() - 8)] = static_cast<char>(random());
    (void)damaged(content);  // a changed value may well be fine
  }
  std::string noise = whole;
  for (std::size_t i = 8; i < noise.size(); ++i) noise[i] = static_cast<char>(random());
  EXPECT_FALSE(damaged(noise).empty());
}

}  // namespace
}  // namespace palpate
