#include "common/field/layer/wall_measures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/way_lengths.h"

namespace palpate {
namespace {

/// Whether the steepest ways over edges lead from each point to `end`.
/// @param sign 1: up, -1: down.
std::vector<bool> leads_to(const TetMesh& mesh, std::span<const double> depth,
                           const std::vector<WallSurface>& surface, WallSurface end, double sign) {
  std::vector<std::uint32_t> next(depth.size()), order(depth.size());
  std::iota(next.begin(), next.end(), 0U);
  order = next;
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    if (mesh.zero_volume(static_cast<CellIndex>(c))) continue;
    for (const std::uint32_t p : mesh.cells()[c])
      for (const std::uint32_t q : mesh.cells()[c])
        if (sign * depth[q] > sign * depth[next[p]]) next[p] = q;
  }
  std::erase_if(order, [&](std::uint32_t p) { return std::isnan(depth[p]); });
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return depth[a] == depth[b] ? a < b : sign * depth[a] > sign * depth[b];
  });
  std::vector<bool> leads(depth.size());
  for (const std::uint32_t p : order) leads[p] = surface[p] == end || (next[p] != p && leads[next[p]]);
  // A corner of the other surface, as stairs have them, of which no edge leads into the wall.
  std::vector<bool> corner(depth.size());
  for (const std::uint32_t p : order) corner[p] = !leads[p] && surface[p] != WallSurface::kNone;
  const auto each_edge = [&mesh](const auto& visit) {
    for (const TetMesh::Tet& cell : mesh.cells())
      for (const std::uint32_t p : cell)
        for (const std::uint32_t q : cell) visit(p, q);
  };
  each_edge([&](std::uint32_t p, std::uint32_t q) {
    if (surface[p] != surface[q]) corner[p] = false;
  });
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round)
    each_edge([&](std::uint32_t p, std::uint32_t q) {
      if (corner[p] && leads[q]) leads[p] = true;
    });
  return leads;
}

}  // namespace

double monotone_share(const FieldGrid& grid, const WallSurfaces& surfaces, std::span<const double> depth) {
  const std::vector<bool> up = leads_to(*grid.tets, depth, surfaces.of_point, WallSurface::kOuter, 1.0);
  const std::vector<bool> down = leads_to(*grid.tets, depth, surfaces.of_point, WallSurface::kInner, -1.0);
  std::size_t both_ways = 0;
  for (std::size_t p = 0; p < depth.size(); ++p) both_ways += up[p] && down[p] ? 1 : 0;
  return static_cast<double>(both_ways) / static_cast<double>(std::max<std::size_t>(1, depth.size()));
}

std::string monotone_doubt(double share) {
  constexpr double kMonotone = 0.97;  // rims of a septum lose some points
  if (!(share < kMonotone)) return {};
  return "WARNING: the depth does not rise through the wall from " +
         short_number(std::round(1000.0 * (1.0 - share)) / 10.0) +
         " % of the points: a surface may be taken for another one, or the mesh is coarse";
}

std::string inward_doubt(const FieldGrid& grid, const DataArray& depth) {
  constexpr double kEnd = 0.05;  // of the range
  std::vector<double> of_point(grid.tets->points().size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t input = 0; input < depth.tuples; ++input) {
    const std::size_t p = grid.point_of_input.empty() ? input : grid.point_of_input[input];
    if (p < of_point.size()) of_point[p] = depth.at(input);
  }
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double value : of_point) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  Box low, high;
  for (std::size_t p = 0; p < of_point.size(); ++p) {
    if (of_point[p] <= least + kEnd * (most - least)) low.include(grid.tets->points()[p]);
    if (of_point[p] >= most - kEnd * (most - least)) high.include(grid.tets->points()[p]);
  }
  if (!(low.diagonal() > high.diagonal())) return {};
  const double scale = grid.frame.length_scale();
  return "WARNING: the depth '" + depth.name + "' rises inwards: where it is " + short_number(least) +
         " the wall is " + short_number(scale * low.diagonal()) + " across, where it is " +
         short_number(most) + " " + short_number(scale * high.diagonal()) +
         "; it should rise from the inner to the outer surface";
}

WallMeasures measure_wall(const FieldGrid& grid, const WallSurfaces& surfaces,
                          std::span<const double> depth) {
  const TetMesh& mesh = *grid.tets;
  WallMeasures measures{.monotone = monotone_share(grid, surfaces, depth), .thickness = {}};
  const std::vector<double> inwards = way_lengths(mesh, depth, WayAlong::kFalling);
  const std::vector<double> outwards = way_lengths(mesh, depth, WayAlong::kRising);
  const double scale = grid.frame.length_scale();
  std::vector<double> of_inner;
  for (std::size_t p = 0; p < depth.size(); ++p) {
    measures.thickness.push_back(scale * (inwards[p] + outwards[p]));
    if (surfaces.of_point[p] == WallSurface::kInner && std::isfinite(measures.thickness[p]))
      of_inner.push_back(measures.thickness[p]);
  }
  if (of_inner.empty()) return measures;
  std::sort(of_inner.begin(), of_inner.end());
  measures.thinnest = of_inner.front();
  measures.median = of_inner[of_inner.size() / 2];
  measures.thickest = of_inner.back();
  return measures;
}

}  // namespace palpate
