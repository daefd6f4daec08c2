// The mesher of cardiac: on walls whose volume is known, and on what breaks triangulations.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "apps/cardiac/mesher/border.h"
#include "apps/cardiac/mesher/delaunay.h"
#include "apps/cardiac/mesher/tetgen_filling.h"
#include "apps/cardiac/mesher/wall_cells.h"
#include "common/base/error.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/grid/cell_split.h"
#include "common/field/grid/mesh_quality.h"
#include "common/scene/wall/mesh_client.h"
#include "common/scene/wall/wall_mesh.h"
#include "loaders/cardiac/ex/ex_element.h"
#include "loaders/cardiac/ex/ex_mesh.h"
#include "loaders/cardiac/ex/ex_reader.h"
#include "tests/support/project_folders.h"
#include "tests/support/samples.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

constexpr double kPi = std::numbers::pi;

SampledWall wall_of(const DataSet& cells) {
  SplitMesh split = split_into_tetrahedra(std::span(&cells, 1), "wall");
  return {std::move(split.points), std::move(split.tets), std::move(split.source_cell)};
}

FinishedMesh delaunay_of(const SampledWall& wall) {
  return choose_wall(wall, delaunay_cells(wall.points, point_spacing(wall)));
}

/// The Jacobian of prolate spheroidal coordinates is f^3 (sinh^2 lambda + sin^2 mu) sinh lambda sin mu.
double exact_volume(const Ventricle& v) {
  const auto cubed = [](double c) { return c * c * c / 3.0; };
  const auto hyperbolic = [&](double l) { return cubed(std::cosh(l)) - std::cosh(l); };  // of sinh^3
  const auto circular = [&](double m) { return cubed(std::cos(m)) - std::cos(m); };      // of sin^3
  const double l3 = hyperbolic(v.lambda_outer) - hyperbolic(v.lambda_inner);
  const double m3 = circular(v.mu_base) - circular(0.0);
  const double l1 = std::cosh(v.lambda_outer) - std::cosh(v.lambda_inner), m1 = 1.0 - std::cos(v.mu_base);
  return 2.0 * kPi * v.focus * v.focus * v.focus * (l3 * m1 + l1 * m3);
}

/// A structured block of a spherical shell, whole round: closed, with a cavity where the inner radius is not
/// 0.
DataSet spherical_shell(int radial, int n, double inner, double outer) {
  // Six faces of a cube blown up: no poles.
  std::vector<double> positions;
  std::vector<std::int64_t> connectivity, offsets{0};
  std::vector<std::uint8_t> types;
  const auto add_point = [&](const Vec3& x) {
    positions.insert(positions.end(), {x.x, x.y, x.z});
    return static_cast<std::int64_t>(positions.size() / 3 - 1);
  };
  for (int face = 0; face < 6; ++face) {
    std::vector<std::int64_t> at;
    for (int k = 0; k <= radial; ++k) {
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          const double u = std::tan(kPi / 4.0 * (2.0 * i / n - 1.0)),
                       w = std::tan(kPi / 4.0 * (2.0 * j / n - 1.0));
          Vec3 d = face / 2 == 0 ? Vec3{1.0, u, w} : face / 2 == 1 ? Vec3{w, 1.0, u} : Vec3{u, w, 1.0};
          if (face % 2 == 1) d = -d;
          at.push_back(add_point((inner + (outer - inner) * k / radial) * glm::normalize(d)));
        }
      }
    }
    const auto number = [&](int i, int j, int k) {
      return at[static_cast<std::size_t>(i + (n + 1) * (j + (n + 1) * k))];
    };
    for (int k = 0; k < radial; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
            connectivity.push_back(number(i + a, j + b, k));
          for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
            connectivity.push_back(number(i + a, j + b, k + 1));
          offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
          types.push_back(12);
        }
  }
  // One number a place: the faces' edges agree but for rounding.
  std::vector<std::int64_t> same(positions.size() / 3);
  std::vector<double> kept;
  for (std::size_t p = 0; p < same.size(); ++p) {
    const Vec3 x{positions[3 * p], positions[3 * p + 1], positions[3 * p + 2]};
    same[p] = -1;
    for (std::size_t q = 0; q < kept.size() / 3 && same[p] < 0; ++q)
      if (glm::distance(x, Vec3{kept[3 * q], kept[3 * q + 1], kept[3 * q + 2]}) < 1e-9 * outer)
        same[p] = static_cast<std::int64_t>(q);
    if (same[p] >= 0) continue;
    same[p] = static_cast<std::int64_t>(kept.size() / 3);
    kept.insert(kept.end(), {x.x, x.y, x.z});
  }
  for (std::int64_t& p : connectivity) p = same[static_cast<std::size_t>(p)];
  DataSet data;
  UnstructuredTopology topology;
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(kept));
  topology.types = types;
  topology.offsets = offsets;
  topology.connectivity = connectivity;
  data.topology = std::move(topology);
  return data;
}

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kWorkFailed);
    return error.what();
  }
  return "accepted";
}

