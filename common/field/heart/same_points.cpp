#include "common/field/heart/same_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "common/base/index.h"

namespace palpate {
namespace {

constexpr std::uint8_t kVtkPolyhedron = 42;

bool before(const Vec3& a, const Vec3& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

/// For every point the first one at its place.
std::vector<std::int64_t> first_at_place(const DataArray& positions) {
  std::vector<Vec3> x(positions.tuples);
  std::vector<std::int64_t> first(x.size()), order;
  std::iota(first.begin(), first.end(), std::int64_t{0});
  order.reserve(x.size());
  for (std::size_t p = 0; p < x.size(); ++p) {
    x[p] = {positions.at(p, 0), positions.at(p, 1), positions.at(p, 2)};
    // Cells with such a point are left out; they have no order either.
    if (is_finite(x[p])) order.push_back(static_cast<std::int64_t>(p));
  }
  const auto at = [&x](std::int64_t p) -> const Vec3& { return x[as_size(p)]; };
  std::sort(order.begin(), order.end(),
            [&](std::int64_t p, std::int64_t q) { return at(p) == at(q) ? p < q : before(at(p), at(q)); });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (at(order[i]) == at(order[i - 1])) first[as_size(order[i])] = first[as_size(order[i - 1])];
  return first;
}

}  // namespace

std::size_t join_same_points(DataSet& mesh) {
  auto* cells = std::get_if<UnstructuredTopology>(&mesh.topology);
  if (cells == nullptr || cells->positions.components != 3) return 0;
  // The streams of polyhedra hold counts between their points.
  if (std::find(cells->types.begin(), cells->types.end(), kVtkPolyhedron) != cells->types.end()) return 0;
  const std::vector<std::int64_t> first = first_at_place(cells->positions);
  std::vector<std::uint8_t> joined(first.size(), 0);
  for (std::int64_t& p : cells->connectivity) {
    // What names no point is refused where cells are split.
    if (p < 0 || as_size(p) >= first.size()) continue;
    const std::int64_t of = first[as_size(p)];
    if (of != p) joined[as_size(p)] = 1;
    p = of;
  }
  return as_size(std::count(joined.begin(), joined.end(), std::uint8_t{1}));
}

}  // namespace palpate
