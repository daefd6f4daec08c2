// openCARP, TetGen and Chaste meshes through the helper program.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

Source open(const std::filesystem::path& file) {
  return Source::open({.files = {file}, .solution = {}, .raw = {}});
}

const UnstructuredTopology& cells(const DataSet& mesh) {
  return std::get<UnstructuredTopology>(mesh.topology);
}

void expect_refused(const std::filesystem::path& file, const std::string& word) {
  try {
    (void)open(file);
    ADD_FAILURE() << word << " was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

TEST(Carp, MicrometresRegionsAndDirectionsAreRead) {
  const test::TempFolder folder;
  folder.write("m.pts", "6\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n1000 0 1000\n0 1000 1000\n");
  folder.write("m.lon", "2\n2 0 0 0 3 0\n0 0 0 0 1 0\n");
  // A prism whose second triangle runs the other way round, and one tetrahedron of it.
  const auto elem = folder.write("m.elem", "2\nPr 0 1 2 3 5 4 7\nTt 0 1 2 3 9\n");
  for (const char* named : {"m.pts", "m.elem", "m.lon"}) {
    Source source = open(folder.path(named));
    EXPECT_EQ(source.info().format, "openCARP");
    EXPECT_EQ(source.info().loader, "palpate-load-cardiac");
    const DataSet mesh = source.read({"fibre", "sheet", "normal", "region"}).at(0);
    EXPECT_EQ(cells(mesh).types, (std::vector<std::uint8_t>{13, 10}));
    EXPECT_EQ(cells(mesh).connectivity, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 0, 1, 2, 3}));
    EXPECT_DOUBLE_EQ(cells(mesh).positions.at(1, 0), 1.0);
    const DataArray* region = mesh.find("region", Association::kCell);
    ASSERT_NE(region, nullptr);
    EXPECT_EQ(region->at(1), 9.0);
    const DataArray* fibre = mesh.find("fibre", Association::kCell);
    ASSERT_NE(fibre, nullptr);
    EXPECT_EQ(fibre->at(0, 0), 1.0);
    EXPECT_TRUE(std::isnan(fibre->at(1, 0))) << "a zero direction is no direction";
    EXPECT_EQ(mesh.find("normal", Association::kCell)->at(0, 2), 1.0);
  }
  folder.write("m.elem", "2\nTt 0 1 2 3 9\nTt 0 1 2 6 9\n");
  expect_refused(elem, "line 3: has 6; expected");
  folder.write("m.elem", "2\nTt 0 1 2 3 9\n");
  expect_refused(elem, "m.elem");
  folder.write("m.elem", "1099511627776\nTt 0 1 2 3 9\n");
  expect_refused(elem, "number of elements");
  folder.write("m.elem", "2\nTt 0 1 2 3 9\nXx 0 1 2 3 9\n");
  expect_refused(elem, "Xx");
  folder.write("m.elem", "1\nTt 0 1 2 3 9\n");
  expect_refused(elem, "m.lon");
}

// What stands in a row too many would shift all that follows.
TEST(Carp, RowsThatAreNoPointsAndRowsTooManyAreRefusedWithTheirLine) {
  const test::TempFolder folder;
  const auto elem = folder.write("m.elem", "1\nTt 0 1 2 3 9\n");
  const auto refuse_points = [&](const std::string& rows, const std::string& word) {
    folder.write("m.pts", rows);
    expect_refused(elem, word);
  };
  refuse_points("4\n0 0 0 1\n1000 0 0 1\n0 1000 0 1\n0 0 1000 1\n", "line 2: has 4 numbers");
  refuse_points("4\n0 0 0\n1000 0 0\n0 1000\n0 0 0 1000\n", "line 4: has 2 numbers");
  refuse_points("4\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n5 5 5\n", "line 6: goes on after 4 points");
  refuse_points("4\n0 0 0\n1000 0 0\n0 1000 0\n", "ends after 3 points");
  refuse_points("4\n0 0 0\n1000 0 nan\n0 1000 0\n0 0 1000\n", "line 3: has \"nan\"");
  folder.write("m.pts", "# a remark\n4 # points\n\n0 0 0\n1000, 0, 0\n0 1000 0 # one\n0 0 1000\n\n# end\n");
  EXPECT_EQ(open(elem).read({}).at(0).point_count(), 4U);
  folder.write("m.elem", "1\nTt 0 1 2 3 9\nTt 3 2 1 0 9\n");
  expect_refused(elem, "line 3: goes on after 1 element");
}

