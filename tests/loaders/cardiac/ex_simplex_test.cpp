// EX models of tetrahedra and wedges, linear and quadratic, against the polynomials that they hold.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/field_grid.h"
#include "loaders/cardiac/ex/ex_mesh.h"
#include "loaders/cardiac/ex/ex_reader.h"
#include "tests/support/temp_folder.h"

namespace palpate::ex {
namespace {

/// Cubes beside each other along x, each parted as `basis` says: nodes of its lattice, and elements over them.
struct Parted {
  std::string shape, basis;
  int degree = 1;
  /// Of one cube, in the order of EX: the first axis fastest. In units of half a cube.
  std::vector<std::vector<std::array<int, 3>>> elements;
};

std::vector<std::array<int, 3>> between(const std::vector<std::array<double, 3>>& parts,
                                        const std::vector<std::array<int, 3>>& corners) {
  std::vector<std::array<int, 3>> nodes;
  for (const auto& part : parts) {
    std::array<double, 3> at{};
    const std::array<double, 4> share{1.0 - part[0] - part[1] - part[2], part[0], part[1], part[2]};
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t a = 0; a < 3; ++a) at[a] += share[c] * corners[c][a];
    nodes.push_back({static_cast<int>(std::lround(at[0])), static_cast<int>(std::lround(at[1])),
                     static_cast<int>(std::lround(at[2]))});
  }
  return nodes;
}

/// Six tetrahedra about a diagonal.
Parted tetrahedra(int degree) {
  Parted made{
      .shape = "simplex(2;3)*simplex*simplex",
      .basis = degree == 1 ? "l.simplex(2;3)*l.simplex*l.simplex" : "q.simplex(2;3)*q.simplex*q.simplex",
      .degree = degree,
      .elements = {}};
  std::vector<std::array<double, 3>> parts;
  for (int k = 0; k <= degree; ++k)
    for (int j = 0; j + k <= degree; ++j)
      for (int i = 0; i + j + k <= degree; ++i)
        parts.push_back({1.0 * i / degree, 1.0 * j / degree, 1.0 * k / degree});
  for (const auto& order : std::array<std::array<std::size_t, 3>, 6>{
           {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}}) {
    std::vector<std::array<int, 3>> corners{{0, 0, 0}};
    for (const std::size_t axis : order) {
      corners.push_back(corners.back());
      corners.back()[axis] = 2;
    }
    made.elements.push_back(between(parts, corners));
  }
  return made;
}

/// Two wedges, along the axis that is not linked.
Parted wedges(std::size_t free) {
  const std::size_t p = free == 0 ? 1 : 0, q = free == 2 ? 1 : 2;
  std::array<std::string, 3> shape{"line", "line", "line"}, basis{"l.Lagrange", "l.Lagrange", "l.Lagrange"};
  shape[p] = "simplex(" + std::to_string(q + 1) + ")";
  shape[q] = "simplex";
  basis[p] = "l.simplex(" + std::to_string(q + 1) + ")";
  basis[q] = "l.simplex";
  Parted made{.shape = shape[0] + "*" + shape[1] + "*" + shape[2],
              .basis = basis[0] + "*" + basis[1] + "*" + basis[2],
              .degree = 1,
              .elements = {}};
  for (const bool first : {true, false}) {
    std::vector<std::array<int, 3>> nodes;
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const std::array<int, 3> xi{i, j, k};
          if (xi[p] + xi[q] > 1) continue;
          std::array<int, 3> at{2 * xi[0], 2 * xi[1], 2 * xi[2]};
          if (!first) {
            at[p] = 2 - at[p];
            at[q] = 2 - at[q];
          }
          nodes.push_back(at);
        }
    made.elements.push_back(nodes);
  }
  return made;
}

using Function = std::function<double(const Vec3&)>;

