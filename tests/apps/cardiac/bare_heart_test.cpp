// Hearts without layers: what is drawn of them lies where the mesh is, and has the file's values.
#include "apps/cardiac/bare_heart.h"

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "apps/cardiac/heart_scene.h"
#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

double linear(const Vec3& x) { return 1.0 + x.x + 2.0 * x.y + 3.0 * x.z; }

double area_of(const IsosurfaceMesh& mesh) {
  double area = 0.0;
  for (const auto& [a, b, c] : mesh.triangles)
    area += 0.5 * glm::length(glm::cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
  return area;
}

/// A mesh as legacy VTK and openCARP write it.
struct Mesh {
  std::vector<Vec3> points;
  std::vector<std::pair<int, std::vector<std::size_t>>> cells;  // VTK type and points

  /// The unit cube as n^3 boxes of six tetrahedra.
  static Mesh cube(std::size_t n) {
    Mesh mesh;
    for (std::size_t k = 0; k <= n; ++k)
      for (std::size_t j = 0; j <= n; ++j)
        for (std::size_t i = 0; i <= n; ++i)
          mesh.points.push_back(Vec3(double(i), double(j), double(k)) / double(n));
    constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    const std::array<std::size_t, 3> step{1, n + 1, (n + 1) * (n + 1)};
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i)
          for (const auto& order : kOrders) {
            std::size_t at = i + (n + 1) * (j + (n + 1) * k);
            std::vector<std::size_t> tet{at};
            for (const std::size_t axis : order) tet.push_back(at += step[axis]);
            mesh.cells.push_back({10, tet});
          }
    return mesh;
  }

  /// Half a cylinder around z, of radius 1 and height 2, open at its ends.
  static Mesh half_pipe(std::size_t n) {
    Mesh mesh;
    for (std::size_t k = 0; k <= n; ++k)
      for (std::size_t i = 0; i <= n; ++i) {
        const double phi = std::numbers::pi * double(i) / double(n);
        mesh.points.emplace_back(std::cos(phi), std::sin(phi), 2.0 * double(k) / double(n));
      }
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t a = i + (n + 1) * k, b = a + 1, c = a + n + 1, d = c + 1;
        mesh.cells.push_back({5, {a, b, d}});
        mesh.cells.push_back({5, {a, d, c}});
      }
    return mesh;
  }

  [[nodiscard]] Vec3 middle(std::size_t cell) const {
    Vec3 sum(0.0);
    for (const std::size_t p : cells[cell].second) sum += points[p];
    return sum / double(cells[cell].second.size());
  }
};

class BareHeartTest : public ::testing::Test {
 protected:
  /// @param direction of a cell's fibre at its middle; null: none.
  std::shared_ptr<const BareHeart> open(const Mesh& mesh, Vec3 (*direction)(const Vec3&) = nullptr,
                                        const std::string& cell_values = {}) {
    const auto path = folder_.path("mesh.vtk");
    std::ofstream file(path);
    file.precision(17);
    file << "# vtk DataFile Version 3.0\nm\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << mesh.points.size()
         << " double\n";
    for (const Vec3& x : mesh.points) file << x.x << ' ' << x.y << ' ' << x.z << '\n';
    std::size_t numbers = 0;
    for (const auto& [type, points] : mesh.cells) numbers += 1 + points.size();
    file << "CELLS " << mesh.cells.size() << ' ' << numbers << '\n';
    for (const auto& [type, points] : mesh.cells) {
      file << points.size();
      for (const std::size_t p : points) file << ' ' << p;
      file << '\n';
    }
    file << "CELL_TYPES " << mesh.cells.size() << '\n';
    for (const auto& [type, points] : mesh.cells) file << type << '\n';
    file << "POINT_DATA " << mesh.points.size() << "\nSCALARS vm double 1\nLOOKUP_TABLE default\n";
    for (const Vec3& x : mesh.points) file << linear(x) << '\n';
    file << "CELL_DATA " << mesh.cells.size() << "\nSCALARS number double 1\nLOOKUP_TABLE default\n";
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) file << c << '\n';
    if (direction != nullptr) {
      file << "VECTORS fibre double\n";
      for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
        const Vec3 d = direction(mesh.middle(c));
        file << d.x << ' ' << d.y << ' ' << d.z << '\n';
      }
    }
    file << cell_values;
    file.close();
    open_file(path);
    const OpenHeart heart = open_heart(*input_, 1, nullptr);
    if (!heart.bare) throw std::runtime_error("has layers");
    return heart.bare;
  }
  void open_file(const std::filesystem::path& path) {
    InputOptions options;
    options.kind = FieldKind::kFibre;
    options.files = {path};
    input_.emplace(Input::open(options));
  }
  BareScene scene(const BareHeart& heart, const HeartOptions& options = {}) {
    return make_bare_scene(*input_, heart, options, 1, nullptr);
  }
  static void expect_linear(const BareScene& scene) {
    const IsosurfaceMesh& mesh = *scene.surface.mesh;
    ASSERT_EQ(scene.surface.values ? scene.surface.values->size() : 0, mesh.points.size());
    for (std::size_t p = 0; p < mesh.points.size(); ++p)
      EXPECT_NEAR((*scene.surface.values)[p], linear(mesh.points[p]), 1e-5);
    std::size_t at = 0;
    for (const Line& line : *scene.lines)
      for (const LinePoint& point : line.points)
        EXPECT_NEAR(scene.array->values[at++], linear(point.position), 1e-5);
    EXPECT_EQ(at, scene.array->values.size());
  }

  TempFolder folder_;
  std::optional<Input> input_;
};

