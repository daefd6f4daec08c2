// Fluent, GAMBIT and STAR-CD: a row of cubes, written by formula, and damaged files. Cells of every kind: flow_matrix_test.

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/load.h"
#include "loaders/cfd/cfd_check.h"
#include "loaders/cfd/fluent_faces.h"
#include "tests/support/refusal.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr int kCubes = 3;

int point_at(int i, int j, int k) { return 1 + i + (kCubes + 1) * (j + 2 * k); }

std::string places_of_points(bool numbered) {
  std::string out;
  for (int p = 0; p < 4 * (kCubes + 1); ++p) {
    const int i = p % (kCubes + 1), j = p / (kCubes + 1) % 2, k = p / (kCubes + 1) / 2;
    if (numbered) out += std::to_string(p + 1) + " ";
    out += std::to_string(i) + " " + std::to_string(j) + " " + std::to_string(k) + "\n";
  }
  return out;
}

std::string hex(int value) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%x", static_cast<unsigned>(value));
  return text.data();
}

/// Fluent's user guide, "Case and data file formats": faces with their two cells, the first on the side that a right
/// hand's thumb points away from.
/// @param polyhedra the cubes are polyhedra of polygons.
std::string fluent_case(const std::string& nodes = hex(4 * (kCubes + 1)), bool polyhedra = false) {
  std::string inner, outer;
  int of_inner = 0, of_outer = 0;
  const auto face = [&](std::array<int, 4> corners, int cell, int other) {
    std::string out = polyhedra ? "4 " : "";
    for (const int corner : corners) out += hex(corner) + " ";
    return out + hex(cell) + " " + hex(other) + "\n";
  };
  for (int c = 0; c < kCubes; ++c) {
    const auto at = [c](int a, int j, int k) { return point_at(c + a, j, k); };
    const std::array<std::array<int, 4>, 6> faces{{{at(1, 0, 1), at(1, 1, 1), at(1, 1, 0), at(1, 0, 0)},
                                                   {at(0, 1, 0), at(0, 1, 1), at(0, 0, 1), at(0, 0, 0)},
                                                   {at(0, 0, 1), at(1, 0, 1), at(1, 0, 0), at(0, 0, 0)},
                                                   {at(1, 1, 0), at(1, 1, 1), at(0, 1, 1), at(0, 1, 0)},
                                                   {at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 0)},
                                                   {at(0, 1, 1), at(1, 1, 1), at(1, 0, 1), at(0, 0, 1)}}};
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (f == 1 && c > 0) continue;
      const bool shared = f == 0 && c + 1 < kCubes;
      (shared ? inner : outer) += face(faces[f], c + 1, shared ? c + 2 : 0);
      (shared ? of_inner : of_outer) += 1;
    }
  }
  const std::string cells = hex(kCubes), faces = hex(of_inner + of_outer), of_faces = polyhedra ? "5" : "4";
  return "(0 \"a row of cubes\")\n(2 3)\n(10 (0 1 " + nodes + " 0 3))\n(10 (1 1 " + hex(4 * (kCubes + 1)) +
         " 1 3)(\n" + places_of_points(false) + "))\n(12 (0 1 " + cells + " 0))\n(12 (2 1 " + cells +
         (polyhedra ? " 1 7" : " 1 4") + "))\n(13 (0 1 " + faces + " 0))\n(13 (3 1 " + hex(of_inner) + " 2 " +
         of_faces + ")(\n" + inner + "))\n(13 (4 " + hex(of_inner + 1) + " " + faces + " 3 " + of_faces +
         ")(\n" + outer +
         "))\n(45 (2 fluid fluid-2)())\n(45 (3 interior default-interior)())\n(45 (4 wall wall-4)())\n";
}

double value_of(int variable, int cell) { return variable + 0.25 * cell; }

