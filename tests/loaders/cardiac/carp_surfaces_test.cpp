// Surfaces of openCARP's meshes (.surf, .vtx) through the helper program.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/load.h"
#include "tests/support/refusal.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

class CarpSurfaces : public testing::Test {
 protected:
  CarpSurfaces() {
    folder_.write("m.pts", "6\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n1000 0 1000\n0 1000 1000\n");
    folder_.write("m.elem", "1\nPr 0 1 2 3 5 4 7\n");
  }
  [[nodiscard]] Source open(const std::vector<std::string>& names = {"m.pts"}) const {
    LoadRequest request;
    for (const std::string& name : names) request.files.push_back(folder_.path(name));
    return Source::open(request);
  }
  /// The array "surface"; empty: there is none.
  [[nodiscard]] std::vector<double> surface(const std::vector<std::string>& names = {"m.pts"}) const {
    Source source = open(names);
    const auto blocks = source.read({"surface"});
    const DataArray* const array = blocks.at(0).find("surface", Association::kPoint);
    std::vector<double> values;
    for (std::size_t p = 0; array != nullptr && p < array->tuples; ++p) values.push_back(array->at(p));
    return values;
  }
  [[nodiscard]] bool says(const std::string& word, const std::vector<std::string>& names = {"m.pts"}) const {
    const Source source = open(names);
    for (const std::string& note : source.info().notes)
      if (note.find(word) != std::string::npos) return true;
    return false;
  }
  test::TempFolder folder_;
};

TEST_F(CarpSurfaces, AreFoundBesideTheMeshByTheirNames) {
  EXPECT_EQ(surface(), std::vector<double>());
  folder_.write("m.lvendo.surf", "1\nTr 0 1 2 9\n");
  EXPECT_TRUE(says("is left out: surfaces are taken from files where one is an endocardium"));
  EXPECT_EQ(surface(), std::vector<double>());
  folder_.write("m_epi.surf", "1\nTr 3 4 5\n");
  EXPECT_EQ(surface(), (std::vector<double>{1, 1, 1, 2, 2, 2}));
  EXPECT_TRUE(says("m_epi.surf is the epicardium, by its name: 1 triangle"));
  // Points of two surfaces are of the endocardium; the points of a .surf are not read again.
  folder_.write("m.base.vtx", "2\nextra\n2\n5\n");
  folder_.write("m.lvendo.surf.vtx", "1\nintra\n99\n");
  folder_.write("m.stimulus.vtx", "1\nintra\n0\n");
  folder_.write("other.rvendo.vtx", "1\nintra\n0\n");
  for (const char* none : {"m.nerve.vtx", "m.baseline.vtx"}) folder_.write(none, "1\nextra\n4\n");
  EXPECT_EQ(surface(), (std::vector<double>{1, 1, 1, 2, 2, 2}));
  for (const char* none : {"stimulus", "nerve", "baseline"}) EXPECT_FALSE(says(none)) << none;
}

TEST_F(CarpSurfaces, EachNameIsASurface) {
  const std::vector<std::string> files{"m.pts",    "lv.vtx",  "RV_endo.vtx", "rv_sept.vtx",
                                       "epic.vtx", "top.vtx", "base.vtx"};
  for (std::size_t i = 1; i < files.size(); ++i)
    folder_.write(files[i], "1\nextra\n" + std::to_string(i - 1) + "\n");
  EXPECT_EQ(surface(files), (std::vector<double>{1, 3, 4, 2, 0, 5}));
  EXPECT_TRUE(says("top.vtx does not say in its name", files));
}

TEST_F(CarpSurfaces, CountFromOneWhereTheMeshDoes) {
  folder_.write("m.elem", "1\nPr 1 2 3 4 6 5 7\n");
  folder_.write("m.endo.surf", "1\nTr 1 2 3\n");
  folder_.write("m.epi.vtx", "3\n4\n5\n6\n");
  EXPECT_EQ(surface(), (std::vector<double>{1, 1, 1, 2, 2, 2}));
}

// Rows of meshtool: three points, the region of the element, its other point, its number.
TEST_F(CarpSurfaces, TrianglesThatCarryLoadsAreSurfacesToo) {
  folder_.write("m.endo.neubc", "1 # mesh elast 1 6 :\n0 1 2 1 3 0\n");
  folder_.write("m.epi.neubc", "1 # mesh elast 1 6 :\n3 4 5 1 0 0\n");
  EXPECT_EQ(surface(), (std::vector<double>{1, 1, 1, 2, 2, 2}));
  EXPECT_TRUE(says("m.endo.neubc is the endocardium, by its name: 1 triangle"));
  folder_.write("m.endo.surf", "1\nTr 0 1 2\n");
  EXPECT_FALSE(says("m.endo.neubc"));  // the same triangles
  folder_.write("m.epi.neubc", "1\n3 4 5 1 0\n");
  test::expect_refused([this] { return open(); }, {"m.epi.neubc", "line 2: has a row of 5 numbers"});
  folder_.write("m.epi.neubc", "1\n3 4 6 1 0 0\n");
  test::expect_refused([this] { return open(); }, {"m.epi.neubc", "has \"6\""});
}

TEST_F(CarpSurfaces, TheNameOfTheMeshSaysNothing) {
  folder_.write("epi.pts", "4\n0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n");
  folder_.write("epi.elem", "1\nTt 0 1 2 3 1\n");
  folder_.write("epi.endo.vtx", "1\n0\n");
  folder_.write("epi.epi.vtx", "1\n3\n");
  EXPECT_EQ(surface({"epi.pts"}), (std::vector<double>{1, 0, 0, 2}));
}

TEST_F(CarpSurfaces, WhatIsNoneOfTheMeshIsRefused) {
  folder_.write("m.epi.vtx", "3\n3\n4\n5\n");
  for (const auto& [text, word] : std::vector<std::pair<std::string, std::string>>{
           {"1\nTr 0 1 6\n", "line 2: has \"6\""},
           {"1\nTr 0 1\n", "line 2: has \"\""},
           {"1\nTt 0 1 2 3\n", "line 2: begins with \"Tt\""},
           {"2\nTr 0 1 2\n", "ends after 1 triangle"},
           {"1\nTr 0 1 2\nTr 0 1 2\n", "goes on after 1 triangle"}}) {
    folder_.write("m.endo.surf", text);
    test::expect_refused([this] { return open(); }, {word});
  }
}

}  // namespace
}  // namespace palpate
