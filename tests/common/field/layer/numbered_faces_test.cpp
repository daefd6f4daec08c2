// Which surfaces of a wall the numbers and names of a file's faces mean.
#include "common/field/layer/numbered_faces.h"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

/// Two tetrahedra on a triangle, which is in the file, too, as the border's faces are: some by triangles, one by a
/// quadrilateral, and an edge.
UnstructuredTopology mesh() {
  UnstructuredTopology cells;
  cells.types = {10, 5, 5, 9, 3, 10};
  cells.offsets = {0, 4, 7, 10, 14, 16, 20};
  cells.connectivity = {0, 1, 2, 3, 0, 1, 2, 0, 1, 3, 1, 2, 4, 3, 0, 4, 1, 2, 3, 4};
  const std::vector<double> x{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
  cells.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
  return cells;
}
DataArray numbers(const std::vector<double>& values, const char* name = "facet") {
  return make_array(name, Association::kCell, 1, std::span<const double>(values));
}
bool says(const std::vector<std::string>& notes, const std::string& text) {
  for (const std::string& note : notes)
    if (note.find(text) != std::string::npos) return true;
  return false;
}
using Tags = std::vector<double>;

TEST(NumberedFaces, NamesAreOfSurfacesByTheirParts) {
  for (const auto& [name, role] :
       std::vector<std::pair<std::string, BorderRole>>{{"Epicardium", BorderRole::kOuter},
                                                       {"endo_lv", BorderRole::kInner},
                                                       {"LV", BorderRole::kInner},
                                                       {"RV-endo", BorderRole::kRight},
                                                       {"right endocardium", BorderRole::kRight},
                                                       {"rvsept", BorderRole::kSeptum},
                                                       {"lv_septum", BorderRole::kInner},
                                                       {"base", BorderRole::kBase},
                                                       {"nerve", BorderRole::kLeft},
                                                       {"baseline", BorderRole::kLeft},
                                                       {"inlet", BorderRole::kLeft},
                                                       {"", BorderRole::kLeft}})
    EXPECT_EQ(role_of_name(name), role) << name;
  for (int tag = 1; tag < kBorderRoleCount; ++tag)
    EXPECT_EQ(tag_of(role_of_name(name_of(role_of_tag(tag)))), tag);
}

TEST(NumberedFaces, FacesAreCellsOfTwoDimensionsWithAWholeNumber) {
  EXPECT_EQ(faces_of_mesh(mesh(), numbers({7, 1, 2, 3, 4, 7})).numbers, (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(faces_of_mesh(mesh(), numbers({7, 1.5, 0, -3, 4, 7})).numbers, std::vector<std::int64_t>{-3});
  UnstructuredTopology shell = mesh();
  shell.types = {9, 5, 5, 9, 3, 9};
  EXPECT_TRUE(faces_of_mesh(shell, numbers({1, 2, 3, 4, 5, 6})).numbers.empty());
  EXPECT_EQ(face_array({{"region", Association::kCell, 1, ScalarType::kInt32, 6},
                        {"Facet", Association::kPoint, 1, ScalarType::kInt32, 5},
                        {"surface", Association::kCell, 1, ScalarType::kInt32, 6}}),
            "surface");
  EXPECT_EQ(face_array({{"pressure", Association::kCell, 1, ScalarType::kInt32, 6}}), "");
  EXPECT_EQ(face_array({{"Medit:Ref", Association::kCell, 1, ScalarType::kInt32, 6}}), "Medit:Ref");
}

TEST(NumberedFaces, WhatIsAskedForIsTakenAndTheRestIsSaid) {
  DataSet block;
  block.topology = mesh();
  block.arrays = {numbers({7, 10, 20, 30, 5, 7})};
  std::vector<std::string> notes;
  EXPECT_EQ(surfaces_of_cells(block, "facet", "a.vtu", "", notes), Tags());
  EXPECT_TRUE(says(notes, "3 faces of the border with the numbers 10, 20, 30 of 'facet'"));
  EXPECT_TRUE(says(notes, "--surface-markers INNER/OUTER"));
  notes.clear();
  // Points of both are inner ones.
  EXPECT_EQ(surfaces_of_cells(block, "facet", "a.vtu", "20/30", notes), (Tags{1, 1, 2, 1, 2}));
  EXPECT_TRUE(says(notes, "number 20 of 'facet' is the endocardium: 1 face"));
  EXPECT_TRUE(says(notes, "number 30 of 'facet' is the epicardium: 1 face"));
  EXPECT_TRUE(says(notes, "numbers 10 of 'facet' are of no surface"));
  EXPECT_TRUE(says(notes, "2 points on both surfaces: taken as inner"));
  EXPECT_EQ(surfaces_of_cells(block, "facet", "a.vtu", "20/30/10", notes), (Tags{1, 1, 3, 1, 2}));
  for (const char* wrong : {"20", "20/31", "20/20", "20,30/30", "/30", "1/2/3/4/5", "2e300/30"}) {
    try {
      (void)surfaces_of_cells(block, "facet", "a.vtu", wrong, notes);
      ADD_FAILURE() << wrong;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kUsage);
      EXPECT_NE(std::string(error.what()).find("a.vtu has the markers 10, 20, 30"), std::string::npos)
          << error.what();
    }
  }
  // Points of a face alone stand for those of the mesh at their places.
  UnstructuredTopology apart = mesh();
  std::vector<double> x;
  for (std::size_t p = 0; p < 5; ++p)
    for (int axis = 0; axis < 3; ++axis) x.push_back(apart.positions.at(p, axis));
  x.insert(x.end(), {0, 0, 0, 1, 0, 0, 0, 0, 1});
  apart.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
  std::copy_n(std::vector<std::int64_t>{5, 6, 7}.begin(), 3, apart.connectivity.begin() + 7);
  block.topology = apart;
  EXPECT_EQ(surfaces_of_cells(block, "facet", "a.vtu", "20/30", notes), (Tags{1, 1, 2, 1, 2, 1, 1, 1}));
  block.topology = mesh();
  // The numbers of an array that is called so are those of the point array.
  block.arrays = {numbers({7, 3, 1, 2, 5, 7}, "surface")};
  EXPECT_EQ(surfaces_of_cells(block, "surface", "a.vtu", "", notes), (Tags{1, 1, 3, 1, 2}));
}

}  // namespace
}  // namespace palpate