std::string fluent_values() {
  std::string out = "(0 \"a row of cubes\")\n(33 (3 16 16))\n";
  for (int variable = 0; variable < 3; ++variable) {
    out += "(300 (" + std::to_string(111 + variable) + " 2 1 0 0 1 3)(\n";
    for (int cell = 0; cell < kCubes; ++cell) out += exact_number(value_of(variable, cell)) + "\n";
    out += "))\n";
  }
  return out;
}

/// A row of cubes, whatever the order of their corners.
void expect_cubes(const DataSet& block) {
  const auto* const mesh = std::get_if<UnstructuredTopology>(&block.topology);
  ASSERT_NE(mesh, nullptr);
  ASSERT_EQ(mesh->types, (std::vector<std::uint8_t>(kCubes, 12)));
  for (int c = 0; c < kCubes; ++c) {
    const auto corner = [&](int n) {
      const auto p = static_cast<std::size_t>(mesh->connectivity[static_cast<std::size_t>(8 * c + n)]);
      return Vec3{mesh->positions.at(p, 0), mesh->positions.at(p, 1), mesh->positions.at(p, 2)};
    };
    Vec3 middle{0.0};
    for (int n = 0; n < 8; ++n) middle += corner(n) / 8.0;
    EXPECT_EQ(middle, (Vec3{c + 0.5, 0.5, 0.5}));
    const Vec3 a = corner(1) - corner(0), b = corner(3) - corner(0), up = corner(4) - corner(0);
    EXPECT_EQ(corner(2) - corner(0), a + b) << "around, not along rows";
    EXPECT_EQ(corner(6) - corner(0), a + b + up);
    EXPECT_EQ(glm::dot(glm::cross(a, b), up), 1.0);
  }
}

TEST(Fluent, CasesAreReadWithTheirValues) {
  const TempFolder folder;
  const auto file = folder.write("a.cas", fluent_case());
  (void)folder.write("a.dat", fluent_values());
  Source source = Source::open({{file}, {}});
  const auto blocks = source.read({"X_VELOCITY", "Y_VELOCITY", "Z_VELOCITY"});
  ASSERT_EQ(blocks.size(), 1U);
  expect_cubes(blocks[0]);
  for (int variable = 0; variable < 3; ++variable) {
    const DataArray* const array =
        blocks[0].find(std::string(1, "XYZ"[variable]) + "_VELOCITY", Association::kCell);
    ASSERT_NE(array, nullptr);
    for (int cell = 0; cell < kCubes; ++cell)
      EXPECT_EQ(array->at(static_cast<std::size_t>(cell)), value_of(variable, cell));
  }
}

// Each cube of its six faces, all seen from outside.
TEST(Fluent, PolyhedraHaveTheirFaces) {
  const TempFolder folder;
  const std::string text = fluent_case(hex(4 * (kCubes + 1)), true);
  const auto file = folder.write("a.cas", text);
  (void)folder.write("a.dat", fluent_values());
  Source source = Source::open({{file}, {}});
  const DataSet block = source.read({"X_VELOCITY"}).at(0);
  const auto& mesh = std::get<UnstructuredTopology>(block.topology);
  ASSERT_EQ(mesh.types, (std::vector<std::uint8_t>(kCubes, 42)));
  for (std::size_t c = 0; c < kCubes; ++c) {
    const Vec3 middle{static_cast<double>(c) + 0.5, 0.5, 0.5};
    auto at = static_cast<std::size_t>(mesh.offsets[c]);
    ASSERT_EQ(mesh.connectivity.at(at++), 6);
    Vec3 sides{0.0};
    for (int face = 0; face < 6; ++face) {
      ASSERT_EQ(mesh.connectivity.at(at++), 4);
      std::array<Vec3, 4> x;
      for (Vec3& corner : x) {
        const auto p = static_cast<std::size_t>(mesh.connectivity.at(at++));
        corner = {mesh.positions.at(p, 0), mesh.positions.at(p, 1), mesh.positions.at(p, 2)};
      }
      const Vec3 normal = glm::cross(x[1] - x[0], x[2] - x[0]);
      const Vec3 outwards = 0.5 * (x[0] + x[2]) - middle;
      EXPECT_EQ(normal, 2.0 * outwards) << "cube " << c << ", face " << face;
      sides += glm::abs(outwards);
    }
    EXPECT_EQ(sides, Vec3{1.0});
    EXPECT_EQ(static_cast<std::int64_t>(at), mesh.offsets[c + 1]);
  }
  EXPECT_EQ(read_fluent_faces(text).cells.size(), 16U);
  std::string hanging = text;
  hanging.insert(hanging.find("(45 (2"), "(59 (1 1 4 3)(2 5 6))\n");
  Source parted = Source::open({{folder.write("a.cas", hanging)}, {}});
  EXPECT_THROW((void)parted.read({"X_VELOCITY"}), Error);
  EXPECT_NE(read_fluent_faces(hanging).problem.find("hanging nodes"), std::string::npos);
  EXPECT_NE(read_fluent_faces("(13 (3 1 2 2 5)(\n4 1 2 3 4 1 0))").problem.find("fewer faces"),
            std::string::npos);
  EXPECT_NE(read_fluent_faces("(13 (3 1 1 2 5)(\nfffffff 1 2))").problem.find("a face of 268435455"),
            std::string::npos);
}

