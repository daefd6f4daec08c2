/// Makes sparse numbers block by block; what is left out has one number, the background.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "common/field/grid/sparse/sparse_numbers.h"
#include "common/math/vec.h"

namespace palpate {

/// Blocks, points and shifts are those of SparseNumbers. NaN counts as a number here.
class SparseBuilder {
 public:
  /// @throws std::invalid_argument where the box is empty or has more points than kMostSparsePoints.
  SparseBuilder(const Index3& shift, const Index3& points, float background);

  [[nodiscard]] const Index3& blocks() const noexcept { return blocks_; }
  /// Gives all voxels of a block one number. @pre b in [0, blocks()), put once.
  void put(const Index3& b, float number);
  /// Gives the voxels of a block their numbers, z fastest; where all are the same they cost nothing.
  void put(const Index3& b, std::span<const float, kBlockVoxels> numbers);

  /// @pre called once, last.
  [[nodiscard]] std::shared_ptr<const SparseNumbers> finish();

 private:
  /// Of a block, or of a part of the tree: the number of its leaf, kOne - i where it has the i-th of ones_.
  using Content = std::int64_t;
  static constexpr Content kOne = -1, kMixed = -(Content{1} << 60U);

  [[nodiscard]] Content content_of(float number);
  [[nodiscard]] Content at(const Index3& b) const noexcept;
  /// What all blocks of the cube of `side` blocks from `first` on have in common; kMixed: nothing.
  [[nodiscard]] Content common(const Index3& first, int side) const noexcept;
  [[nodiscard]] float number_of(Content content) const;

  Index3 shift_, points_, blocks_;
  std::vector<Content> contents_;  ///< of blocks, x fastest
  std::vector<float> ones_;        ///< the background, and numbers of blocks that have one
  std::deque<std::array<float, kBlockVoxels>> leaves_;
};

}  // namespace palpate
