#include "apps/cardiac/mesher/delaunay.h"

#include <cstdint>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_data_structure_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include "common/base/error.h"

namespace palpate {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel,
                                                           CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
// Hidden points, of which there are none, would cost a vector in every cell.
using Cell = CGAL::Regular_triangulation_cell_base_3<
    Kernel, CGAL::Triangulation_cell_base_with_info_3<CellIndex, Kernel>, CGAL::Discard_hidden_points>;
using Triangulation =
    CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
using WeightedPoint = Triangulation::Weighted_point;

/// In [0, 1), from the bits of a number (Steele et al., Fast splittable pseudorandom number generators,
/// 2014).
double drawn(std::uint64_t number) {
  number += 0x9e3779b97f4a7c15U;
  number = (number ^ (number >> 30U)) * 0xbf58476d1ce4e5b9U;
  number = (number ^ (number >> 27U)) * 0x94d049bb133111ebU;
  return static_cast<double>((number ^ (number >> 31U)) >> 11U) * 0x1p-53;
}

}  // namespace

DelaunayCells delaunay_cells(std::span<const Vec3> points, std::span<const double> spacing) {
  Triangulation triangulation;
  {
    std::vector<std::pair<WeightedPoint, std::uint32_t>> weighted;
    weighted.reserve(points.size());
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Vec3& x = points[p];
      const double weight = kLargestWeight * drawn(p) * spacing[p] * spacing[p];
      weighted.emplace_back(WeightedPoint(Kernel::Point_3(x.x, x.y, x.z), weight),
                            static_cast<std::uint32_t>(p));
    }
    triangulation.insert(weighted.begin(), weighted.end());
  }
  if (triangulation.dimension() < 3)
    throw work_error("the points lie in one plane or on one line: there is nothing to fill with tetrahedra");

  DelaunayCells cells;
  cells.tets.reserve(triangulation.number_of_finite_cells());
  cells.neighbors.reserve(triangulation.number_of_finite_cells());
  for (auto cell = triangulation.all_cells_begin(); cell != triangulation.all_cells_end(); ++cell)
    cell->info() = kNoCell;
  CellIndex count = 0;
  for (auto cell = triangulation.finite_cells_begin(); cell != triangulation.finite_cells_end(); ++cell)
    cell->info() = count++;
  for (auto cell = triangulation.finite_cells_begin(); cell != triangulation.finite_cells_end(); ++cell) {
    TetMesh::Tet tet{};
    TetMesh::Neighbors behind{};
    for (int i = 0; i < 4; ++i) {
      tet[static_cast<std::size_t>(i)] = cell->vertex(i)->info();
      behind[static_cast<std::size_t>(i)] = cell->neighbor(i)->info();
    }
    cells.tets.push_back(tet);
    cells.neighbors.push_back(behind);
  }
  return cells;
}

}  // namespace palpate