TEST(MeshQuality, AnglesOfTetrahedraThatAreKnown) {
  const std::array<Vec3, 4> regular{Vec3{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  for (const double angle : dihedral_angles(regular))
    EXPECT_NEAR(angle, std::acos(1.0 / 3.0) * 180.0 / kPi, 1e-12);
  auto corner = dihedral_angles({Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  std::sort(corner.begin(), corner.end());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(corner[i], std::atan(std::sqrt(2.0)) * 180.0 / kPi, 1e-12);
  for (std::size_t i = 3; i < 6; ++i) EXPECT_NEAR(corner[i], 90.0, 1e-12);

  // Two apart, one of them a sliver of height 0.01.
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0},    {0, 0, 1},
                                 {5, 0, 0}, {6, 1, 0}, {6, 0, 0.01}, {5, 1, 0.01}};
  const MeshQuality quality =
      mesh_quality(TetMesh(points, std::vector<TetMesh::Tet>{{0, 1, 2, 3}, {4, 5, 6, 7}}));
  EXPECT_EQ(quality.components, 2U);
  EXPECT_EQ(quality.slivers, 1U);
  EXPECT_EQ(quality.zero_volume, 0U);
  EXPECT_EQ(quality.border_faces, 8U);
  EXPECT_EQ(quality.open_edges, 0U);
  EXPECT_NEAR(quality.volume, 1.0 / 6.0 + 0.01 / 3.0, 1e-12);
}

TEST(MeshQuality, TetrahedraThatOverlapAreSeenAtTheirFace) {
  const std::vector<TetMesh::Tet> tets{{0, 1, 2, 3}, {0, 1, 2, 4}};
  for (const double z : {-1.0, 0.5}) {
    const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.2, z}};
    EXPECT_EQ(mesh_quality(TetMesh(points, tets)).folded_faces, z < 0.0 ? 0U : 1U);
  }
}

// The circumspheres are the definition; what the weights may change is far below the tolerance.
TEST(Delaunay, CosphericalPointsGiveNoFlatCellInside) {
  const SampledWall wall = wall_of(ventricle_mesh({}, {.wall = 4, .along = 8, .around = 16}));
  const DelaunayCells cells = delaunay_cells(wall.points, point_spacing(wall));
  std::size_t flat_inside = 0;
  for (std::size_t c = 0; c < cells.tets.size(); ++c) {
    std::array<Vec3, 4> x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = wall.points[cells.tets[c][i]];
    const Mat3 edges{x[1] - x[0], x[2] - x[0], x[3] - x[0]};
    const double volume = glm::determinant(edges);
    double longest = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) longest = std::max(longest, glm::distance(x[i], x[j]));
    const bool hull =
        std::find(cells.neighbors[c].begin(), cells.neighbors[c].end(), kNoCell) != cells.neighbors[c].end();
    if (std::abs(volume) < 1e-8 * longest * longest * longest) {
      flat_inside += hull ? 0 : 1;
      continue;
    }
    ASSERT_GT(volume, 0.0);
    const Vec3 squares{glm::dot(edges[0], edges[0]), glm::dot(edges[1], edges[1]),
                       glm::dot(edges[2], edges[2])};
    const Vec3 centre = glm::inverse(glm::transpose(edges)) * (0.5 * squares);
    const double radius = glm::length(centre);
    if (radius > 1e3) continue;  // a hull cell's sphere is nearly a plane: rounding decides
    for (const Vec3& p : wall.points) ASSERT_GT(glm::distance(p, x[0] + centre), radius * (1.0 - 1e-4));
  }
  EXPECT_EQ(flat_inside, 0U);
}

