// VTKHDF written as its specification says: images, meshes in parts, levels, collections, all of them in time.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/loaders/hdf5_file.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

using Whole = std::vector<std::int64_t>;

std::string refusal(const std::string& bytes) {
  const TempFolder folder;
  try {
    Source source = Source::open({{folder.write("a.vtkhdf", bytes)}, {}});
    const std::size_t steps = std::max<std::size_t>(source.info().times.size(), 1);
    for (std::size_t s = 0; s < steps; ++s) (void)source.read({"u"}, s);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  ADD_FAILURE() << "was accepted";
  return {};
}

bool says(const std::vector<std::string>& notes, const std::string& words) {
  for (const std::string& note : notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

void begin(const Hdf5File& file, const std::string& path, const std::string& type, Whole version = {2, 0}) {
  file.group(path);
  file.attribute(path, "Version", version);
  file.word(path, "Type", type, type.size());
}

void steps(const Hdf5File& file, const std::string& path, const std::vector<double>& times) {
  file.group(path + "/Steps");
  file.attribute(path + "/Steps", "NSteps", Whole{static_cast<std::int64_t>(times.size())});
  file.set(path + "/Steps/Values", times);
}

// --- images -----------------------------------------------------------------------------------------------

struct Image {
  Whole extent{2, 5, -1, 1, 0, 1};  // 4 x 3 x 2 points
  std::vector<double> direction{0, -1, 0, 1, 0, 0, 0, 0, 1};
};

void image_head(const Hdf5File& file, const std::string& path, const Image& image) {
  begin(file, path, "ImageData");
  file.attribute(path, "WholeExtent", image.extent);
  file.attribute(path, "Origin", std::vector<double>{10.0, 20.0, 30.0});
  file.attribute(path, "Spacing", std::vector<double>{0.5, 1.0, 2.0});
  file.attribute(path, "Direction", image.direction);
}

std::vector<float> counted(std::size_t count, float from = 0.0F) {
  std::vector<float> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(from + static_cast<float>(i));
  return out;
}

TEST(VtkHdf, ImagesLieWhereExtentAndDirectionSayWithValuesOfPointsAndCells) {
  const Hdf5File file;
  image_head(file, "/VTKHDF", {});
  file.group("/VTKHDF/PointData");
  file.group("/VTKHDF/CellData");
  file.set("/VTKHDF/PointData/u", counted(72), {2, 3, 4, 3});
  file.set("/VTKHDF/CellData/c", counted(6), {1, 2, 3});
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.vtkhdf", file.bytes())}, {}});
  const auto blocks = source.read({"u", "c"});
  const auto& grid = std::get<UniformTopology>(blocks.at(0).topology);
  EXPECT_EQ(grid.points, (Index3{4, 3, 2}));
  EXPECT_EQ(grid.axes[0], (Vec3{0.0, 0.5, 0.0}));
  EXPECT_EQ(grid.axes[1], (Vec3{-1.0, 0.0, 0.0}));
  EXPECT_EQ(grid.origin, (Vec3{11.0, 21.0, 30.0}));
  const DataArray* const u = blocks[0].find("u", Association::kPoint);
  const DataArray* const c = blocks[0].find("c", Association::kCell);
  ASSERT_NE(u, nullptr);
  ASSERT_NE(c, nullptr);
  EXPECT_EQ(u->components, 3);
  for (std::size_t p = 0; p < 24; ++p) EXPECT_EQ(u->at(p, 2), 3.0 * static_cast<double>(p) + 2.0);
  for (std::size_t p = 0; p < 6; ++p) EXPECT_EQ(c->at(p), static_cast<double>(p));
}

TEST(VtkHdf, ImagesInTimeHaveTheirStepsBehindOffsetsOrInOrder) {
  const Hdf5File file;
  image_head(file, "/VTKHDF", {});
  file.group("/VTKHDF/PointData");
  // Three steps of two states that come again, a scalar in order, and one that does not change.
  std::vector<float> two = counted(72), later = counted(72, 500.0F);
  two.insert(two.end(), later.begin(), later.end());
  file.set("/VTKHDF/PointData/u", two, {2, 2, 3, 4, 3});
  file.set("/VTKHDF/PointData/s", counted(72), {3, 2, 3, 4});
  file.set("/VTKHDF/PointData/still", counted(24), {2, 3, 4});
  steps(file, "/VTKHDF", {0.5, 1.5, 4.0});
  file.group("/VTKHDF/Steps/PointDataOffsets");
  file.set("/VTKHDF/Steps/PointDataOffsets/u", Whole{0, 1, 0});
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.vtkhdf", file.bytes())}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{0.5, 1.5, 4.0}));
  for (std::size_t step = 0; step < 3; ++step) {
    const auto blocks = source.read({"u", "s", "still"}, step);
    EXPECT_EQ(blocks.at(0).find("u", Association::kPoint)->at(1, 0), step == 1 ? 503.0 : 3.0) << step;
    EXPECT_EQ(blocks[0].find("s", Association::kPoint)->at(5), 24.0 * static_cast<double>(step) + 5.0);
    EXPECT_EQ(blocks[0].find("still", Association::kPoint)->at(5), 5.0);
  }
}

TEST(VtkHdf, ArraysThatDoNotFitTheirImageAreRefused) {
  const Hdf5File file;
  image_head(file, "/VTKHDF", {});
  file.group("/VTKHDF/PointData");
  file.set("/VTKHDF/PointData/u", counted(24), {4, 3, 2});
  EXPECT_NE(refusal(file.bytes()).find("'VTKHDF/PointData/u': does not have the counts of its image"),
            std::string::npos);
}

// --- meshes -----------------------------------------------------------------------------------------------

/// A row of tetrahedra, each with points of its own, moved along x.
struct Row {
  std::int64_t cells = 1;
  double at = 0.0;
};

/// Parts behind one another in the sets of a mesh.
struct Stored {
  Whole points, cells, corners, offsets, connectivity;
  std::vector<std::uint8_t> types;
  std::vector<double> places, flows, marks;

  void add(const Row& row) {
    points.push_back(4 * row.cells);
    cells.push_back(row.cells);
    corners.push_back(4 * row.cells);
    offsets.push_back(0);
    for (std::int64_t c = 0; c < row.cells; ++c) {
      offsets.push_back(4 * (c + 1));
      types.push_back(10);
      marks.push_back(row.at + static_cast<double>(c));
      for (std::int64_t corner = 0; corner < 4; ++corner) {
        connectivity.push_back(4 * c + corner);
        const Vec3 x{row.at + static_cast<double>(2 * c) + (corner == 1 ? 1.0 : 0.0), corner == 2 ? 1.0 : 0.0,
                     corner == 3 ? 1.0 : 0.0};
        places.insert(places.end(), {x.x, x.y, x.z});
        const Vec3 u = flow_at(x);
        flows.insert(flows.end(), {u.x, u.y, u.z});
      }
    }
  }
  void write(const Hdf5File& file, const std::string& path) const {
    file.set(path + "/NumberOfPoints", points);
    file.set(path + "/NumberOfCells", cells);
    file.set(path + "/NumberOfConnectivityIds", corners);
    file.set(path + "/Points", places, {places.size() / 3, 3});
    file.set(path + "/Offsets", offsets);
    file.set(path + "/Connectivity", connectivity);
    file.set(path + "/Types", types);
    file.group(path + "/PointData");
    file.group(path + "/CellData");
    file.set(path + "/PointData/u", flows, {flows.size() / 3, 3});
    file.set(path + "/CellData/mark", marks);
  }
};

void mesh_steps(const Hdf5File& file, const std::string& path, const std::vector<double>& times,
                const Whole& parts, const Whole& points, const Whole& cells, const Whole& corners,
                const Whole& count = {}) {
  steps(file, path, times);
  file.set(path + "/Steps/PartOffsets", parts);
  file.set(path + "/Steps/PointOffsets", points);
  file.set(path + "/Steps/CellOffsets", cells, {cells.size(), 1});
  file.set(path + "/Steps/ConnectivityIdOffsets", corners, {corners.size(), 1});
  if (!count.empty()) file.set(path + "/Steps/NumberOfParts", count);
}

/// The blocks at a step are those rows, with the flow at their points.
void expect_rows(Source& source, std::size_t step, const std::vector<Row>& rows, double faster = 0.0) {
  const auto blocks = source.read({"u", "mark"}, step);
  ASSERT_EQ(blocks.size(), rows.size()) << step;
  for (std::size_t b = 0; b < rows.size(); ++b) {
    const auto& mesh = std::get<UnstructuredTopology>(blocks[b].topology);
    ASSERT_EQ(mesh.types.size(), static_cast<std::size_t>(rows[b].cells)) << step;
    const DataArray* const u = blocks[b].find("u", Association::kPoint);
    const DataArray* const mark = blocks[b].find("mark", Association::kCell);
    ASSERT_TRUE(u != nullptr && mark != nullptr);
    for (std::size_t c = 0; c < mesh.types.size(); ++c) {
      EXPECT_EQ(mark->at(c), rows[b].at + static_cast<double>(c));
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const auto p =
            static_cast<std::size_t>(mesh.connectivity[static_cast<std::size_t>(mesh.offsets[c]) + corner]);
        const Vec3 x{mesh.positions.at(p, 0), mesh.positions.at(p, 1), mesh.positions.at(p, 2)};
        EXPECT_EQ(x.x, rows[b].at + 2.0 * static_cast<double>(c) + (corner == 1 ? 1.0 : 0.0)) << step;
        EXPECT_EQ(u->at(p, 0), flow_at(x).x + faster) << step;
      }
    }
  }
}

TEST(VtkHdf, AMeshThatChangesFromStepToStepIsThatOfItsStep) {
  const Hdf5File file;
  begin(file, "/VTKHDF", "UnstructuredGrid");
  Stored stored;
  const std::vector<Row> rows{{1, 0.0}, {3, 5.0}, {2, -7.0}};
  for (const Row& row : rows) stored.add(row);
  stored.write(file, "/VTKHDF");
  mesh_steps(file, "/VTKHDF", {0.0, 0.25, 1.0}, {0, 1, 2}, {0, 4, 16}, {0, 1, 4}, {0, 4, 16});
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.vtkhdf", file.bytes())}, {}});
  EXPECT_EQ(source.info().times.size(), 3U);
  for (std::size_t step = 0; step < 3; ++step) expect_rows(source, step, {rows[step]});
}

TEST(VtkHdf, TwoPartsAStepStayTwo) {
  const Hdf5File file;
  begin(file, "/VTKHDF", "UnstructuredGrid");
  Stored stored;
  const std::vector<Row> rows{{1, 0.0}, {2, 50.0}, {3, 1.0}, {1, 60.0}};
  for (const Row& row : rows) stored.add(row);
  stored.write(file, "/VTKHDF");
  mesh_steps(file, "/VTKHDF", {0.0, 1.0}, {0, 2}, {0, 12}, {0, 3}, {0, 12}, {2, 2});
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.vtkhdf", file.bytes())}, {}});
  expect_rows(source, 0, {rows[0], rows[1]});
  expect_rows(source, 1, {rows[2], rows[3]});
}

// A mesh that stays is stored once; its values are behind offsets. Writers differ in whether its counts stand there
// once or for each step.
TEST(VtkHdf, AMeshThatStaysHasTheValuesOfItsStep) {
  for (const bool counts_of_each_step : {false, true}) {
    const Hdf5File file;
    begin(file, "/VTKHDF", "UnstructuredGrid");
    Stored stored;
    const Row row{2, 3.0};
    stored.add(row);
    std::vector<double> faster = stored.flows;
    for (double& value : faster) value += 100.0;
    stored.flows.insert(stored.flows.end(), faster.begin(), faster.end());
    if (counts_of_each_step) {
      stored.points.push_back(8);
      stored.cells.push_back(2);
      stored.corners.push_back(8);
    }
    stored.write(file, "/VTKHDF");
    mesh_steps(file, "/VTKHDF", {0.0, 2.0}, {0, counts_of_each_step ? 1 : 0}, {0, 0}, {0, 0}, {0, 0});
    file.group("/VTKHDF/Steps/PointDataOffsets");
    file.set("/VTKHDF/Steps/PointDataOffsets/u", Whole{0, 8});
    const TempFolder folder;
    Source source = Source::open({{folder.write("a.vtkhdf", file.bytes())}, {}});
    expect_rows(source, 0, {row});
    expect_rows(source, 1, {row}, 100.0);
  }
}

TEST(VtkHdf, PolyhedraHaveTheirFaces) {
  const Hdf5File file;
  begin(file, "/VTKHDF", "UnstructuredGrid", {2, 5});
  Stored stored;
  stored.add({2, 0.0});
  stored.types[1] = 42;
  stored.write(file, "/VTKHDF");
  file.set("/VTKHDF/NumberOfFaces", Whole{4});
  file.set("/VTKHDF/NumberOfFaceConnectivityIds", Whole{12});
  file.set("/VTKHDF/NumberOfPolyhedronToFaceIds", Whole{4});
  file.set("/VTKHDF/FaceConnectivity", Whole{4, 5, 6, 4, 5, 7, 5, 6, 7, 4, 6, 7});
  file.set("/VTKHDF/FaceOffsets", Whole{0, 3, 6, 9, 12});
  file.set("/VTKHDF/PolyhedronToFaces", Whole{3, 2, 1, 0});
  file.set("/VTKHDF/PolyhedronOffsets", Whole{0, 0, 4});
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.vtkhdf", file.bytes())}, {}});
  const auto blocks = source.read({"u"});
  const auto& mesh = std::get<UnstructuredTopology>(blocks.at(0).topology);
  const Whole stream(mesh.connectivity.begin() + mesh.offsets[1], mesh.connectivity.end());
  EXPECT_EQ(stream, (Whole{4, 3, 4, 6, 7, 3, 5, 6, 7, 3, 4, 5, 7, 3, 4, 5, 6}));
}

// Cells of four nodes and order 1; the last is a Bezier cell.
TEST(VtkHdf, WeightsAndDegreesOfCellsComeWithThem) {
  const Hdf5File file;
  begin(file, "/VTKHDF", "UnstructuredGrid");
  Stored stored;
  stored.add({2, 0.0});
  stored.types[1] = 78;
  stored.write(file, "/VTKHDF");
  file.set("/VTKHDF/PointData/RationalWeights", std::vector<double>{1, 1, 1, 1, 1, 0.5, 1, 1});
  file.set("/VTKHDF/CellData/HigherOrderDegrees", std::vector<double>(6, 1.0), {2, 3});
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.vtkhdf", file.bytes())}, {}});
  const auto blocks = source.read({"u"});
  const DataArray* const weights = blocks.at(0).find("RationalWeights", Association::kPoint);
  ASSERT_NE(weights, nullptr);
  EXPECT_EQ(weights->at(5), 0.5);
  EXPECT_NE(blocks[0].find("HigherOrderDegrees", Association::kCell), nullptr);
}

// --- levels and collections -------------------------------------------------------------------------------

TEST(VtkHdf, CoarseCellsUnderFineOnesAreHidden) {
  const Hdf5File file;
  begin(file, "/VTKHDF", "OverlappingAMR", {1, 0});
  file.attribute("/VTKHDF", "Origin", std::vector<double>{0.0, 0.0, 0.0});
  for (int level = 0; level < 2; ++level) {
    const std::string path = "/VTKHDF/Level" + std::to_string(level);
    file.group(path);
    const double step = level == 0 ? 1.0 : 0.5;
    file.attribute(path, "Spacing", std::vector<double>{step, step, step});
    // 4 x 2 x 2 coarse cells in two boxes; 2 x 4 x 4 fine ones over x from 1 to 2.
    const Whole boxes = level == 0 ? Whole{0, 1, 0, 1, 0, 1, 2, 3, 0, 1, 0, 1} : Whole{2, 3, 0, 3, 0, 3};
    file.set(path + "/AMRBox", boxes, {boxes.size() / 6, 6});
    file.group(path + "/CellData");
    file.set(path + "/CellData/u", counted(level == 0 ? 16 : 32, level == 0 ? 0.0F : 100.0F));
  }
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.vtkhdf", file.bytes())}, {}});
  const auto blocks = source.read({"u"});
  ASSERT_EQ(blocks.size(), 3U);
  EXPECT_EQ(blocks[1].find("u", Association::kCell)->at(0), 8.0) << "the second box begins behind the first";
  EXPECT_EQ(blocks[2].find("u", Association::kCell)->at(0), 100.0);
  EXPECT_EQ(std::get<UniformTopology>(blocks[2].topology).origin, (Vec3{1.0, 0.0, 0.0}));
  ASSERT_EQ(blocks[0].hidden_cells.size(), 8U);
  for (std::size_t c = 0; c < 8; ++c) EXPECT_EQ(blocks[0].hidden_cells[c] != 0, c % 2 == 1) << c;
  for (const std::uint8_t hidden : blocks[1].hidden_cells) EXPECT_EQ(hidden, 0);
}

TEST(VtkHdf, ACollectionIsItsBlocksAndSaysWhichAreLeftOut) {
  const Hdf5File file;
  begin(file, "/VTKHDF", "PartitionedDataSetCollection", {2, 1});
  Stored stored;
  stored.add({2, 3.0});
  begin(file, "/VTKHDF/wing", "UnstructuredGrid");
  stored.write(file, "/VTKHDF/wing");
  mesh_steps(file, "/VTKHDF/wing", {0.0, 1.0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}, {1, 1});
  image_head(file, "/VTKHDF/air", {});
  file.group("/VTKHDF/air/PointData");
  file.set("/VTKHDF/air/PointData/u", counted(72), {2, 3, 4, 3});
  begin(file, "/VTKHDF/wall", "PolyData");
  file.group("/VTKHDF/Assembly");
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.vtkhdf", file.bytes())}, {}});
  EXPECT_TRUE(says(source.info().notes, "block 'wall' left out: it is of the type PolyData"));
  EXPECT_EQ(source.info().times.size(), 2U);
  const auto blocks = source.read({"u"}, 1);
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_EQ(blocks[0].name, "wing");
  EXPECT_EQ(blocks[1].name, "air");
  EXPECT_EQ(blocks[1].find("u", Association::kPoint)->at(1), 3.0) << "one state is that of all times";
}

// --- what is not right ------------------------------------------------------------------------------------

TEST(VtkHdf, WhatDoesNotAgreeIsRefusedByName) {
  const auto mesh = [](const auto& change) {
    const Hdf5File file;
    begin(file, "/VTKHDF", "UnstructuredGrid");
    Stored stored;
    stored.add({2, 0.0});
    change(file, stored);
    stored.write(file, "/VTKHDF");
    return refusal(file.bytes());
  };
  const auto has = [](const std::string& text, const std::string& words) {
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  has(mesh([](const Hdf5File&, Stored& s) { s.offsets[1] = 9; }), "'VTKHDF/Offsets': does not agree");
  has(mesh([](const Hdf5File&, Stored& s) { s.cells[0] = 3; }), "'VTKHDF/Offsets': has 3 numbers");
  has(mesh([](const Hdf5File&, Stored& s) { s.points[0] = 9; }), "'VTKHDF/Points': has 8 rows");
  has(mesh([](const Hdf5File&, Stored& s) { s.points[0] = -1; }),
      "'VTKHDF/NumberOfPoints': has a negative number");
  has(mesh([](const Hdf5File&, Stored& s) { s.points.push_back(4); }), "different numbers of parts");
  has(mesh([](const Hdf5File&, Stored& s) { s.connectivity[3] = 77; }), "names a point that is not there");
  has(mesh([](const Hdf5File&, Stored& s) { s.types[0] = 0; }), "'VTKHDF/Types': holds a kind 0");
  has(mesh([](const Hdf5File& f, Stored&) { steps(f, "/VTKHDF", {0.0, 1.0}); }), "has no PartOffsets");
  has(mesh([](const Hdf5File& f, Stored&) {
        mesh_steps(f, "/VTKHDF", {1.0, 0.5}, {0, 0}, {0, 0}, {0, 0}, {0, 0});
      }),
      "time that does not rise");
  has(mesh([](const Hdf5File& f, Stored&) {
        mesh_steps(f, "/VTKHDF", {0.0, 1.0}, {0, 1}, {0, 0}, {0, 0}, {0, 0});
      }),
      "names parts that are not there at time step 2");
  has(mesh([](const Hdf5File& f, Stored& s) {
        s.add({1, 0.0});
        s.add({1, 0.0});
        mesh_steps(f, "/VTKHDF", {0.0, 1.0}, {0, 0}, {0, 0}, {0, 0}, {0, 0});
      }),
      "does not say how many parts");
}

TEST(VtkHdf, FilesOfOtherKindsAndClaimsAreRefused) {
  const Hdf5File newer;
  begin(newer, "/VTKHDF", "UnstructuredGrid", {3, 0});
  EXPECT_NE(refusal(newer.bytes()).find("is VTKHDF of version 3"), std::string::npos);
  const Hdf5File tree;
  begin(tree, "/VTKHDF", "HyperTreeGrid");
  EXPECT_NE(refusal(tree.bytes()).find("of the type HyperTreeGrid"), std::string::npos);
  const Hdf5File claims;
  begin(claims, "/VTKHDF", "UnstructuredGrid");
  claims.claim("/VTKHDF/Points", {std::uint64_t{1} << 40U, 3});
  EXPECT_NE(refusal(claims.bytes()).find("data set 'VTKHDF/Points'"), std::string::npos);
  const Hdf5File never;
  begin(never, "/VTKHDF", "UnstructuredGrid");
  never.claim("/VTKHDF/Points", {4, 3});
  EXPECT_NE(refusal(never.bytes()).find("never written"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
