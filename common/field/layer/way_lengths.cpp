#include "common/field/layer/way_lengths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/base/index.h"
#include "common/field/grid/tet_shape.h"

namespace palpate {
namespace {

/// One step of a way: to a place on a face, as the mean of its corners.
struct WayStep {
  double length = 0.0;
  std::array<std::uint32_t, 3> to{};
  std::array<double, 3> weight{};  ///< all zero: no step
};

/// Gradients of the barycentric coordinates of a cell.
std::array<Vec3, 4> corner_gradients(const TetMesh& mesh, CellIndex cell) {
  const Mat3 g = mesh.barycentric_gradients(cell);
  return {-g[0] - g[1] - g[2], g[0], g[1], g[2]};
}

/// @param way of any length, frame L.
WayStep step_from(const TetMesh& mesh, std::span<const double> potential, const CellsOfPoints& around,
                  std::uint32_t point, const Vec3& way, double sign) {
  WayStep best;
  double inside = -std::numeric_limits<double>::infinity();
  std::uint32_t lowest = point;
  for (std::size_t n = around.begin[point]; n < around.begin[point + 1]; ++n) {
    const auto cell = static_cast<CellIndex>(around.cells[n]);
    const TetMesh::Tet& tet = mesh.cells()[as_size(cell)];
    const std::array<Vec3, 4> gradients = corner_gradients(mesh, cell);
    WayStep step;
    double sum = 0.0, least = std::numeric_limits<double>::infinity(), positive = 0.0;
    std::size_t i = 0;
    bool known = true;
    for (std::size_t k = 0; k < 4; ++k) {
      if (tet[k] == point) continue;
      const double rate = glm::dot(gradients[k], way);
      known = known && !std::isnan(potential[tet[k]]);
      if (sign * potential[tet[k]] < sign * potential[lowest]) lowest = tet[k];
      sum += rate;
      least = std::min(least, rate);
      step.to[i] = tet[k];
      step.weight[i] = std::max(0.0, rate);
      positive += step.weight[i++];
    }
    if (!known || !(sum > 0.0) || !(least / sum > inside)) continue;
    // Where no cell lies that way, as at the border, the way keeps to the face that is nearest to it.
    Vec3 place{0.0};
    double there = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      step.weight[k] /= positive;
      place += step.weight[k] * mesh.points()[step.to[k]];
      there += step.weight[k] * potential[step.to[k]];
    }
    if (!(sign * there < sign * potential[point])) continue;
    inside = least / sum;
    step.length = glm::distance(place, mesh.points()[point]);
    best = step;
  }
  if (best.length == 0.0 && lowest != point)
    best = {.length = glm::distance(mesh.points()[lowest], mesh.points()[point]),
            .to = {lowest, lowest, lowest},
            .weight = {1.0, 0.0, 0.0}};
  return best;
}

}  // namespace

CellsOfPoints cells_of_points(const TetMesh& mesh) {
  CellsOfPoints around;
  around.begin.assign(mesh.points().size() + 1, 0);
  const auto visit = [&](const auto& act) {
    for (std::size_t c = 0; c < mesh.cells().size(); ++c)
      if (!mesh.zero_volume(static_cast<CellIndex>(c)))
        for (const std::uint32_t p : mesh.cells()[c]) act(p, c);
  };
  visit([&](std::uint32_t p, std::size_t) { ++around.begin[p + 1]; });
  std::partial_sum(around.begin.begin(), around.begin.end(), around.begin.begin());
  around.cells.resize(around.begin.back());
  std::vector<std::size_t> next(around.begin.begin(), around.begin.end() - 1);
  visit([&](std::uint32_t p, std::size_t c) { around.cells[next[p]++] = static_cast<std::uint32_t>(c); });
  return around;
}

std::vector<Vec3> gradient_directions(const TetMesh& mesh, std::span<const double> values) {
  std::vector<Vec3> sums(mesh.points().size(), Vec3{0.0});
  std::vector<double> volumes(sums.size());
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const auto cell = static_cast<CellIndex>(c);
    const TetMesh::Tet& tet = mesh.cells()[c];
    if (mesh.zero_volume(cell)) continue;
    const Vec3 gradient = mesh.barycentric_gradients(cell) * Vec3{values[tet[1]] - values[tet[0]],
                                                                  values[tet[2]] - values[tet[0]],
                                                                  values[tet[3]] - values[tet[0]]};
    const double length = glm::length(gradient);
    if (!std::isfinite(length)) continue;
    const double volume = TetShape(mesh.points().data(), tet).volume6;
    for (const std::uint32_t p : tet) {
      if (length > 0.0) sums[p] += volume * (gradient / length);
      volumes[p] += volume;
    }
  }
  for (std::size_t p = 0; p < sums.size(); ++p)
    if (volumes[p] > 0.0) sums[p] /= volumes[p];
  return sums;
}

std::vector<double> way_lengths(const TetMesh& mesh, std::span<const double> potential, WayAlong along) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double sign = along == WayAlong::kFalling ? 1.0 : -1.0;
  const CellsOfPoints around = cells_of_points(mesh);
  const std::vector<Vec3> directions = gradient_directions(mesh, potential);
  std::vector<std::uint32_t> order;
  double start = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < potential.size(); ++p) {
    if (std::isnan(potential[p])) continue;
    order.push_back(static_cast<std::uint32_t>(p));
    start = std::min(start, sign * potential[p]);
  }
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return potential[a] == potential[b] ? a < b : sign * potential[a] < sign * potential[b];
  });

  std::vector<double> lengths(potential.size(), kNone);
  std::vector<WayStep> steps(potential.size());
  std::vector<std::uint32_t> sought;
  double scale = 0.0;
  for (const std::uint32_t p : order) {
    if (sign * potential[p] == start) {
      lengths[p] = 0.0;
      continue;
    }
    const WayStep step = step_from(mesh, potential, around, p, -sign * directions[p], sign);
    if (step.weight[0] + step.weight[1] + step.weight[2] == 0.0) continue;
    lengths[p] = 0.0;
    steps[p] = step;
    sought.push_back(p);
    scale = std::max(scale, step.length);
  }
  // Most corners of a step lie lower and are known; a few rounds settle the others.
  constexpr int kMostRounds = 500;
  constexpr double kSettled = 1e-9;  // of the longest step
  for (int round = 0; round < kMostRounds; ++round) {
    double change = 0.0;
    for (const std::uint32_t p : sought) {
      double length = steps[p].length;
      for (std::size_t k = 0; k < 3; ++k)
        if (steps[p].weight[k] > 0.0) length += steps[p].weight[k] * lengths[steps[p].to[k]];
      if (length != lengths[p])
        change = std::max(change, std::isnan(length) ? 0.0 : std::abs(length - lengths[p]));
      lengths[p] = length;
    }
    if (change <= kSettled * scale) break;
  }
  return lengths;
}

}  // namespace palpate