TEST(Delaunay, PointsOfAPlaneOrALineAreRefused) {
  std::vector<Vec3> plane, line;
  for (int i = 0; i < 5; ++i) {
    line.emplace_back(i, 2 * i, -i);
    for (int j = 0; j < 5; ++j) plane.emplace_back(i, j, 0.0);
  }
  const auto refused = [](const std::vector<Vec3>& points) {
    return refusal([&] { (void)delaunay_cells(points, std::vector<double>(points.size(), 1.0)); });
  };
  EXPECT_NE(refused(plane).find("one plane"), std::string::npos);
  EXPECT_NE(refused(line).find("one plane"), std::string::npos);
  EXPECT_NE(refused({}).find("one plane"), std::string::npos);
  EXPECT_NE(refused(std::vector<Vec3>(9, Vec3{1.0, 2.0, 3.0})).find("one plane"), std::string::npos);
}

TEST(Delaunay, APointThatStandsThereTwiceIsTakenOnce) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  points.push_back(points[3]);
  points.push_back(points[3]);
  const DelaunayCells cells = delaunay_cells(points, std::vector<double>(points.size(), 1.0));
  double volume = 0.0;
  for (const TetMesh::Tet& t : cells.tets)
    volume += glm::determinant(Mat3{points[t[1]] - points[t[0]], points[t[2]] - points[t[0]],
                                    points[t[3]] - points[t[0]]}) /
              6.0;
  EXPECT_NEAR(volume, 1.0, 1e-12);
}

TEST(WallRule, TheVentriclesVolumeConvergesAtSecondOrderAndTheCavityStaysEmpty) {
  const Ventricle ventricle;
  const double exact = exact_volume(ventricle);
  std::vector<double> errors;
  for (const int n : {1, 2, 4}) {
    const SampledWall wall =
        wall_of(ventricle_mesh(ventricle, {.wall = 3 * n, .along = 10 * n, .around = 20 * n}));
    const FinishedMesh mesh = delaunay_of(wall);
    const MeshQuality quality = mesh_quality(TetMesh(wall.points, mesh.tets));
    errors.push_back(std::abs(quality.volume / exact - 1.0));
    EXPECT_EQ(quality.components, 1U);
    EXPECT_EQ(quality.zero_volume, 0U);
    EXPECT_EQ(quality.open_edges, 0U);
    EXPECT_EQ(quality.manifold_faults, 0U);

    // A chord of the inner ellipsoid runs through the cavity, by at most its sagitta: the smallest radius of
    // curvature is b^2 / a, at the apex.
    const double a = ventricle.focus * std::cosh(ventricle.lambda_inner);
    const double b = ventricle.focus * std::sinh(ventricle.lambda_inner);
    for (const TetMesh::Tet& tet : mesh.tets) {
      Vec3 centroid{0.0};
      double longest = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        centroid += 0.25 * wall.points[tet[i]];
        for (std::size_t j = 0; j < i; ++j)
          longest = std::max(longest, glm::distance(wall.points[tet[i]], wall.points[tet[j]]));
      }
      const Prolate at = ventricle.coordinates(centroid);
      const double metric = ventricle.focus * std::hypot(std::sinh(at.lambda), std::sin(at.mu));
      ASSERT_LT((ventricle.lambda_inner - at.lambda) * metric, longest * longest / (8.0 * b * b / a));
      ASSERT_LT(at.lambda, ventricle.lambda_outer);
      ASSERT_LT(at.mu, ventricle.mu_base + longest * longest / metric);
    }
  }
  EXPECT_LT(errors.back(), 5e-3);
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.7);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.7);
}

