#include "common/field/layer/laplace.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/job.h"
#include "common/base/ledger.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/field/grid/tet_shape.h"

namespace palpate {
namespace {

/// Volume over the cube of the longest edge below which a cell has no say: 0.118 for a regular one. Such a
/// sliver ties its corners to one plane of values, however thin it is, which throws values far out of range;
/// without it its neighbours still meet at all four corners.
constexpr double kThin = 1e-3;
/// Residual over right side. Depths are then within some 1e-7 of the discrete solution (measured on a million
/// tetrahedra), which is itself 1e-3 or more away from the potential.
constexpr double kTolerance = 1e-8;
constexpr int kMostIterations = 20'000;

using Matrix = Eigen::SparseMatrix<double>;
/// The factor, which is asked once in each iteration: a job that is cancelled meanwhile ends there.
class CheckedFactor : public Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>> {
 public:
  using IncompleteCholesky::IncompleteCholesky;

  template <typename Right>
  [[nodiscard]] auto solve(const Eigen::MatrixBase<Right>& right) const {
    check_job();
    return IncompleteCholesky::solve(right);
  }
};

/// Conjugate gradients with an incomplete Cholesky factor, which Eigen scales by the columns and shifts until it
/// exists. In the order of the points: one that saves fill in a full factor spoils an incomplete one (four times
/// the iterations on a million tetrahedra).
class Solver : public Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper, CheckedFactor> {
 public:
  explicit Solver(const Matrix& matrix) {
    setTolerance(kTolerance);
    setMaxIterations(kMostIterations);
    compute(matrix);
  }
};
/// With its orientation's sign.
double volume_of(const TetMesh& mesh, const TetMesh::Tet& tet) {
  const Vec3 x0 = mesh.points()[tet[0]];
  return glm::determinant(
             Mat3{mesh.points()[tet[1]] - x0, mesh.points()[tet[2]] - x0, mesh.points()[tet[3]] - x0}) /
         6.0;
}

bool is_thin(const TetMesh& mesh, CellIndex cell) {
  if (mesh.zero_volume(cell)) return true;
  const TetMesh::Tet& tet = mesh.cells()[as_size(cell)];
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
std::vector<bool> reached_points(const TetMesh& mesh, std::span<const double> given) {
  std::vector<bool> reached(given.size());
  for (std::size_t p = 0; p < given.size(); ++p) reached[p] = !std::isnan(given[p]);
  std::vector<CellIndex> front;
  std::vector<bool> visited(mesh.cells().size());
  const auto visit = [&](CellIndex cell) {
    const auto c = as_size(cell);
    if (visited[c] || mesh.zero_volume(cell)) return;
    visited[c] = true;
    front.push_back(cell);
  };
  for (std::size_t c = 0; c < mesh.cells().size(); ++c)
    for (const std::uint32_t p : mesh.cells()[c])
      if (!std::isnan(given[p])) visit(static_cast<CellIndex>(c));
  while (!front.empty()) {
    const auto c = as_size(front.back());
    front.pop_back();
    for (const std::uint32_t p : mesh.cells()[c]) reached[p] = true;
    for (const CellIndex neighbor : mesh.neighbors()[c])
      if (neighbor != kNoCell) visit(neighbor);
  }
  return reached;
}

/// The linear system of the points whose value is sought.
struct System {
  std::size_t thin_cells = 0;           ///< that have no say
  std::vector<std::int32_t> unknown;    ///< of each point; -1 where its value is given or it is not reached
  std::vector<std::uint32_t> point_of;  ///< of each unknown
  Matrix matrix;
  Eigen::VectorXd right;
};

/// The cells that have a say at each unknown, by rising number.
struct CellsOfRows {
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> cells;
};

CellsOfRows cells_of_rows(const TetMesh& mesh, const System& system, const std::vector<bool>& takes_part) {
  CellsOfRows rows;
  rows.begin.assign(system.point_of.size() + 1, 0);
  const auto visit = [&](const auto& act) {
    for (std::size_t c = 0; c < takes_part.size(); ++c) {
      if (!takes_part[c]) continue;
      for (const std::uint32_t p : mesh.cells()[c])
        if (system.unknown[p] >= 0) act(as_size(system.unknown[p]), c);
    }
  };
  visit([&](std::size_t row, std::size_t) { ++rows.begin[row + 1]; });
  std::partial_sum(rows.begin.begin(), rows.begin.end(), rows.begin.begin());
  rows.cells.resize(rows.begin.back());
  std::vector<std::size_t> next(rows.begin.begin(), rows.begin.end() - 1);
  visit([&](std::size_t row, std::size_t c) { rows.cells[next[row]++] = static_cast<std::uint32_t>(c); });
  return rows;
}

/// Some rows of the matrix, one after another.
struct RowPiece {
  std::vector<std::int32_t> lengths, columns;
  std::vector<double> weights;
};

/// Rows [first, last). Each is summed over its cells by rising number, and so is its mirror image: the matrix
/// is symmetric to the last bit, whatever the number of threads.
/// @param place of each unknown in the row at hand; -1 for all, before and after.
RowPiece make_rows(const TetMesh& mesh, std::span<const double> given, const CellsOfRows& rows,
                   std::size_t first, std::size_t last, System& system, std::vector<std::int32_t>& place) {
  RowPiece piece;
  std::vector<std::pair<std::int32_t, double>> row;
  for (std::size_t r = first; r < last; ++r) {
    const std::uint32_t here = system.point_of[r];
    row.clear();
    double right = 0.0;
    for (std::size_t n = rows.begin[r]; n < rows.begin[r + 1]; ++n) {
      const TetMesh::Tet& tet = mesh.cells()[rows.cells[n]];
      const TetShape shape(mesh.points().data(), tet);
      const std::array<Vec3, 4> inward{-(shape.n1 + shape.n2 + shape.n3), shape.n1, shape.n2, shape.n3};
      const auto i = as_size(std::find(tet.begin(), tet.end(), here) - tet.begin());
      // The gradient of b_j is n_j / V: their products times the volume V / 6.
      const double scale = 1.0 / (6.0 * shape.volume6);
      for (std::size_t j = 0; j < 4; ++j) {
        const double weight = scale * glm::dot(inward[i], inward[j]);
        const std::int32_t column = system.unknown[tet[j]];
        if (column < 0) {
          if (!std::isnan(given[tet[j]])) right -= weight * given[tet[j]];
          continue;
        }
        std::int32_t& at = place[as_size(column)];
        if (at < 0) {
          at = static_cast<std::int32_t>(row.size());
          row.emplace_back(column, 0.0);
        }
        row[as_size(at)].second += weight;
      }
    }
    for (const auto& entry : row) place[as_size(entry.first)] = -1;
    std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    piece.lengths.push_back(static_cast<std::int32_t>(row.size()));
    for (const auto& [column, weight] : row) {
      piece.columns.push_back(column);
      piece.weights.push_back(weight);
    }
    system.right[static_cast<Eigen::Index>(r)] = right;
  }
  return piece;
}

System assemble(const TetMesh& mesh, std::span<const double> given, const std::vector<bool>& reached,
                int threads) {
  System system;
  system.unknown.assign(given.size(), -1);
  for (std::size_t p = 0; p < given.size(); ++p) {
    if (!reached[p] || !std::isnan(given[p])) continue;
    system.unknown[p] = static_cast<std::int32_t>(system.point_of.size());
    system.point_of.push_back(static_cast<std::uint32_t>(p));
  }
  const std::size_t count = system.point_of.size();
  system.right = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count));
  const std::vector<bool> takes_part = cells_of_system(mesh);
  system.thin_cells = as_size(std::count(takes_part.begin(), takes_part.end(), false));
  const CellsOfRows rows = cells_of_rows(mesh, system, takes_part);
  constexpr std::size_t kPiece = 16384;  // rows
  std::vector<RowPiece> pieces((count + kPiece - 1) / kPiece);
  parallel_for(pieces.size(), threads, [&](std::size_t first, std::size_t last) {
    std::vector<std::int32_t> place(count, -1);
    for (std::size_t n = first; n < last; ++n)
      pieces[n] = make_rows(mesh, given, rows, n * kPiece, std::min(count, (n + 1) * kPiece), system, place);
  });
  std::size_t entries = 0;
  for (const RowPiece& piece : pieces) entries += piece.columns.size();
  // Rows of a symmetric matrix are its columns, which is how Eigen keeps them.
  system.matrix.resize(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
  system.matrix.resizeNonZeros(static_cast<Eigen::Index>(entries));
  auto* begin = system.matrix.outerIndexPtr();
  auto* columns = system.matrix.innerIndexPtr();
  auto* weights = system.matrix.valuePtr();
  *begin = 0;
  for (const RowPiece& piece : pieces) {
    for (const std::int32_t length : piece.lengths) {
      begin[1] = begin[0] + length;
      ++begin;
    }
    columns = std::copy(piece.columns.begin(), piece.columns.end(), columns);
    weights = std::copy(piece.weights.begin(), piece.weights.end(), weights);
  }
  return system;
}

}  // namespace

WallPotential solve_laplace(const TetMesh& mesh, std::span<const double> given, const std::string& file,
                            int threads) {
  const Work work("Laplace's equation", "layers and coordinates of the wall");
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const std::vector<bool> reached = reached_points(mesh, given);
  const System system = assemble(mesh, given, reached, threads);
  WallPotential potential;
  potential.thin_cells = system.thin_cells;
  Eigen::VectorXd found = Eigen::VectorXd::Zero(system.right.size());
  if (system.right.norm() != 0.0) {  // else zero is the solution
    potential.residual = 1.0;
    const Solver solver(system.matrix);
    if (solver.info() == Eigen::Success) {
      found = solver.solve(system.right);
      potential.iterations = static_cast<int>(solver.iterations());
      potential.residual = solver.error();
    }
  }
  if (!(potential.residual <= kTolerance) || !found.allFinite())
    throw work_error(file + ": Laplace's equation was not solved in the wall: " +
                     counted(static_cast<std::uint64_t>(potential.iterations), "iteration") +
                     " left a residual of " + short_number(potential.residual));

  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const double value : given) {
    if (std::isnan(value)) continue;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  constexpr double kBeyond = 1e-6;  // of the range: less is the solver's
  potential.values.assign(given.begin(), given.end());
  for (std::size_t p = 0; p < given.size(); ++p) {
    if (!std::isnan(given[p])) continue;
    const std::int32_t unknown = system.unknown[p];
    if (unknown < 0) {
      potential.values[p] = kNaN;
      continue;
    }
    // Laplace's solution keeps to its border's range; what obtuse cells add to that is error.
    const double value = found[unknown];
    potential.values[p] = std::clamp(value, lowest, highest);
    const double off = std::abs(value - potential.values[p]);
    if (off > kBeyond * (highest - lowest)) ++potential.beyond;
    potential.farthest = std::max(potential.farthest, off);
  }
  return potential;
}

}  // namespace palpate