TEST_F(BareHeartTest, ShowsTheBorderOfAVolumeWithoutFibres) {
  const auto heart = open(Mesh::cube(3));
  EXPECT_EQ(heart->mesh.triangles.size(), 6U * 2U * 9U);
  EXPECT_NEAR(area_of(heart->mesh), 6.0, 1e-12);
  EXPECT_EQ(heart->bounds.lower, Vec3(0.0));
  EXPECT_EQ(heart->bounds.upper, Vec3(1.0));
  EXPECT_TRUE(heart->strokes.empty());
  EXPECT_TRUE(heart->notes.front().starts_with("there are no fibres")) << heart->notes.front();
  for (std::size_t p = 0; p < heart->mesh.points.size(); ++p)
    EXPECT_GT(glm::dot(Vec3(heart->mesh.normals[p]), heart->mesh.points[p] - Vec3(0.5)), 0.0);
  const BareScene shown = scene(*heart);
  EXPECT_EQ(shown.array->name, "vm");
  EXPECT_EQ(shown.note, "");
  ASSERT_TRUE(shown.array->range) << "there is no line whose values could give it";
  EXPECT_NEAR(shown.array->range->lower, 1.0, 0.1);
  EXPECT_NEAR(shown.array->range->upper, 7.0, 0.1);
  expect_linear(shown);
  EXPECT_NE(scene(*heart, {.angle = "transverse"}).note, "");
  EXPECT_THROW((void)scene(*heart, {.angle = "nothing"}), Error);
}

TEST_F(BareHeartTest, CutsSurfaceAndValuesAlongAPlane) {
  const auto heart = open(Mesh::cube(3), [](const Vec3&) { return Vec3(0.0, 1.0, 0.0); });
  EXPECT_FALSE(heart->strokes.empty());
  const BareScene shown = scene(*heart, {.angle = "vm", .cut = "1,0,0,0.4"});
  EXPECT_NEAR(area_of(*shown.surface.mesh), 1.0 + 4.0 * 0.4, 1e-9);
  expect_linear(shown);
  for (const Line& line : *shown.lines)
    for (const LinePoint& point : line.points) EXPECT_LE(point.position.x, 0.4);
}

TEST_F(BareHeartTest, ShowsAWallWithoutTwoSidesAndSaysWhy) {
  const auto heart = open(Mesh::cube(3), [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); });
  EXPECT_NE(heart->notes.front().find("there are no layers"), std::string::npos);
  EXPECT_FALSE(heart->notes.front().starts_with("there are no fibres"));
  // Fibres along x lie in four of the six sides.
  EXPECT_EQ(heart->strokes.size(), 4U * 2U * 9U);
  const BareScene shown = scene(*heart);
  for (const Line& line : *shown.lines) {
    const Vec3 d = line.points[1].position - line.points[0].position;
    EXPECT_NEAR(std::abs(d.x), glm::length(d), 1e-12);
  }
}