/// How far a place is from the curved elements of a model, each asked by Newton steps within its own
/// coordinates: nothing of the mesher's rule, nor of sampled cells, is in it.
class CurvedModel {
 public:
  explicit CurvedModel(const ex::Model& model) {
    for (const ex::Element& element : model.elements) {
      const ex::ElementField* coordinates = nullptr;
      for (const ex::ElementField& field : model.element_headers[element.header])
        if (field.name == "coordinates") coordinates = &field;
      Piece piece{{model, element, *coordinates, nullptr, "heart"}, {}};
      for (int i = 0; i < 125; ++i) piece.box.include(piece.shape.at(Vec3(i % 5, i / 5 % 5, i / 25) / 4.0).x);
      pieces_.push_back(std::move(piece));
    }
  }

  [[nodiscard]] double distance(const Vec3& x) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Piece& piece : pieces_) {
      const Vec3 beyond = glm::max(glm::max(piece.box.lower - x, x - piece.box.upper), Vec3{0.0});
      if (glm::length(beyond) - 0.1 * piece.box.diagonal() > least) continue;
      for (int start = 0; start < 9 && least > 1e-6; ++start) {
        Vec3 xi = start == 0 ? Vec3{0.5} : 0.25 + 0.5 * Vec3(start & 1, start >> 1 & 1, start >> 2 & 1);
        for (int i = 0; i < 20; ++i) {
          const ex::Place at = piece.shape.at(xi);
          least = std::min(least, glm::distance(at.x, x));
          const Mat3 normal = glm::transpose(at.tangents) * at.tangents;
          const double damping = 1e-12 * (normal[0][0] + normal[1][1] + normal[2][2]);
          xi += glm::inverse(normal + Mat3{damping}) * (glm::transpose(at.tangents) * (x - at.x));
          xi = glm::clamp(xi, Vec3{0.0}, Vec3{1.0});
        }
      }
    }
    return least;
  }

 private:
  struct Piece {
    ex::ElementShape shape;
    Box box;
  };
  std::vector<Piece> pieces_;
};

TEST(WallRule, NoTetrahedronLiesInTheCavitiesOfTheDog) {
  PALPATE_NEED_DATA(nodes, "cardiac/canine-heart/heart.exnode.gz");
  ex::Model model;
  ex::read_ex_file(nodes.string(), model);
  ex::read_ex_file((nodes.parent_path() / "heart.exelem.gz").string(), model);
  const SampledWall wall = wall_of(ex::sample(model, 4, "heart").mesh);
  const FinishedMesh mesh = delaunay_of(wall);
  const CurvedModel curved(model);
  double farthest = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); t += 124 / test::samples_of(4)) {
    Vec3 centroid{0.0};
    for (const std::uint32_t p : mesh.tets[t]) centroid += 0.25 * wall.points[p];
    farthest = std::max(farthest, curved.distance(centroid));
  }
  // Chords of the curved surfaces bulge into the cavities by their sagitta; these are tens of units wide.
  EXPECT_LT(farthest, 1.0);
}

TEST(WallRule, AClosedCavityStaysEmpty) {
  const SampledWall wall = wall_of(spherical_shell(2, 8, 1.0, 2.0));
  const FinishedMesh mesh = delaunay_of(wall);
  EXPECT_GT(mesh.outside, 0U);
  for (const TetMesh::Tet& tet : mesh.tets) {
    const Vec3 centroid =
        0.25 * (wall.points[tet[0]] + wall.points[tet[1]] + wall.points[tet[2]] + wall.points[tet[3]]);
    ASSERT_GT(glm::length(centroid), 0.95);  // the sagitta of an eighth of a quarter turn is 0.02
  }
  const MeshQuality quality = mesh_quality(TetMesh(wall.points, mesh.tets));
  EXPECT_EQ(quality.zero_volume, 0U);
  EXPECT_EQ(quality.open_edges, 0U);
  EXPECT_NEAR(quality.volume, 4.0 / 3.0 * kPi * 7.0, 0.04 * 4.0 / 3.0 * kPi * 7.0);
}

