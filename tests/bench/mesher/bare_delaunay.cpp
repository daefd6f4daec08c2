#include "tests/bench/mesher/bare_delaunay.h"

#include <vector>

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace palpate {

std::size_t bare_delaunay_cells(std::span<const Vec3> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> places;
  places.reserve(points.size());
  for (const Vec3& x : points) places.emplace_back(x.x, x.y, x.z);
  const CGAL::Delaunay_triangulation_3<Kernel> triangulation(places.begin(), places.end());
  return triangulation.number_of_finite_cells();
}

}  // namespace palpate
