#include "common/field/cells/same_place.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "common/base/index.h"
#include "common/math/vec.h"

namespace palpate {
namespace {

bool before(const Vec3& a, const Vec3& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

}  // namespace

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

}  // namespace palpate