TEST(WallRule, AModelOfOneElementKeepsItsVolume) {
  const std::vector<double> corners{0, 0, 0, 1, 0, 0, 1, 2, 0, 0, 2, 0, 0, 0, 3, 1, 0, 3, 1, 2, 3, 0, 2, 3};
  UnstructuredTopology cell;
  cell.positions = make_array("points", Association::kPoint, 3, std::span<const double>(corners));
  cell.types = {12};
  cell.offsets = {0, 8};
  cell.connectivity = {0, 1, 2, 3, 4, 5, 6, 7};
  DataSet data;
  data.topology = cell;
  const SampledWall wall = wall_of(data);
  const FinishedMesh mesh = delaunay_of(wall);
  const MeshQuality quality = mesh_quality(TetMesh(wall.points, mesh.tets));
  EXPECT_NEAR(quality.volume, 6.0, 1e-12);
  EXPECT_EQ(quality.zero_volume, 0U);
  EXPECT_EQ(quality.points, 8U);
}

TEST(Border, AClosedCavityGetsAPointInIt) {
  const WallBorder border = border_of(wall_of(spherical_shell(2, 4, 1.0, 2.0)));
  check_border(border);
  ASSERT_EQ(border.holes.size(), 1U);
  EXPECT_LT(glm::length(border.holes.front()), 1.0);
  EXPECT_NEAR(winding_number(border, {0.1, 0.2, -0.1}), 0.0, 1e-9);
  EXPECT_NEAR(winding_number(border, {1.5, 0.0, 0.0}), 1.0, 1e-9);
  EXPECT_NEAR(winding_number(border, {3.0, 0.0, 0.0}), 0.0, 1e-9);
  EXPECT_TRUE(border_of(wall_of(ventricle_mesh({}, {.wall = 2, .along = 6, .around = 12}))).holes.empty());
}

TEST(Border, WhatTetgenEndsTheProcessOnIsRefusedFirst) {
  const WallBorder good{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}, {}};
  check_border(good);
  WallBorder open = good, twice = good, flat = good, same = good, few = good;
  open.points.emplace_back(5, 5, 5);
  open.triangles.back()[0] = 4;
  twice.triangles.push_back(twice.triangles.front());
  flat.points[3] = {2, 0, 0};
  same.points[3] = same.points[0];
  few.triangles.resize(3);
  EXPECT_NE(refusal([&] { check_border(open); }).find("open"), std::string::npos);
  EXPECT_NE(refusal([&] { check_border(twice); }).find("twice"), std::string::npos);
  EXPECT_NE(refusal([&] { check_border(flat); }).find("no area"), std::string::npos);
  EXPECT_NE(refusal([&] { check_border(same); }).find("no area"), std::string::npos);
  EXPECT_NE(refusal([&] { check_border(few); }).find("encloses nothing"), std::string::npos);
}

TEST(Tetgen, FillsAShellAndLeavesItsCavityOut) {
  const SampledWall wall = wall_of(spherical_shell(2, 4, 1.0, 2.0));
  const WallBorder border = border_of(wall);
  const FinishedMesh mesh = fill_border(border, 0.05);
  const MeshQuality quality = mesh_quality(TetMesh(mesh.points, mesh.tets));
  EXPECT_NEAR(quality.volume, mesh_quality(TetMesh(wall.points, wall.tets)).volume, 1e-9);
  EXPECT_EQ(quality.border_faces, border.triangles.size());
  EXPECT_EQ(quality.components, 1U);
  EXPECT_EQ(quality.zero_volume, 0U);
}

TEST(Tetgen, SurfacesThatCrossAreNamed) {
  WallBorder border{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}, {}};
  for (int p = 0; p < 4; ++p)
    border.points.push_back(border.points[static_cast<std::size_t>(p)] + Vec3{0.2, 0.1, 0.15});
  for (std::size_t t = 0; t < 4; ++t)
    border.triangles.push_back(
        {border.triangles[t][0] + 4, border.triangles[t][1] + 4, border.triangles[t][2] + 4});
  EXPECT_NE(refusal([&] { (void)fill_border(border, 0.0); }).find("cross"), std::string::npos);
}