TEST(Fluent, WhatIsMissingOrClaimedIsSaid) {
  const TempFolder folder;
  EXPECT_NE(refusal(folder.write("alone.cas", fluent_case())).find("alone.dat"), std::string::npos);
  const auto claims = folder.write("claims.cas", fluent_case("ffffffff"));
  (void)folder.write("claims.dat", fluent_values());
  EXPECT_NE(refusal(claims).find("claims 4294967295 nodes"), std::string::npos);
  EXPECT_NE(refusal(folder.write("b.dat", fluent_values())).find(".cas"), std::string::npos);
  EXPECT_EQ(fluent_problem(fluent_case()), "");
  EXPECT_NE(fluent_problem("(12 (0 1))\n"), "");
  EXPECT_NE(fluent_problem("(3013(4 1 ffffff 3 4)("), "");
}

TEST(Fluent, SectionsThatDoNotEndAreRefusedAtOnce) {
  const std::string words = "\nEnd of Binary Section   3010)\n";
  EXPECT_EQ(fluent_problem("(0 \"a\")\n(3010 (1 1 2 1 3)(()((" + words + "(2 3)\n"), "");
  EXPECT_NE(fluent_problem("(3010 (1 1 2 1 3)(()((\nEnd of Bin").find("3010 that does not end"),
            std::string::npos);
  EXPECT_NE(fluent_problem("(2013(a 1 2 2 4)(" + words).find("a blank behind"), std::string::npos);
  const TempFolder folder;
  const std::string whole = fluent_case(), values = fluent_values();
  constexpr std::size_t kStep = 31;
  for (std::size_t size = whole.find("(13 (4 ") + kStep; size + 4 < whole.find("(45 (2"); size += kStep) {
    (void)folder.write("cut.dat", values);
    EXPECT_NE(refusal(folder.write("cut.cas", whole.substr(0, size))).find("not end"), std::string::npos)
        << size;
  }
  (void)folder.write("cut.dat", values.substr(0, values.size() - 9));
  EXPECT_NE(refusal(folder.write("cut.cas", whole)).find("cut.dat"), std::string::npos);
}

