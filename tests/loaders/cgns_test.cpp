// CGNS: fields and times beyond the single cells of flow_matrix_test, and damaged files.

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/load/load.h"
#include "tests/loaders/hdf5_file.h"
#include "tests/support/refusal.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

bool says(const std::vector<std::string>& notes, const std::string& words) {
  for (const std::string& note : notes) {
    if (note.find(words) != std::string::npos) return true;
  }
  return false;
}

/// Two zones of a lattice, the second moved along z, with the flow at the nodes at two times.
std::string structured_cgns(bool cut_short = false) {
  const CgnsTree tree;
  tree.whole("/Base", "CGNSBase_t", {3, 3});
  tree.whole("/Base/Times", "BaseIterativeData_t", {2});
  tree.real("/Base/Times/TimeValues", "DataArray_t", {0.25, 0.75}, true);
  for (const std::string zone : {"low", "high"}) {
    const std::string at = "/Base/" + zone;
    const double lift = zone == "low" ? 0.0 : 2.0;
    tree.whole(at, "Zone_t", {kNx, kNy, kNz, kNx - 1, kNy - 1, kNz - 1, 0, 0, 0}, {3, 3});
    tree.text(at + "/ZoneType", "ZoneType_t", "Structured");
    tree.empty(at + "/GridCoordinates", "GridCoordinates_t");
    std::vector<Vec3> nodes = lattice();
    for (Vec3& x : nodes) x.z += lift;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> line = along(nodes, axis);
      if (cut_short) line.resize(line.size() / 2);
      const std::vector<hsize_t> counts =
          cut_short ? std::vector<hsize_t>{line.size()} : std::vector<hsize_t>{kNz, kNy, kNx};
      tree.real(at + "/GridCoordinates/Coordinate" + std::string(1, "XYZ"[axis]), "DataArray_t", line, true,
                counts);
    }
    tree.empty(at + "/Steps", "ZoneIterativeData_t");
    std::string names;
    for (const std::string step : {"Flow#1", "Flow#2"}) {
      std::string name = step;
      name.resize(32, ' ');
      names += name;
      tree.empty(at + "/" + step, "FlowSolution_t");
      tree.text(at + "/" + step + "/GridLocation", "GridLocation_t", "Vertex");
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values = along(flows_at(nodes), axis);
        for (double& v : values) v *= step == "Flow#1" ? 1.0 : 3.0;
        tree.real(at + "/" + step + "/Velocity" + std::string(1, "XYZ"[axis]), "DataArray_t", values, true,
                  {kNz, kNy, kNx});
      }
    }
    tree.text(at + "/Steps/FlowSolutionPointers", "DataArray_t", names, {2, 32});
  }
  return tree.bytes();
}

TEST(Cgns, ZonesAreBlocksAndSolutionsTimes) {
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.cgns", structured_cgns())}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{0.25, 0.75}));
  ASSERT_EQ(source.info().blocks.size(), 2U);
  EXPECT_EQ(source.info().blocks[0].points, (Index3{kNx, kNy, kNz}));
  for (std::size_t step = 0; step < 2; ++step) {
    const auto blocks = source.read({"Velocity"}, step);
    ASSERT_EQ(blocks.size(), 2U);
    for (std::size_t b = 0; b < 2; ++b) {
      const auto* const grid = std::get_if<StructuredTopology>(&blocks[b].topology);
      const DataArray* const v = blocks[b].find("Velocity", Association::kPoint);
      ASSERT_TRUE(grid != nullptr && v != nullptr);
      const std::vector<Vec3> nodes = lattice();
      for (std::size_t p = 0; p < nodes.size(); ++p) {
        const Vec3 x =
            nodes[p] + Vec3{0.0, 0.0, blocks[b].name.find("high") != std::string::npos ? 2.0 : 0.0};
        for (int c = 0; c < 3; ++c) {
          EXPECT_EQ(grid->positions.at(p, c), x[c]);
          EXPECT_EQ(v->at(p, c), flow_at(x)[c] * (step == 0 ? 1.0 : 3.0));
        }
      }
    }
  }
}

TEST(Cgns, DamagedFilesAreRefused) {
  const TempFolder folder;
  EXPECT_NE(refusal(folder.write("short.cgns", structured_cgns(true))).find("has 12 numbers, expected 24"),
            std::string::npos);
  const CellKind& tet = cell_kinds().front();
  EXPECT_NE(refusal(folder.write("cells.cgns", cgns_file(tet, true, 2)))
                .find("has 4 points of 2 elements, expected 4 each"),
            std::string::npos);
  std::string cut = structured_cgns();
  cut.resize(cut.size() * 2 / 3);
  EXPECT_NE(refusal(folder.write("cut.cgns", cut)).find("truncated"), std::string::npos);
  EXPECT_NE(refusal(folder.write("a.cgns", "@(#)ADF Database Version B02012>")), "");
}

