// Surfaces of a wall that groups of an EX model name: of a box whose first axis goes through the wall.
#include "loaders/cardiac/ex/ex_groups.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/data_set.h"
#include "loaders/cardiac/ex/ex_mesh.h"
#include "loaders/cardiac/ex/ex_values.h"
#include "tests/loaders/cardiac/ex_box.h"

namespace palpate::ex {
namespace {

constexpr std::array<Vec3, 8> kCorners{
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}};

/// The box with all its faces numbered, 11 to 16.
SampledModel box(const std::string& more_nodes, const std::string& more_elements) {
  const test::TempFolder folder;
  std::string elements = element_file("rectangular cartesian"), faces;
  for (int face = 11; face <= 16; ++face) faces += "   0 " + std::to_string(face) + " 0\n";
  const std::string one = "   0 1 0\n";
  elements.replace(elements.find(one), one.size(), faces);
  return sample(made(folder, node_file("rectangular cartesian", kCorners, {0.5}) + more_nodes,
                     elements + more_elements),
                4, "box", 1ULL << 30U);
}

/// Whether the array "surface" has `inner` where x is 0, 2 where it is 1, and 0 between.
void expect_surfaces(const SampledModel& model, double inner) {
  const auto& topology = std::get<UnstructuredTopology>(model.mesh.topology);
  const DataArray* const surface = model.mesh.find("surface", Association::kPoint);
  ASSERT_NE(surface, nullptr);
  for (std::size_t p = 0; p < surface->tuples; ++p) {
    const double x = topology.positions.at(p, 0);
    ASSERT_EQ(surface->at(p), x == 0.0 ? inner : x == 1.0 ? 2.0 : 0.0) << x;
  }
  EXPECT_EQ(model.mesh.find("layer", Association::kPoint), nullptr)
      << "the third axis does not go through this wall";
}

TEST(ExGroups, OfNodesNameTheSurfacesOfAWall) {
  const std::string empty = " #Fields=0\n";
  expect_surfaces(box(" Group name: LV endocardium\n" + empty +
                          " Node: 1\n Node: 3\n Node: 5\n Node: 7\n Group name: epicardium\n" + empty +
                          " Node: 2\n Node: 4\n Node: 6\n Node: 8\n Group name: apex\n" + empty +
                          " Node: 1\n Node: 2\n Node: 3\n Node: 4\n",
                      ""),
                  1.0);
}

TEST(ExGroups, OfFacesNameTheSurfacesOfAWall) {
  const std::string head = "\n Shape. Dimension=2\n #Scale factor sets=0\n #Nodes=0\n #Fields=0\n";
  const SampledModel model =
      box("", " Group name: endocardium of right ventricle" + head +
                  " Element: 0 11 0\n Group name: epicardium" + head + " Element: 0 12 0\n");
  expect_surfaces(model, 3.0);
  bool said = false;
  for (const std::string& note : model.notes)
    said = said || note.find(
                       "group 'endocardium of right ventricle' is the right endocardium, by its "
                       "name: 1 face") != std::string::npos;
  EXPECT_TRUE(said);
}

// From version 2 on faces have one number.
TEST(ExGroups, NumbersOfFacesAreReadInBothWays) {
  const test::TempFolder folder;
  for (const bool triples : {true, false}) {
    const auto file = folder.write(
        "faces", triples ? "Faces: 0 5 0\n 0 6 0\n\n0 7 0\nNodes:\n" : "Faces:\n 5 6\n7\nNodes:\n");
    TextLines lines(file.string());
    ASSERT_TRUE(lines.next());
    EXPECT_EQ(faces_of(lines, triples), (std::vector<std::int64_t>{5, 6, 7}));
    ASSERT_TRUE(lines.next());
    EXPECT_EQ(lines.line(), "Nodes:");
  }
}

TEST(ExGroups, WithoutBothTheThirdAxisSays) {
  const SampledModel model =
      box(" Group name: endo\n #Fields=0\n Node: 1\n Node: 3\n Node: 5\n Node: 7\n", "");
  const DataArray* const surface = model.mesh.find("surface", Association::kPoint);
  ASSERT_NE(surface, nullptr);
  const auto& topology = std::get<UnstructuredTopology>(model.mesh.topology);
  for (std::size_t p = 0; p < surface->tuples; ++p) {
    const double z = topology.positions.at(p, 2);
    ASSERT_EQ(surface->at(p), z == 0.0 ? 1.0 : z == 1.0 ? 2.0 : 0.0);
  }
  EXPECT_NE(model.mesh.find("layer", Association::kPoint), nullptr);
  EXPECT_TRUE(std::ranges::any_of(model.notes, [](const std::string& note) {
    return note.find("groups that name a surface are left out") != std::string::npos;
  }));
}

}  // namespace
}  // namespace palpate::ex