TEST_F(BareHeartTest, DrawsStrokesOfAShellWithinItsTriangles) {
  const Mesh pipe = Mesh::half_pipe(12);
  const auto around = [](const Vec3& x) { return Vec3(-x.y, x.x, 0.3); };
  const auto heart = open(pipe, around);
  EXPECT_EQ(heart->grid, nullptr);
  ASSERT_EQ(heart->strokes.size(), pipe.cells.size());
  // Flat strips: 2 n sin(pi / 2n) wide altogether.
  EXPECT_NEAR(area_of(heart->mesh), 2.0 * 24.0 * std::sin(std::numbers::pi / 24.0), 1e-12);
  const BareScene shown = scene(*heart);
  expect_linear(shown);
  for (std::size_t s = 0; s < heart->strokes.size(); ++s) {
    const BareHeart::Stroke& stroke = heart->strokes[s];
    const std::size_t t = stroke.triangle;
    const Vec3 a = heart->mesh.points[3 * t], b = heart->mesh.points[3 * t + 1],
               c = heart->mesh.points[3 * t + 2];
    const Vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    Vec3 fibre = around((a + b + c) / 3.0);
    fibre = glm::normalize(fibre - glm::dot(fibre, normal) * normal);
    const auto& points = (*shown.lines)[s].points;
    const Vec3 along = points[1].position - points[0].position;
    EXPECT_NEAR(std::abs(glm::dot(along, fibre)), glm::length(along), 1e-12);
    for (const Vec3& weights : stroke.ends) {
      EXPECT_NEAR(weights.x + weights.y + weights.z, 1.0, 1e-12);
      EXPECT_NEAR(std::min({weights.x, weights.y, weights.z}), 0.0, 1e-12);  // on an edge
    }
  }
}

TEST_F(BareHeartTest, DrawsNoStrokeWhereNoFibreLies) {
  const auto heart = open(Mesh::half_pipe(6), [](const Vec3& x) {
    if (x.z < 0.7) return Vec3(0.0);
    return x.z < 1.4 ? Vec3(x.x, x.y, 0.0) : Vec3(0.0, 0.0, 2.0);  // none, across, along
  });
  EXPECT_EQ(heart->strokes.size(), 2U * 6U * 2U);
}

TEST_F(BareHeartTest, EndsValuesOfCellsAtTheirEdges) {
  const auto heart = open(Mesh::half_pipe(4));
  const BareScene shown = scene(*heart, {.angle = "number"});
  for (std::size_t i = 0; i < heart->points.size(); ++i)
    EXPECT_EQ((*shown.surface.values)[i], static_cast<float>(i / 3));
}

TEST_F(BareHeartTest, TakesFlatCellsOfEveryKind) {
  const auto square = [](int type, std::vector<std::size_t> points) {
    Mesh mesh;
    mesh.points = {{0, 0, 0}, {2, 0, 0},   {2, 1, 0}, {0, 1, 0},
                   {1, 0, 0}, {2, 0.5, 0}, {1, 1, 0}, {0, 0.5, 0}};
    mesh.cells = {{type, std::move(points)}};
    return mesh;
  };
  for (const auto& [type, points] :
       std::vector<std::pair<int, std::vector<std::size_t>>>{{9, {0, 1, 2, 3}},
                                                             {8, {0, 1, 3, 2}},
                                                             {6, {0, 1, 3, 2}},
                                                             {7, {0, 4, 1, 2, 6, 3}},
                                                             {23, {0, 1, 2, 3, 4, 5, 6, 7}}})
    EXPECT_NEAR(area_of(open(square(type, points))->mesh), 2.0, 1e-12) << type;
  EXPECT_NEAR(area_of(open(square(22, {0, 1, 2, 4, 5, 6}))->mesh), 1.0, 1e-12);
}

TEST_F(BareHeartTest, DrawsTheLinesOfATree) {
  Mesh tree;
  for (int i = 0; i < 5; ++i) tree.points.emplace_back(i, i * i, 0.5 * i);
  tree.cells = {{3, {0, 1}}, {3, {1, 2}}, {4, {2, 3, 4}}};
  const auto heart = open(tree);
  EXPECT_EQ(heart->branches.size(), 4U);
  EXPECT_EQ(heart->bounds.upper, Vec3(4.0, 16.0, 2.0));
  expect_linear(scene(*heart));
}

TEST_F(BareHeartTest, OpensOpenCarpShellsAndRefusesPointsThatAreNotThere) {
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder_.path(name)) << text;
  };
  write("a.pts", "4\n0 0 0\n20000 0 0\n20000 10000 0\n0 10000 0\n");
  write("a.elem", "3\nTr 0 1 2 7\nTr 0 2 3 8\nLn 0 1 9\n");
  write("a.lon", "1\n1 0 0\n0 1 0\n1 0 0\n");
  open_file(folder_.path("a.elem"));
  const OpenHeart heart = open_heart(*input_, 1, nullptr);
  ASSERT_NE(heart.bare, nullptr);
  EXPECT_NEAR(area_of(heart.bare->mesh), 20.0 * 10.0, 1e-9);
  EXPECT_EQ(heart.bare->strokes.size(), 2U);
  EXPECT_EQ(heart.bare->branches.size(), 1U);
  EXPECT_EQ(scene(*heart.bare).array->name, "region");
}

}  // namespace
}  // namespace palpate::test