/// A row of cubes. @param first number of the first node; @param step from one to the next.
std::string gambit_cubes(int first, int step, const std::string& end) {
  const auto node = [&](int p) { return first + step * (p - 1); };
  std::string out =
      "        CONTROL INFO 2.4.6\n** GAMBIT NEUTRAL FILE\nmade\nPROGRAM: Gambit VERSION: 2.4.6\nJan 2020\n"
      " NUMNP NELEM NGRPS NBSETS NDFCD NDFVL\n " +
      std::to_string(4 * (kCubes + 1)) + " " + std::to_string(kCubes) +
      " 1 0 3 3\nENDOFSECTION\n   NODAL COORDINATES 2.4.6\n";
  for (int p = 1; p <= 4 * (kCubes + 1); ++p) {
    const int i = (p - 1) % (kCubes + 1), j = (p - 1) / (kCubes + 1) % 2, k = (p - 1) / (kCubes + 1) / 2;
    out += std::to_string(node(p)) + " " + std::to_string(i) + " " + std::to_string(j) + " " +
           std::to_string(k) + "\n";
  }
  out += "ENDOFSECTION\n      ELEMENTS/CELLS 2.4.6\n";
  for (int c = 0; c < kCubes; ++c) {
    out += std::to_string(c + 1) + " 4 8";
    for (const int k : {0, 1}) {
      for (const int j : {0, 1}) {
        for (const int a : {0, 1}) out += " " + std::to_string(node(point_at(c + a, j, k)));
      }
    }
    out += "\n";
  }
  out +=
      "ENDOFSECTION\n       ELEMENT GROUP 2.4.6\nGROUP: 1 ELEMENTS: 3 MATERIAL: 2 NFLAGS: 1\nfluid\n0\n1 2 3\nENDOFSECTION\n";
  std::string with_end;
  for (const char c : out) with_end += c == '\n' ? end : std::string(1, c);
  return with_end;
}

TEST(Gambit, NodesAreThoseOfTheirNumbersOrRefused) {
  const TempFolder folder;
  for (const std::string end : {"\n", "\r\n"}) {
    Source source = Source::open({{folder.write("a.neu", gambit_cubes(1, 1, end))}, {}});
    expect_cubes(source.read({}).at(0));
  }
  const int last = 4 * (kCubes + 1);
  EXPECT_NE(refusal(folder.write("b.neu", gambit_cubes(last, -1, "\n"))).find("numbers a node '16', not 1"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("c.neu", gambit_cubes(1, 10, "\n"))).find("numbers a node '11', not 2"),
            std::string::npos);
}

TEST(Gambit, HeadsAreHeldAgainstTheFile) {
  EXPECT_NE(gambit_problem(""), "");
  const std::string head = "        CONTROL INFO 2.3.16\n NUMNP NELEM NGRPS NBSETS NDFCD NDFVL\n";
  EXPECT_NE(gambit_problem(head + " 4000000 1 1 0 3 3\n").find("4000000"), std::string::npos);
  EXPECT_NE(gambit_problem(head + " 4 1 1\n").find("3 counts"), std::string::npos);
  EXPECT_NE(
      gambit_problem(head + " 4 1 1 0 3 3\nENDOFSECTION\n NODAL COORDINATES 2.3.16\n").find("ends before"),
      std::string::npos);
}

TEST(StarCd, MeshesAreRead) {
  const TempFolder folder;
  const auto file = folder.write("a.vrt", "PROSTAR_VERTEX\n 4000 0 0 0 0 0 0 0\n" + places_of_points(true));
  EXPECT_NE(refusal(file).find("a.cel"), std::string::npos);
  std::string cells = "PROSTAR_CELL\n 4000 0 0 0 0 0 0 0\n";
  for (int c = 0; c < kCubes; ++c) {
    cells += std::to_string(c + 1) + " 11 8 1 1\n" + std::to_string(c + 1);
    for (const int k : {0, 1}) {
      for (const auto& [a, j] : std::array<std::pair<int, int>, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}})
        cells += " " + std::to_string(point_at(c + a, j, k));
    }
    cells += "\n";
  }
  (void)folder.write("a.cel", cells);
  for (const char* const half : {"a.vrt", "a.cel"}) {
    Source source = Source::open({{folder.path(half)}, {}});
    expect_cubes(source.read({}).at(0));
    EXPECT_NE(source.info().notes.at(0).find("mesh alone"), std::string::npos);
  }
}

}  // namespace
}  // namespace palpate::test