/// Two cubes of side one as an EX file. @param bend of the places, along z.
std::string text_of(const Parted& parted, const Function& pressure, const Function& bend) {
  std::map<std::array<int, 3>, int> number;
  std::string elements;
  for (int cube = 0; cube < 2; ++cube)
    for (const auto& nodes : parted.elements) {
      elements += "Element: " + std::to_string(1 + std::count(elements.begin(), elements.end(), 'E')) +
                  " 0 0\n Nodes:\n";
      for (std::array<int, 3> at : nodes) {
        at[0] += 2 * cube;
        elements +=
            " " + std::to_string(number.try_emplace(at, static_cast<int>(number.size()) + 1).first->second);
      }
      elements += "\n";
    }
  std::string text =
      "EX Version: 2\nRegion: /\n!#nodeset nodes\nShape. Dimension=0\n#Fields=2\n1) coordinates, coordinate, "
      "rectangular cartesian, real, #Components=3\n x. #Values=1 (value)\n y. #Values=1 (value)\n z. #Values=1 "
      "(value)\n2) pressure, field, rectangular cartesian, real, #Components=1\n 1. #Values=1 (value)\n";
  for (const auto& [at, n] : number) {
    const Vec3 x{0.5 * at[0], 0.5 * at[1], 0.5 * at[2]};
    char line[200];
    std::snprintf(line, sizeof line, "Node: %d\n %.15g %.15g %.15g\n %.15g\n", n, x.x, x.y, x.z + bend(x),
                  pressure(x));
    text += line;
  }
  const std::string count = std::to_string(parted.elements.front().size());
  const auto component = [&](const std::string& name) {
    std::string lines =
        " " + name + ". " + parted.basis + ", no modify, standard node based.\n  #Nodes=" + count + "\n";
    for (std::size_t n = 1; n <= parted.elements.front().size(); ++n)
      lines += "  " + std::to_string(n) + ". #Values=1\n   Value labels: value\n";
    return lines;
  };
  return text + "!#mesh mesh3d, dimension=3, nodeset=nodes\nShape. Dimension=3, " + parted.shape +
         "\n#Scale factor sets=0\n#Nodes=" + count +
         "\n#Fields=2\n1) coordinates, coordinate, rectangular cartesian, real, #Components=3\n" +
         component("x") + component("y") + component("z") +
         "2) pressure, field, rectangular cartesian, real, #Components=1\n" + component("1") + elements;
}

struct Read {
  Model model;
  SampledModel sampled;
};
Read read(const std::string& text, int refine) {
  const test::TempFolder folder;
  Read made;
  read_ex_file(folder.write("a.exf", text).string(), made.model);
  made.sampled = sample(made.model, refine, "a.exf");
  return made;
}

double none(const Vec3&) { return 0.0; }
double linear(const Vec3& x) { return 80.0 + 3.0 * x.x - 5.0 * x.y + 7.0 * x.z; }
double quadratic(const Vec3& x) { return linear(x) + x.x * x.x - 2.0 * x.y * x.z + 4.0 * x.z * x.x; }

/// Cells that neighbours share all faces of, and values that are the polynomial's.
void expect_whole(const Read& read, const Function& pressure, const Function& bend, const std::string& what) {
  const DataArray* array = read.sampled.mesh.find("pressure", Association::kPoint);
  ASSERT_NE(array, nullptr) << what;
  const auto& positions = std::get<UnstructuredTopology>(read.sampled.mesh.topology).positions;
  for (std::size_t p = 0; p < array->tuples; ++p) {
    Vec3 x{positions.at(p, 0), positions.at(p, 1), positions.at(p, 2)};
    x.z -= bend(x);  // of x and y alone
    EXPECT_NEAR(array->at(p), pressure(x), 1e-10) << what;
  }
  const auto grid = make_field_grid(std::span(&read.sampled.mesh, 1), "a.exf", 1);
  double volume = 0.0;
  std::map<std::array<std::uint32_t, 3>, int> faces;
  for (const auto& tet : grid->tets->cells()) {
    const auto at = [&](std::size_t c) { return grid->frame.data_from_local(grid->tets->points()[tet[c]]); };
    volume += glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) / 6.0;
    for (std::size_t f = 0; f < 4; ++f) {
      std::array<std::uint32_t, 3> face{tet[(f + 1) % 4], tet[(f + 2) % 4], tet[(f + 3) % 4]};
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  }
  EXPECT_NEAR(volume, 2.0, 1e-9) << what;
  std::size_t border = 0;
  for (const auto& [face, count] : faces) border += count == 1 ? 1 : 0;
  std::size_t in_planes = 0;
  for (const auto& [face, count] : faces) {
    if (count != 1) continue;
    for (int a = 0; a < 3; ++a)
      for (const double plane : {0.0, a == 0 ? 2.0 : 1.0}) {
        const bool all = std::ranges::all_of(face, [&](std::uint32_t c) {
          Vec3 x = grid->frame.data_from_local(grid->tets->points()[c]);
          x.z -= bend(x);
          return std::abs(x[a] - plane) < 1e-9;
        });
        in_planes += all ? 1 : 0;
      }
  }
  EXPECT_EQ(in_planes, border) << what << ": a face inside has cells on one side alone";
  EXPECT_NEAR(exact_volume(read.model, 9, "a.exf"), 2.0, 1e-9) << what;
}