class MesherProgram : public testing::Test {
 protected:
  MesherProgram() { helpers((test::build_folder() / "lib/palpate").string()); }
  ~MesherProgram() override { ::unsetenv("PALPATE_HELPERS"); }
  static void helpers(const std::string& folder) { ::setenv("PALPATE_HELPERS", folder.c_str(), 1); }
  test::TempFolder folder_;
};

TEST_F(MesherProgram, CarriesArraysAndTheFilesOwnTetrahedra) {
  const DataSet hexahedra = ventricle_mesh({}, {.wall = 3, .along = 8, .around = 16});
  WallMesh made = make_wall_mesh(hexahedra, nullptr, {}, "ventricle", nullptr);
  carry_arrays(hexahedra, made);
  EXPECT_FALSE(made.kept);
  EXPECT_GT(made.counts.shared, made.counts.outside);
  const auto depth = std::find_if(made.columns.begin(), made.columns.end(),
                                  [](const MeshColumn& column) { return column.name == "layer"; });
  ASSERT_NE(depth, made.columns.end());
  const Ventricle ventricle;
  for (std::size_t p = 0; p < made.points.size(); ++p)
    ASSERT_NEAR(depth->values[p], ventricle.depth(ventricle.coordinates(made.points[p]).lambda), 1e-6);

  const WallMesh again = make_wall_mesh(data_set_of(made), nullptr, {}, "ventricle", nullptr);
  EXPECT_TRUE(again.kept);
  EXPECT_EQ(again.points, made.points);
  EXPECT_EQ(again.tets.size(), made.tets.size());
}

// Two tetrahedra beside each other, one of them inverted and with points of its own, and what has no volume.
TEST_F(MesherProgram, MendsTheFilesOwnTetrahedra) {
  const std::vector<double> x{0, 0, 0, 1, 0, 0, 0, 1, 0, 0,    0,    1, 0, 0, -1,
                              0, 0, 0, 1, 0, 0, 0, 1, 0, 0.25, 0.25, 0, 2, 0, 0};
  DataSet data;
  UnstructuredTopology cells;
  cells.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
  cells.connectivity = {0, 1, 2, 3, 5, 6, 7, 4, 0, 1, 2, 8, 0, 1, 9, 9, 0, 1, 9, 3};
  cells.types.assign(5, 10);
  cells.offsets = {0, 4, 8, 12, 16, 20};
  data.topology = cells;
  const WallMesh mended = make_wall_mesh(data, nullptr, {}, "wall", nullptr);
  EXPECT_TRUE(mended.kept);
  EXPECT_EQ(mended.points.size(), 5U);
  EXPECT_EQ(mended.tets.size(), 2U);
  const MeshQuality quality = mesh_quality(TetMesh(mended.points, mended.tets));
  EXPECT_NEAR(quality.volume, 1.0 / 3.0, 1e-12);
  EXPECT_EQ(quality.zero_volume, 0U);
  EXPECT_EQ(quality.components, 1U);
  EXPECT_EQ(quality.folded_faces, 0U);

  cells.connectivity = {0, 1, 2, 8};
  cells.types = {10};
  cells.offsets = {0, 4};
  data.topology = cells;
  EXPECT_THROW((void)make_wall_mesh(data, nullptr, {}, "wall", nullptr), Error);
}

TEST_F(MesherProgram, ACrashIsALineThatSaysWhat) {
  const std::string program = folder_.write("palpate-mesh", "#!/bin/sh\nkill -SEGV $$\n").string();
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  helpers(folder_.path().string());
  const DataSet cells = ventricle_mesh({}, {.wall = 1, .along = 4, .around = 8});
  const std::string line = refusal([&] { (void)make_wall_mesh(cells, nullptr, {}, "dog.exelem", nullptr); });
  EXPECT_NE(line.find("dog.exelem"), std::string::npos) << line;
  EXPECT_NE(line.find("signal 11"), std::string::npos) << line;
}

}  // namespace
}  // namespace palpate