std::vector<std::string> notes_of(const std::filesystem::path& file) { return open(file).info().notes; }

bool noted(const std::filesystem::path& file, const std::string& words) {
  const std::vector<std::string> notes = notes_of(file);
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(Carp, DirectionsWithoutAHeaderAreKnownByTheirRows) {
  const test::TempFolder folder;
  const auto pts = folder.write("m.pts", "4\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n");
  folder.write("m.elem", "2\nTt 0 1 2 3 9\nTt 3 2 1 0 9\n");
  for (const auto& [first, second] : std::vector<std::pair<std::string, std::string>>{
           {"0 2 0", "0 0 1"}, {"0 2 0 3 0 0", "0 0 1 1 0 0"}, {"0 2 0 3 0 0 0 0 4", "0 0 1 1 0 0 0 1 0"}}) {
    for (const bool headed : {true, false}) {
      const std::string vectors = std::to_string((first.size() + 1) / 6);
      if (headed && vectors == "3") continue;
      folder.write("m.lon",
                   "# written by a test\n" + (headed ? vectors + "\n" : "") + first + "\n" + second + "\n");
      Source source = open(pts);
      const DataSet mesh = source.read({"fibre", "sheet", "normal"}).at(0);
      const DataArray* fibre = mesh.find("fibre", Association::kCell);
      ASSERT_NE(fibre, nullptr);
      EXPECT_EQ(fibre->at(0, 1), 1.0);
      EXPECT_EQ(fibre->at(1, 2), 1.0);
      const DataArray* sheet = mesh.find("sheet", Association::kCell);
      EXPECT_EQ(sheet != nullptr, vectors != "1");
      EXPECT_TRUE(sheet == nullptr || sheet->at(0, 0) == 1.0);
      EXPECT_EQ(noted(pts, "has no header"), !headed);
    }
  }
  folder.write("m.lon", "1 0 0\n0 1 0\n0 0 1\n");
  expect_refused(pts, "goes on after 2");
  folder.write("m.lon", "1 0 0 4\n0 1 0 4\n");
  expect_refused(pts, "goes on after 2");
}

TEST(Carp, WordsBehindRegionsAreLeftOutAndNamed) {
  const test::TempFolder folder;
  const auto pts = folder.write("m.pts", "4\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n");
  folder.write("m.elem", "3\nTt 0 1 2 3 9 LV_wall\nTt 3 2 1 0 RV\nTt 3 2 1 0 4 2 septum\n");
  Source source = open(pts);
  const DataSet mesh = source.read({"region"}).at(0);
  const DataArray* region = mesh.find("region", Association::kCell);
  ASSERT_NE(region, nullptr);
  EXPECT_EQ(region->at(0), 9.0);
  EXPECT_EQ(region->at(1), 0.0);
  EXPECT_EQ(region->at(2), 4.0);
  EXPECT_TRUE(noted(pts, "4 words behind the regions"));
  EXPECT_TRUE(noted(pts, "LV_wall"));
}

/// A row of cubes along x, each of six tetrahedra, whose points are numbered in a stirred order.
/// @param unused how many points no element names stand first. @param base what the file counts from.
std::string cubes(int count, int unused, int base, std::string& pts) {
  const int points = 4 * (count + 1);
  std::vector<int> place(static_cast<std::size_t>(points));
  for (int p = 0; p < points; ++p) place[static_cast<std::size_t>(p)] = (p * 13) % points;
  std::vector<std::string> rows(static_cast<std::size_t>(points));
  for (int p = 0; p < points; ++p)
    rows[static_cast<std::size_t>(place[static_cast<std::size_t>(p)])] =
        std::to_string(1000 * (p / 4)) + " " + std::to_string(1000 * (p % 2)) + " " +
        std::to_string(1000 * (p / 2 % 2)) + "\n";
  pts = std::to_string(points + unused) + "\n";
  for (int n = 0; n < unused; ++n) pts += "0 0 0\n";
  for (const std::string& row : rows) pts += row;
  static constexpr int kTets[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                      {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  std::string elem = std::to_string(6 * count) + "\n";
  for (int c = 0; c < count; ++c) {
    for (const auto& tet : kTets) {
      elem += "Tt";
      for (const int corner : tet)
        elem += " " + std::to_string(place[static_cast<std::size_t>(4 * c + corner)] + unused + base);
      elem += " 1\n";
    }
  }
  return elem;
}

TEST(Carp, PointsThatCountFromOneAreNoticedInRangeToo) {
  const test::TempFolder folder;
  // Points behind the last one that is used make room for the base; points before the first one do not.
  for (const int behind : {0, 1, 3}) {
    for (const int before : {0, 1}) {
      for (const int base : {0, 1}) {
        std::string pts;
        const std::string elem = cubes(11, before, base, pts);  // 48 points
        for (int n = 0; n < behind; ++n) pts += "0 0 0\n";
        pts.replace(0, pts.find('\n'), std::to_string(48 + before + behind));
        const auto file = folder.write("m.pts", pts);
        folder.write("m.elem", elem);
        Source source = open(file);
        const DataSet mesh = source.read({}).at(0);
        const auto& topology = cells(mesh);
        // Every edge of a row of cubes is at most the diagonal of one.
        double longest = 0.0;
        for (std::size_t n = 0; n < topology.connectivity.size(); ++n) {
          const auto a = static_cast<std::size_t>(topology.connectivity[n]);
          const auto b = static_cast<std::size_t>(topology.connectivity[n / 4 * 4]);
          double square = 0.0;
          for (int axis = 0; axis < 3; ++axis)
            square += std::pow(topology.positions.at(a, axis) - topology.positions.at(b, axis), 2);
          longest = std::max(longest, square);
        }
        EXPECT_LT(longest, 3.0 + 1e-9) << behind << before << base;
        EXPECT_EQ(noted(file, "count from 1"), base == 1) << behind << before << base;
      }
    }
  }
}

std::string tetrahedron(int first, bool quadratic) {
  std::string text;
  static constexpr double kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static constexpr int kEdges[6][2] = {{2, 3}, {1, 3}, {1, 2}, {0, 3}, {0, 2}, {0, 1}};  // not VTK's order
  text = (quadratic ? "10" : "4") + std::string(" 3 1 1\n# a comment\n");
  int node = first;
  const auto add = [&](double x, double y, double z) {
    text += std::to_string(node) + " " + std::to_string(x) + " " + std::to_string(y) + " " +
            std::to_string(z) + " " + std::to_string(10 * (node - first)) + " 1\n";
    ++node;
  };
  for (const auto& c : kCorners) add(c[0], c[1], c[2]);
  if (quadratic)
    for (const auto& e : kEdges)
      add((kCorners[e[0]][0] + kCorners[e[1]][0]) / 2, (kCorners[e[0]][1] + kCorners[e[1]][1]) / 2,
          (kCorners[e[0]][2] + kCorners[e[1]][2]) / 2);
  return text + "# end\n";
}

TEST(Tetgen, BothNumberingsAndMidNodesInAnyOrderAreRead) {
  for (const int first : {0, 1}) {
    const test::TempFolder folder;
    folder.write("a_quad.node", tetrahedron(first, true));
    std::string elements = "1 10 0\n" + std::to_string(first);
    for (int n = 0; n < 10; ++n) elements += " " + std::to_string(n + first);
    folder.write("a_quad.ele", elements + "\n");
    folder.write("a.ortho", "1\n1 0 0 0 1 0 0 0 1\n");
    for (const char* named : {"a_quad.node", "a_quad.ele", "a.ortho"}) {
      Source source = open(folder.path(named));
      EXPECT_EQ(source.info().format, "TetGen");
      const DataSet mesh = source.read({"fibre", "normal", "attribute 1"}).at(0);
      // VTK's edges 01 12 02 03 13 23 are nodes 9 6 8 7 5 4 here.
      EXPECT_EQ(cells(mesh).connectivity, (std::vector<std::int64_t>{0, 1, 2, 3, 9, 6, 8, 7, 5, 4}));
      EXPECT_EQ(mesh.find("normal", Association::kCell)->at(0, 2), 1.0);
      EXPECT_EQ(mesh.find("attribute 1", Association::kPoint)->at(3), 30.0);
    }
  }
}

TEST(Tetgen, FibresThatAreNextToNothingAreNone) {
  const test::TempFolder folder;
  folder.write("a.node", "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1\n");
  folder.write("a.ele", "2 4 0\n0 0 1 2 3\n1 1 2 3 4\n");
  for (const auto& [tiny, none] : {std::pair{"1e-3", false}, std::pair{"1e-12", true}}) {
    folder.write("a.axi", std::string("2\n0 2 0\n") + tiny + " 0 0\n");
    Source source = open(folder.path("a.ele"));
    const DataSet mesh = source.read({"fibre"}).at(0);
    const DataArray& fibre = *mesh.find("fibre", Association::kCell);
    EXPECT_EQ(fibre.at(0, 1), 1.0);
    EXPECT_EQ(std::isnan(fibre.at(1, 0)), none) << tiny;
    EXPECT_EQ(noted(folder.path("a.ele"), "1 fibre a million times shorter"), none);
    EXPECT_EQ(noted(folder.path("a.ele"), "1 element without a fibre direction"), none);
  }
}

TEST(Tetgen, WholeNumbersOfElementsAreRegions) {
  const test::TempFolder folder;
  folder.write("a.node", tetrahedron(0, false));
  folder.write("a.ele", "1 4 2\n0 0 1 2 3 5 2.5\n");
  Source source = open(folder.path("a.ele"));
  const DataSet mesh = source.read({"region", "attribute 2"}).at(0);
  ASSERT_NE(mesh.find("region", Association::kCell), nullptr);
  EXPECT_EQ(mesh.find("region", Association::kCell)->at(0), 5.0);
  EXPECT_EQ(mesh.find("attribute 2", Association::kCell)->at(0), 2.5);
  folder.write("a.ele", "1 4 1\n0 0 1 2 3 2.5\n");
  Source measured = open(folder.path("a.ele"));
  EXPECT_NE(measured.read({"attribute 1"}).at(0).find("attribute 1", Association::kCell), nullptr);
}

// Chaste writes such: a column of zeros that the first line does not speak of.
TEST(Tetgen, NumbersBeyondTheFirstLineAreLeftOutAndSaid) {
  const test::TempFolder folder;
  for (const char* more : {"", " 0", " 7 8"}) {
    const std::string end = std::string(more) + "\n";
    const auto node = folder.write(
        "a.node", "4 3 0 0\n0 0 0 0" + end + "1 1 0 0" + end + "2 0 1 0" + end + "3 0 0 1" + end);
    folder.write("a.ele", "2 4 0\n0 0 1 2 3" + end + "1 3 2 1 0" + end);
    folder.write("a.face", "2 0\n0 0 1 2" + std::string(*more == '\0' ? "" : " 0") + "\n1 0 1 3\n");
    Source source = open(node);
    const DataSet mesh = source.read({}).at(0);
    EXPECT_EQ(cells(mesh).connectivity, (std::vector<std::int64_t>{0, 1, 2, 3, 3, 2, 1, 0}));
    EXPECT_EQ(cells(mesh).positions.at(3, 2), 1.0);
    EXPECT_EQ(noted(node, "4 rows of"), *more != '\0');
    EXPECT_EQ(noted(node, "2 rows of"), *more != '\0');
    EXPECT_EQ(noted(node, "1 row of"), *more != '\0');
  }
  // A marker that is promised and not there is not needed.
  folder.write("a.node", "4 3 0 1\n0 0 0 0 1\n1 1 0 0\n2 0 1 0\n3 0 0 1 0\n");
  EXPECT_TRUE(noted(folder.path("a.node"), "2 nodes of"));
  folder.write("a.axi", "2\n1 0 0 5\n0 1 0 5\n");
  expect_refused(folder.path("a.node"), "goes on after 2");
}

TEST(Tetgen, WhatIsOffIsNamed) {
  const test::TempFolder folder;
  const auto node = folder.write("a.node", tetrahedron(1, false));
  expect_refused(node, ".ele");
  folder.write("a.ele", "1 4 0\n1 1 2 3 4\n");
  EXPECT_NO_THROW((void)open(node));
  folder.write("a.axi", "2\n1 0 0\n0 1 0\n");
  expect_refused(node, "2 directions");
  folder.write("a.axi", "1\n1 0 zero\n");
  expect_refused(node, "zero");
  folder.write("a.axi", "1\n0 -2 0\n");  // Chaste's transversely isotropic muscle: fibres alone
  Source source = open(folder.path("a.axi"));
  const DataSet axi = source.read({"fibre"}).at(0);
  EXPECT_EQ(axi.find("fibre", Association::kCell)->at(0, 1), -1.0);
  EXPECT_EQ(axi.arrays.size(), 1U);
  std::filesystem::remove(folder.path("a.axi"));
  folder.write("a.ele", "1 4 0\n1 1 2 3 5\n");
  expect_refused(node, "from 1 to 4");
  folder.write("a.ele", "1 5 0\n1 1 2 3 4 4\n");
  expect_refused(node, "5 nodes");
  folder.write("a.ele", "99999999999999 4 0\n1 1 2 3 4\n");
  expect_refused(node, "number of elements");
  folder.write("a.ele", "1 4 0\n1 1 2 3 4\n");
  folder.write("a.node", "4 3 1 1\n1 0 0 0 0 1\n3 1 0 0 0 1\n");
  expect_refused(node, "next node's number");
  folder.write("a.node", "1 3 1 1\n1 0 0 nan 0 1\n");
  expect_refused(node, "coordinate");
}

// Rows as CardioMechanics' manual has them: the element's number, then fibre, sheet and normal at its
// centroid and at each quadrature point.
TEST(Tetgen, OfBasesTheDirectionsAtTheCentroidAreTaken) {
  const test::TempFolder folder;
  const auto node = folder.write("a.node", "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n");
  folder.write("a.ele", "2 4 1\n1 1 2 3 4 7\n2 2 3 4 5 7\n");
  const std::string first = " 0 2 0 0 0 3 5 0 0", second = " 0 0 0 0 1 0 0 0 1", other = " 1 0 0 0 1 0 0 0 1";
  for (const int number : {0, 1}) {
    for (const int places : {1, 2}) {
      const std::string more = places == 2 ? other : "";
      const auto bases =
          folder.write("a.bases", "2 " + std::to_string(places) + "\n" + std::to_string(number) + first +
                                      more + "\n" + std::to_string(number + 1) + second + more + "\n");
      for (const auto& named : {node, bases}) {
        Source source = open(named);
        const DataSet mesh = source.read({"fibre", "sheet", "normal"}).at(0);
        const DataArray* fibre = mesh.find("fibre", Association::kCell);
        ASSERT_NE(fibre, nullptr);
        EXPECT_EQ(fibre->at(0, 1), 1.0);
        EXPECT_TRUE(std::isnan(fibre->at(1, 0)));
        EXPECT_EQ(mesh.find("sheet", Association::kCell)->at(0, 2), 1.0);
        EXPECT_EQ(mesh.find("normal", Association::kCell)->at(0, 0), 1.0);
      }
    }
  }
  for (const auto& [text, word] : std::vector<std::pair<std::string, std::string>>{
           {"3 1\n", "3 directions"},
           {"2 0\n", "places in an element"},
           {"2\n1" + first + "\n2" + second + "\n", "element's number"},
           {"2 1\n1" + first + "\n3" + second + "\n", "element's number"},
           {"2 1\n1" + first + "\n2 0 0\n", "ends after 1"},
           {"2 1\n1" + first + "\n2 x" + second + "\n", "\"x\""}}) {
    folder.write("a.bases", text);
    expect_refused(node, word);
  }
}

// Fibres that turn along z: five frames an element say so within it, a direction at its centroid does not.
TEST(Tetgen, OfFiveFramesAnElementPointsHaveTheirOwnDirections) {
  constexpr int kSide = 3;
  const auto angle = [](double z) { return 1.2 * z; };  // over a height of one
  const auto point = [](int i, int j, int k) { return 1 + i + (kSide + 1) * (j + (kSide + 1) * k); };
  std::string nodes, elements, frames;
  std::vector<Vec3> places;
  for (int k = 0; k <= kSide; ++k)
    for (int j = 0; j <= kSide; ++j)
      for (int i = 0; i <= kSide; ++i) {
        places.push_back(Vec3(i, j, k) / double(kSide));
        nodes += std::to_string(point(i, j, k)) + " " + std::to_string(places.back().x) + " " +
                 std::to_string(places.back().y) + " " + std::to_string(places.back().z) + "\n";
      }
  int count = 0;
  const double a = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, b = (5.0 - std::sqrt(5.0)) / 20.0;
  for (int k = 0; k < kSide; ++k)
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i)
        for (const auto& order : std::array<std::array<std::size_t, 3>, 6>{
                 {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}}) {
          std::array<int, 3> at{i, j, k};
          std::array<int, 4> corners{point(i, j, k)};
          for (std::size_t c = 0; c < 3; ++c) {
            ++at[order[c]];
            corners[c + 1] = point(at[0], at[1], at[2]);
          }
          ++count;
          elements += std::to_string(count);
          frames += std::to_string(count);
          for (const int corner : corners) elements += " " + std::to_string(corner);
          elements += "\n";
          for (int place = 0; place < 5; ++place) {
            double z = 0.0;
            for (int c = 0; c < 4; ++c)
              z += (place == 0       ? 0.25
                    : place == c + 1 ? a
                                     : b) *
                   places[std::size_t(corners[std::size_t(c)] - 1)].z;
            // Signs are any.
            const double sign = (count + place) % 3 == 0 ? -1.0 : 1.0, c = sign * std::cos(angle(z)),
                         s = sign * std::sin(angle(z));
            for (const double value : {c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0})
              frames += " " + std::to_string(value);
          }
          frames += "\n";
        }
  const test::TempFolder folder;
  const auto node = folder.write("a.node", std::to_string(places.size()) + " 3 0 0\n" + nodes);
  folder.write("a.ele", std::to_string(count) + " 4 0\n" + elements);
  folder.write("a.bases", std::to_string(count) + " 5\n" + frames);
  Source source = open(node);
  const DataSet mesh = source.read({"fibre", "sheet", "normal"}).at(0);
  const DataArray* fibre = mesh.find("fibre", Association::kPoint);
  const DataArray* sheet = mesh.find("sheet", Association::kPoint);
  ASSERT_NE(fibre, nullptr);
  ASSERT_NE(sheet, nullptr);
  EXPECT_EQ(mesh.find("fibre", Association::kCell), nullptr);
  double worst = 0.0;
  for (std::size_t p = 0; p < places.size(); ++p) {
    const double phi = angle(places[p].z);
    const double along = fibre->at(p, 0) * std::cos(phi) + fibre->at(p, 1) * std::sin(phi);
    const double across = -sheet->at(p, 0) * std::sin(phi) + sheet->at(p, 1) * std::cos(phi);
    worst = std::max(
        {worst, std::acos(std::min(1.0, std::abs(along))), std::acos(std::min(1.0, std::abs(across)))});
  }
  // Fibres turn by 23 degrees within an element: means of centroids are off by 6 and more at the border.
  EXPECT_LT(worst * 180.0 / 3.14159265358979, 1.5);
}

TEST(Tetgen, TheEllipsoidOpensWithItsFibres) {
  PALPATE_NEED_DATA(file, "cardiac/chaste-ellipsoid/ellipsoid_8225_elements_quad.node");
  Source source = open(file);
  EXPECT_EQ(source.info().blocks.at(0).cell_count, 8225U);
  const DataSet mesh = source.read({"fibre", "sheet"}).at(0);
  const DataArray* fibre = mesh.find("fibre", Association::kCell);
  const DataArray* sheet = mesh.find("sheet", Association::kCell);
  ASSERT_EQ(fibre->tuples, 8225U);
  // The first row of the file, to its six digits.
  EXPECT_NEAR(fibre->at(0, 0), 0.501428, 1e-6);
  EXPECT_NEAR(fibre->at(0, 1), 0.707195, 1e-6);
  for (std::size_t c = 0; c < fibre->tuples; ++c) {
    double dot = 0.0;
    for (int axis = 0; axis < 3; ++axis) dot += fibre->at(c, axis) * sheet->at(c, axis);
    EXPECT_NEAR(dot, 0.0, 1e-4);
  }
}

TEST(Ex, TheHeartOpensFromEitherFileAndWarnsOfCollapsedEdges) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  for (const auto& file : {nodes, nodes.parent_path() / "heart.exelem.gz"}) {
    const Source source = open(file);
    EXPECT_EQ(source.info().format, "EX");
    EXPECT_EQ(source.info().blocks.at(0).cell_count, 120U * 64U);
    bool said = false;
    for (const std::string& note : source.info().notes)
      said = said || note.find("collapsed") != std::string::npos;
    EXPECT_TRUE(said);
  }
}

TEST(Ex, HostileTextEndsWithOneLine) {
  const test::TempFolder folder;
  const std::string head = " Group name: heart\n Shape. Dimension=3\n";
  for (const std::string& text :
       {head + "#Scale factor sets= 4000000000\n", head + "#Nodes= 1e300\n", head + "#Fields=1\n",
        head + std::string(100'000, 'x'), head + std::string("#Fields=1\n\0\0\0", 13), head,
        head + "Element: 1 0 0\nNodes:\n"}) {
    const auto file = folder.write("h.exfile", text);
    expect_refused(file, "h.exfile");
  }
}

}  // namespace
}  // namespace palpate