/// A tetrahedron, and what of it is wrong.
struct OneTetrahedron {
  std::vector<std::int32_t> base{3, 3}, zone{4, 1, 0}, about{10, 0}, range{1, 1}, corners{1, 2, 3, 4};
  std::string type = "Unstructured", place = "Vertex";
  std::vector<std::string> axes{"X", "Y", "Z"};
  std::vector<std::int32_t> rind, offsets, place_rind;
  std::vector<std::int32_t> second;  // numbers of more tetrahedra
  std::vector<hsize_t> list_counts;
  std::size_t label = 33;  // characters of one

  [[nodiscard]] std::string bytes() const {
    const CgnsTree tree;
    tree.whole("/Base", "CGNSBase_t", base);
    tree.whole("/Base/Zone", "Zone_t", zone, {3, zone.size() / 3});
    tree.text("/Base/Zone/ZoneType", "ZoneType_t", type);
    tree.empty("/Base/Zone/GridCoordinates", "GridCoordinates_t");
    for (const std::string& axis : axes) {
      const std::size_t moved = axis == "X" ? 1 : axis == "Y" ? 2 : 3;
      std::vector<double> places(4, 0.0);
      places[moved] = 1.0;
      tree.real("/Base/Zone/GridCoordinates/Coordinate" + axis, "DataArray_t", places, true);
    }
    tree.whole("/Base/Zone/Cells", "Elements_t", about);
    tree.whole("/Base/Zone/Cells/ElementRange", "IndexRange_t", range);
    tree.whole("/Base/Zone/Cells/ElementConnectivity", "DataArray_t", corners, list_counts);
    tree.label("/Base/Zone/Cells", "Elements_t", label);
    if (!place_rind.empty())
      tree.whole("/Base/Zone/GridCoordinates/Rind", "\"int[2*IndexDimension]\"", place_rind);
    if (!second.empty()) {
      tree.whole("/Base/Zone/More", "Elements_t", {10, 0});
      tree.whole("/Base/Zone/More/ElementRange", "IndexRange_t", second);
      tree.whole("/Base/Zone/More/ElementConnectivity", "DataArray_t", {1, 2, 3, 4});
    }
    if (!offsets.empty()) tree.whole("/Base/Zone/Cells/ElementStartOffset", "DataArray_t", offsets);
    tree.empty("/Base/Zone/Flow", "FlowSolution_t");
    tree.text("/Base/Zone/Flow/GridLocation", "GridLocation_t", place);
    if (!rind.empty()) tree.whole("/Base/Zone/Flow/Rind", "\"int[2*IndexDimension]\"", rind);
    for (const char axis : {'X', 'Y', 'Z'})
      tree.real(std::string("/Base/Zone/Flow/Velocity") + axis, "DataArray_t", {1.0, 1.0, 1.0, 1.0}, true);
    return tree.bytes();
  }
};

