#include "common/field/layer/wall_layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kTolerance = 1e-12;
constexpr int kMostIterations = 20'000;
/// Volume over the cube of the longest edge below which a cell has no say: 0.118 for a regular one. Such a
/// sliver ties its corners to one plane of values, however thin it is, which throws values far out of range;
/// without it its neighbours still meet at all four corners.
constexpr double kThin = 1e-3;

using Matrix = Eigen::SparseMatrix<double>;
/// In the order of the points: one that saves fill in a full factor spoils an incomplete one (four times the
/// iterations on a million tetrahedra).
using Factor = Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>>;
using Solver = Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper, Factor>;

/// With its orientation's sign.
double volume_of(const TetMesh& mesh, const TetMesh::Tet& tet) {
  const Vec3 x0 = mesh.points()[tet[0]];
  return glm::determinant(
             Mat3{mesh.points()[tet[1]] - x0, mesh.points()[tet[2]] - x0, mesh.points()[tet[3]] - x0}) /
         6.0;
}

bool is_thin(const TetMesh& mesh, CellIndex cell) {
  if (mesh.zero_volume(cell)) return true;
  const TetMesh::Tet& tet = mesh.cells()[static_cast<std::size_t>(cell)];
  double longest = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j)
      longest = std::max(longest, glm::distance(mesh.points()[tet[i]], mesh.points()[tet[j]]));
  return std::abs(volume_of(mesh, tet)) < kThin * longest * longest * longest;
}

/// Cells that have a say: all but thin ones, and those too where a point has no other.
std::vector<bool> cells_of_system(const TetMesh& mesh) {
  std::vector<bool> takes_part(mesh.cells().size()), held(mesh.points().size());
  for (std::size_t c = 0; c < takes_part.size(); ++c) {
    if (is_thin(mesh, static_cast<CellIndex>(c))) continue;
    takes_part[c] = true;
    for (const std::uint32_t p : mesh.cells()[c]) held[p] = true;
  }
  for (std::size_t c = 0; c < takes_part.size(); ++c) {
    const TetMesh::Tet& tet = mesh.cells()[c];
    if (takes_part[c] || mesh.zero_volume(static_cast<CellIndex>(c))) continue;
    takes_part[c] = std::any_of(tet.begin(), tet.end(), [&](std::uint32_t p) { return !held[p]; });
  }
  return takes_part;
}

/// Which points cells with a volume join to one whose value is given.
std::vector<bool> reached_points(const TetMesh& mesh, const std::vector<WallSurface>& surface) {
  std::vector<bool> reached(surface.size());
  for (std::size_t p = 0; p < surface.size(); ++p) reached[p] = surface[p] != WallSurface::kNone;
  std::vector<CellIndex> front;
  std::vector<bool> visited(mesh.cells().size());
  const auto visit = [&](CellIndex cell) {
    const auto c = static_cast<std::size_t>(cell);
    if (visited[c] || mesh.zero_volume(cell)) return;
    visited[c] = true;
    front.push_back(cell);
  };
  for (std::size_t c = 0; c < mesh.cells().size(); ++c)
    for (const std::uint32_t p : mesh.cells()[c])
      if (surface[p] != WallSurface::kNone) visit(static_cast<CellIndex>(c));
  while (!front.empty()) {
    const auto c = static_cast<std::size_t>(front.back());
    front.pop_back();
    for (const std::uint32_t p : mesh.cells()[c]) reached[p] = true;
    for (const CellIndex neighbor : mesh.neighbors()[c])
      if (neighbor != kNoCell) visit(neighbor);
  }
  return reached;
}

/// The linear system of the points whose value is sought.
struct System {
  std::vector<std::int32_t> unknown;  ///< of each point; -1 where its value is given or it is not reached
  Matrix matrix;
  Eigen::VectorXd right;
};

System assemble(const TetMesh& mesh, const std::vector<WallSurface>& surface,
                const std::vector<bool>& reached) {
  System system;
  system.unknown.assign(surface.size(), -1);
  std::int32_t count = 0;
  for (std::size_t p = 0; p < surface.size(); ++p)
    if (reached[p] && surface[p] == WallSurface::kNone) system.unknown[p] = count++;
  system.right = Eigen::VectorXd::Zero(count);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(16 * mesh.cells().size());
  const std::vector<bool> takes_part = cells_of_system(mesh);
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const auto cell = static_cast<CellIndex>(c);
    if (!takes_part[c]) continue;
    const TetMesh::Tet& tet = mesh.cells()[c];
    if (!reached[tet[0]]) continue;
    const Mat3 g = mesh.barycentric_gradients(cell);
    const std::array<Vec3, 4> gradient{-g[0] - g[1] - g[2], g[0], g[1], g[2]};
    const double volume = volume_of(mesh, tet);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int32_t row = system.unknown[tet[i]];
      if (row < 0) continue;
      for (std::size_t j = 0; j < 4; ++j) {
        const double weight = volume * glm::dot(gradient[i], gradient[j]);
        if (const std::int32_t column = system.unknown[tet[j]]; column >= 0) {
          entries.emplace_back(row, column, weight);
        } else if (surface[tet[j]] == WallSurface::kOuter) {
          system.right[row] -= weight;
        }
      }
    }
  }
  system.matrix.resize(count, count);
  system.matrix.setFromTriplets(entries.begin(), entries.end());
  return system;
}

}  // namespace

WallLayer make_wall_layer(const DataSet& mesh, const std::string& file, int threads) {
  return make_wall_layer(*make_field_grid(std::span(&mesh, 1), file, threads), mesh, file);
}

WallLayer make_wall_layer(const FieldGrid& grid, const DataSet& mesh, const std::string& file) {
  const WallSurfaces surfaces = find_wall_surfaces(grid, mesh, file);
  const std::vector<bool> reached = reached_points(*grid.tets, surfaces.of_point);
  const System system = assemble(*grid.tets, surfaces.of_point, reached);

  WallLayer layer;
  layer.notes.push_back(surfaces.note);
  Eigen::VectorXd solution;
  if (system.right.size() > 0) {
    Solver solver;
    solver.setTolerance(kTolerance);
    solver.setMaxIterations(kMostIterations);
    solver.compute(system.matrix);
    if (solver.info() == Eigen::Success) solution = solver.solve(system.right);
    layer.iterations = static_cast<int>(solver.iterations());
    layer.residual = solver.error();
    if (solver.info() != Eigen::Success || !solution.allFinite())
      throw work_error(file + ": the layers of the wall were not found: " +
                       counted(static_cast<std::uint64_t>(layer.iterations), "iteration") +
                       " left a residual of " + short_number(layer.residual));
  }

  std::vector<double> values(mesh.point_count(), kNaN);
  std::size_t without = 0;
  for (std::size_t input = 0; input < values.size(); ++input) {
    const std::size_t p = grid.point_of_input.empty() ? input : grid.point_of_input[input];
    if (p >= reached.size() || !reached[p]) {
      ++without;
      continue;
    }
    const std::int32_t unknown = system.unknown[p];
    // Laplace's solution keeps to its border's range; what obtuse cells add to that is error.
    values[input] = unknown >= 0                                  ? std::clamp(solution[unknown], 0.0, 1.0)
                    : surfaces.of_point[p] == WallSurface::kOuter ? 1.0
                                                                  : 0.0;
  }
  if (without > 0)
    layer.notes.push_back(counted(without, "point") + " that no cell joins to a surface: no layer there");
  layer.array = make_array(kLayerArray, Association::kPoint, 1, std::span<const double>(values));
  return layer;
}

}  // namespace palpate