TEST(ExSimplex, LinearTetrahedraAreTakenAsTheyStand) {
  const Read made = read(text_of(tetrahedra(1), linear, none), 4);
  EXPECT_EQ(made.sampled.mesh.cell_count(), 12U);
  EXPECT_EQ(made.sampled.mesh.point_count(), 12U);
  expect_whole(made, linear, none, "linear");
}

TEST(ExSimplex, QuadraticTetrahedraHoldTheirPolynomial) {
  const auto bend = [](const Vec3& x) { return 0.2 * x.x * (2.0 - x.x) + 0.1 * x.x * x.y; };
  for (const int refine : {1, 2, 3, 5}) {
    const Read made = read(text_of(tetrahedra(2), quadratic, bend), refine);
    EXPECT_EQ(made.sampled.mesh.cell_count(), 12U * static_cast<std::size_t>(refine * refine * refine));
    expect_whole(made, quadratic, bend, "quadratic " + std::to_string(refine));
  }
}

TEST(ExSimplex, WedgesStandAlongAnyAxis) {
  for (const std::size_t free : {0U, 1U, 2U})
    for (const int refine : {1, 2, 4}) {
      const Read made = read(text_of(wedges(free), linear, none), refine);
      EXPECT_EQ(made.sampled.mesh.cell_count(), 4U * static_cast<std::size_t>(refine * refine * refine));
      expect_whole(made, linear, none, "wedge " + std::to_string(free) + " " + std::to_string(refine));
    }
}

TEST(ExSimplex, ValuesMayBeConstantInATetrahedron) {
  std::string text = text_of(tetrahedra(1), linear, none);
  const std::size_t of_nodes = text.find("2) pressure, field"),
                    field = text.find("2) pressure, field", of_nodes + 1);
  text.replace(
      field, text.find("Element:", field) - field,
      "2) stress, field, rectangular cartesian, real, #Components=1\n 1. constant*constant*constant, no "
      "modify, element based.\n");
  std::size_t at = 0;
  for (int e = 1; (at = text.find(" 0 0\n Nodes:", at)) != std::string::npos; ++e, at += 12)
    text.insert(at + 5, " Values:\n " + std::to_string(10 * e) + "\n");
  const Read made = read(text, 4);
  EXPECT_EQ(made.sampled.mesh.cell_count(), 12U);
  const DataArray* const stress = made.sampled.mesh.find("stress", Association::kCell);
  ASSERT_NE(stress, nullptr);
  for (std::size_t c = 0; c < stress->tuples; ++c)
    EXPECT_EQ(stress->at(c), 10.0 * static_cast<double>(c + 1));
}

TEST(ExSimplex, ABasisOfAnotherShapeIsRefused) {
  std::string text = text_of(tetrahedra(1), linear, none);
  const std::string shape = "simplex(2;3)*simplex*simplex";
  text.replace(text.find(shape), shape.size(), "line*line*line");
  try {
    (void)read(text, 2);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("shape"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace palpate::ex