TEST(Cgns, WhatDoesNotFitTogetherIsRefusedByName) {
  const TempFolder folder;
  const auto line = [&](const OneTetrahedron& one) { return refusal(folder.write("a.cgns", one.bytes())); };
  EXPECT_EQ(
      Source::open({{folder.write("good.cgns", OneTetrahedron{}.bytes())}, {}}).read({}).at(0).cell_count(),
      1U);
  EXPECT_EQ(
      Source::open({{folder.write("mixed.cgns",
                                  OneTetrahedron{.about = {20, 0}, .corners = {10, 1, 2, 3, 4}}.bytes())},
                    {}})
          .read({})
          .at(0)
          .cell_count(),
      1U);
  EXPECT_EQ(Source::open(
                {{folder.write("two.cgns", OneTetrahedron{.zone = {4, 2, 0}, .second = {2, 2}}.bytes())}, {}})
                .read({})
                .at(0)
                .cell_count(),
            2U);
  const std::vector<std::pair<OneTetrahedron, std::string>> kWrong{
      {{.base = {3, 5}}, "other dimensions"},
      {{.base = {0, 3}}, "other dimensions"},
      {{.zone = {4, 1, 0, 0, 0, 0}}, "another number of axes"},
      {{.zone = {-4, 1, 0}}, "sizes that are of no grid"},
      {{.type = "Elsewhere"}, "whether it is structured"},
      {{.axes = {"X", "Y"}}, "no CoordinateZ"},
      {{.about = {0, 0}}, "elements of no kind"},
      {{.range = {1, 9}}, "fewer points than elements"},
      {{.range = {3, 1}}, "elements of no numbers"},
      {{.corners = {1, 2, 3, 5}}, "points that are not there"},
      {{.corners = {0, 1, 2, 3}}, "points that are not there"},
      {{.about = {20, 0}, .corners = {10, 1, 2, 3}}, "elements of no kind"},
      {{.about = {20, 0}, .corners = {10, 1, 2, 3, 4, 10, 1, 2, 3, 4}}, "2 elements, expected 1"},
      {{.about = {20, 0}, .corners = {10, 1, 2, 3, 9}}, "points that are not there"},
      {{.about = {22, 0}, .corners = {1, 2, 3}, .offsets = {0, 4}}, "offsets that do not fit"},
      {{.about = {22, 0}, .corners = {1, 2, 9}, .offsets = {0, 3}}, "faces of points"},
      {{.place = "Nowhere"}, "no place that values can have"},
      {{.rind = {1, 1, 1}}, "other layers"},
      {{.place_rind = {1, 1, 1, 1, 1, 1, 1, 1}}, "other layers"},
      {{.about = {10}}, "elements of no kind"},
      {{.about = {39, 0}}, "4 points of 1 elements, expected 64 each"},
      {{.zone = {4, 1, 0}, .range = {1, 2}}, "4 points of 2 elements, expected 4 each"},
      {{.zone = {4, 3, 0}, .second = {3, 3}}, "numbers from 3 on, expected 2"},
      {{.zone = {4, 2, 0}, .second = {1, 1}}, "numbers from 1 on, expected 2"},
      {{.zone = {4, 1, 0}, .second = {2, 2}}, "behind as many as it has cells"},
      {{.list_counts = {2, 2}}, "no list of the points"},
      {{.about = {22, 0}, .corners = {3, 1, 2, 9}}, "faces of points"},
      {{.about = {22, 0}, .corners = {5, 1, 2, 3}}, "elements of no size"},
      {{.about = {22, 0}, .range = {1, 2}, .corners = {3, 1, 2, 3}}, "1 elements, expected 2"},
      {{.about = {23, 0}, .corners = {1, 2, 3, 4}, .offsets = {0, 4}}, "faces that are not there"},
      {{.about = {23, 0}, .corners = {4, 1, 2, 3, 4}}, "faces that are not there"},
      {{.label = 4000}, "has a label that is no text of 32 characters"}};
  for (const auto& [one, words] : kWrong)
    EXPECT_NE(line(one).find(words), std::string::npos) << words << ": " << line(one);
}

/// One zone of the lattice with the flow at its nodes. @param names of the three coordinates. @param solutions that have it.
std::string lattice_cgns(const std::vector<std::string>& names, int solutions, const std::string& unit) {
  const CgnsTree tree;
  constexpr std::size_t kLength = 32;
  tree.whole("/Base", "CGNSBase_t", {3, 3});
  if (!unit.empty()) {
    std::string units;
    for (std::string word : {std::string("Kilogram"), unit, std::string("Second"), std::string("Kelvin"),
                             std::string("Degree")}) {
      word.resize(kLength, ' ');
      units += word;
    }
    tree.text("/Base/DimensionalUnits", "DimensionalUnits_t", units, {5, kLength});
  }
  tree.whole("/Base/Zone", "Zone_t", {kNx, kNy, kNz, kNx - 1, kNy - 1, kNz - 1, 0, 0, 0}, {3, 3});
  tree.text("/Base/Zone/ZoneType", "ZoneType_t", "Structured");
  tree.empty("/Base/Zone/GridCoordinates", "GridCoordinates_t");
  const std::vector<Vec3> nodes = lattice();
  for (int axis = 0; axis < 3; ++axis)
    tree.real("/Base/Zone/GridCoordinates/" + names[static_cast<std::size_t>(axis)], "DataArray_t",
              along(nodes, axis), true, {kNz, kNy, kNx});
  for (int s = 1; s <= solutions; ++s) {
    const std::string solution = "/Base/Zone/Flow" + std::to_string(s);
    tree.empty(solution, "FlowSolution_t");
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values = along(flows_at(nodes), axis);
      for (double& v : values) v *= s;
      tree.real(solution + "/Velocity" + std::string(1, "XYZ"[axis]), "DataArray_t", values, true,
                {kNz, kNy, kNx});
    }
  }
  return tree.bytes();
}

