/// Sparse numbers from dense ones.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "common/field/grid/sparse/sparse_builder.h"

namespace palpate::test {

/// The numbers of the points of a box, x fastest, most of which are `background`, as sparse ones.
/// @pre numbers.size() is the number of points. @throws as SparseBuilder.
inline std::shared_ptr<const SparseNumbers> make_sparse(std::span<const float> numbers, const Index3& points,
                                                        float background, const Index3& shift = Index3(0)) {
  SparseBuilder builder(shift, points, background);
  std::array<float, kBlockVoxels> block{};
  const auto for_each = [](const Index3& count, const auto& visit) {
    for (Index3 at(0); at.x < count.x; ++at.x) {
      for (at.y = 0; at.y < count.y; ++at.y) {
        for (at.z = 0; at.z < count.z; ++at.z) visit(at);
      }
    }
  };
  for_each(builder.blocks(), [&](const Index3& b) {
    block.fill(background);
    const Index3 first = glm::max(kBlockSide * b - shift, Index3(0)),
                 end = glm::min(kBlockSide * (b + 1) - shift, points);
    for_each(end - first, [&](const Index3& at) {
      const Index3 p = first + at;
      block[block_offset(p + shift)] =
          numbers[static_cast<std::size_t>(p.x) +
                  static_cast<std::size_t>(points.x) *
                      (static_cast<std::size_t>(p.y) +
                       static_cast<std::size_t>(points.y) * static_cast<std::size_t>(p.z))];
    });
    builder.put(b, block);
  });
  return builder.finish();
}

}  // namespace palpate::test
