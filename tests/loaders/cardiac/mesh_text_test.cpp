// openCARP, TetGen and Chaste meshes through the helper program.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

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

/// A .igb file of four points; `big` in the other byte order than x86.
std::string igb(const std::string& words, const std::vector<float>& values, bool big) {
  std::string file = "# made by a test\r\n" + words +
                     " type:float systeme:" + (big ? "big_endian" : "little_endian") + "\r\n";
  file.resize(1023, ' ');
  file += '\f';
  for (const float value : values) {
    std::array<char, sizeof value> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    if (big) std::reverse(bytes.begin(), bytes.end());
    file.append(bytes.data(), bytes.size());
  }
  return file;
}

class CarpResults : public testing::Test {
 protected:
  CarpResults() {
    folder_.write("m.pts", "4\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n");
    folder_.write("m.elem", "1\nTt 0 1 2 3 9\n");
  }
  [[nodiscard]] Source together(const std::string& result) const {
    return Source::open({.files = {folder_.path("m.pts"), folder_.path(result)}, .solution = {}, .raw = {}});
  }
  void expect_result_refused(const std::string& name, const std::string& content,
                             const std::string& word) const {
    folder_.write(name, content);
    try {
      (void)together(name);
      ADD_FAILURE() << word << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
  test::TempFolder folder_;
};

TEST_F(CarpResults, PotentialsAreReadAStepAtATime) {
  const std::vector<float> values{-85.0F, -80.0F, NAN, 20.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F};
  for (const bool big : {false, true}) {
    folder_.write(
        "vm.igb",
        igb("x:4 y:1 z:1 t:3 org_t:10 dim_t:4 inc_t:2 units_t:ms unites:mV facteur:2 zero:1", values, big));
    Source source = together("vm.igb");
    EXPECT_EQ(source.info().times, (std::vector<double>{10.0, 12.0, 14.0}));
    for (const std::size_t step : {2U, 0U, 1U}) {  // in any order
      const auto blocks = source.read({"vm"}, step);
      const DataArray* vm = blocks.at(0).find("vm", Association::kPoint);
      ASSERT_NE(vm, nullptr);
      for (std::size_t p = 0; p < 4; ++p) {
        const double stored = static_cast<double>(values[4 * step + p]);
        if (std::isnan(stored))
          EXPECT_TRUE(std::isnan(vm->at(p)));
        else
          EXPECT_DOUBLE_EQ(vm->at(p), 2.0 * stored + 1.0) << step << " " << p;
      }
    }
  }
  // One of the mesh's own name comes along without being named.
  folder_.write("m.igb", igb("x:4 t:3", values, false));
  EXPECT_EQ(open(folder_.path("m.elem")).info().times.size(), 3U);
}

TEST_F(CarpResults, HeadersThatDoNotFitAreNamed) {
  const std::vector<float> values(12, 1.0F);
  expect_result_refused("a.igb", igb("x:5 t:2", values, false), "4");
  expect_result_refused("b.igb", igb("x:4 t:4", values, false), "time steps");
  expect_result_refused("c.igb", igb("x:4 t:1000000000000", values, false), "time steps");
  expect_result_refused("d.igb", igb("x:4 t:3 inc_t:-1", values, false), "rise");
  expect_result_refused("e.igb", igb("x:4 t:3 inc_t:0", values, false), "rise");
  expect_result_refused("f.igb", igb("x:4 t:nan", values, false), "t:");
  expect_result_refused("g.igb", igb("x:4 t:3", values, false).substr(0, 500), "1024");
}

TEST_F(CarpResults, ActivationTimesAreANumberALine) {
  folder_.write("act.dat", "1.5\nnan\n-2\n1e3\n");
  Source source = together("act.dat");
  EXPECT_TRUE(source.info().times.empty());
  const auto blocks = source.read({"act"});
  const DataArray* act = blocks.at(0).find("act", Association::kPoint);
  ASSERT_NE(act, nullptr);
  EXPECT_EQ(act->at(0), 1.5);
  EXPECT_TRUE(std::isnan(act->at(1)));
  EXPECT_EQ(act->at(3), 1000.0);
  folder_.write("strain.dat", "0.25\n");
  Source of_cells = together("strain.dat");
  const auto cell_blocks = of_cells.read({"strain"});
  EXPECT_NE(cell_blocks.at(0).find("strain", Association::kCell), nullptr);
  expect_result_refused("short.dat", "1\n2\n3\n", "ends after 3");
  expect_result_refused("long.dat", "1\n2\n3\n4\n5\n", "line 5");
  expect_result_refused("word.dat", "1\n2\n3\n4\nx\n", "line 5");
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