const std::vector<std::string> kCartesian{"CoordinateX", "CoordinateY", "CoordinateZ"};

TEST(Cgns, UnitsAreStated) {
  const TempFolder folder;
  for (const auto& [unit, stated] : std::vector<std::pair<std::string, std::string>>{
           {"Millimeter", "coordinates in mm"}, {"Foot", "coordinates in ft"}, {"Null", ""}, {"", ""}}) {
    const Source source = Source::open({{folder.write("a.cgns", lattice_cgns(kCartesian, 1, unit))}, {}});
    EXPECT_EQ(source.info().units, stated) << unit;
  }
}

TEST(Cgns, CylindricalCoordinatesAreRefused) {
  const TempFolder folder;
  const auto file =
      folder.write("a.cgns", lattice_cgns({"CoordinateR", "CoordinateTheta", "CoordinateZ"}, 1, ""));
  EXPECT_NE(refusal(file).find("has CoordinateR; expected Cartesian"), std::string::npos);
}

TEST(Cgns, SolutionsThatNoTimeBelongsToAreWarnedOf) {
  const TempFolder folder;
  for (const int solutions : {1, 2}) {
    Source source = Source::open({{folder.write("a.cgns", lattice_cgns(kCartesian, solutions, ""))}, {}});
    EXPECT_EQ(says(source.info().notes, "WARNING: 'Base/Zone' has VelocityX in 2 solutions"), solutions == 2);
    const auto blocks = source.read({"Velocity"});
    const DataArray* const v = blocks.at(0).find("Velocity", Association::kPoint);
    ASSERT_NE(v, nullptr);
    EXPECT_EQ(v->at(1, 0), flow_at(lattice()[1]).x) << "the first one, as the warning says";
  }
}

/// A cube with a square of its border, and the flow at its middle. @param border number of that square, 1 or 2.
/// @param cells that the zone claims to have.
std::string bordered_cgns(std::int32_t border, std::int32_t cells = 1) {
  const CgnsTree tree;
  tree.whole("/Base", "CGNSBase_t", {3, 3});
  tree.whole("/Base/Zone", "Zone_t", {8, cells, 0}, {3, 1});
  tree.text("/Base/Zone/ZoneType", "ZoneType_t", "Unstructured");
  tree.empty("/Base/Zone/GridCoordinates", "GridCoordinates_t");
  const std::vector<Vec3> nodes{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (int axis = 0; axis < 3; ++axis)
    tree.real("/Base/Zone/GridCoordinates/" + kCartesian[static_cast<std::size_t>(axis)], "DataArray_t",
              along(nodes, axis), true);
  const auto elements = [&](const std::string& name, std::int32_t kind, std::int32_t number,
                            const std::vector<std::int32_t>& order) {
    tree.whole("/Base/Zone/" + name, "Elements_t", {kind, 0});
    tree.whole("/Base/Zone/" + name + "/ElementRange", "IndexRange_t", {number, number});
    tree.whole("/Base/Zone/" + name + "/ElementConnectivity", "DataArray_t", order);
  };
  constexpr std::int32_t kQuad = 7, kHexahedron = 17;
  if (border == 1) elements("Wall", kQuad, 1, {1, 2, 3, 4});
  elements("Cells", kHexahedron, 3 - border, {1, 2, 3, 4, 5, 6, 7, 8});
  if (border == 2) elements("Wall", kQuad, 2, {1, 2, 3, 4});
  tree.empty("/Base/Zone/Solution", "FlowSolution_t");
  tree.text("/Base/Zone/Solution/GridLocation", "GridLocation_t", "CellCenter");
  for (const std::string axis : {"X", "Y", "Z"})
    tree.real("/Base/Zone/Solution/Velocity" + axis, "DataArray_t",
              std::vector<double>(static_cast<std::size_t>(cells), 0.5), true);
  return tree.bytes();
}

TEST(Cgns, BordersBehindTheVolumeAreLeftOutAndOthersRefused) {
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.cgns", bordered_cgns(2))}, {}});
  const auto blocks = source.read({"Velocity"});
  const DataArray* const v = blocks.at(0).find("Velocity", Association::kCell);
  ASSERT_NE(v, nullptr);
  EXPECT_EQ(v->at(0, 2), 0.5);
  EXPECT_NE(refusal(folder.write("b.cgns", bordered_cgns(1))).find("behind as many as it has cells"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("c.cgns", bordered_cgns(1, 2))).find("elements of its border before"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::test
