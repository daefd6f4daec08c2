/// Numbers at the points of a box of which most are alike: a NanoVDB grid of single precision, read-only.
///
/// Symbols.  p point of the box, 0 <= p < points; v = p + shift the voxel of the tree that it is;
/// b = floor(v / 8) its block: the voxels of one leaf of the tree, or part of a node that has one number.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "common/base/index.h"
#include "common/math/lattice.h"
#include "common/math/vec.h"

namespace palpate {

inline constexpr int kBlockSide = 8;                                         ///< voxels an axis
inline constexpr std::size_t kBlockVoxels = 512;                             ///< kBlockSide^3
inline constexpr std::uint64_t kMostSparsePoints = std::uint64_t{1} << 34U;  ///< of a box: 2580^3

/// Place of a voxel in its block, z fastest.
[[nodiscard]] constexpr std::size_t block_offset(const Index3& v) noexcept {
  constexpr int kMask = kBlockSide - 1;
  const auto x = as_size(v.x & kMask), y = as_size(v.y & kMask), z = as_size(v.z & kMask);
  return (x * kBlockSide + y) * kBlockSide + z;
}

/// The numbers of a block.
struct SparseBlock {
  const float* numbers = nullptr;  ///< kBlockVoxels of them, z fastest; null: all are `constant`
  float constant = 0.0F;

  [[nodiscard]] float at(const Index3& v) const noexcept {
    return numbers != nullptr ? numbers[block_offset(v)] : constant;
  }
};

/// Points from `first` to before `end`.
struct PointBox {
  Index3 first{0}, end{0};

  [[nodiscard]] std::uint64_t count() const noexcept {
    const Index3 n = end - first;
    return count_of(n);
  }
};

/// What a NanoVDB grid lies in, aligned as it must be.
struct alignas(64) SparseChunk {
  std::array<std::byte, 64> bytes{};
};

/// Immutable and shared.
class SparseNumbers {
 public:
  /// Takes a NanoVDB grid of floats where it lies in memory. All counts and offsets are checked first:
  /// whatever `bytes` hold, nothing outside them is read.
  /// @param owner keeps `bytes` alive. @param shift in [0, kBlockSide) an axis.
  /// @throws std::invalid_argument that says what is wrong.
  SparseNumbers(std::span<const std::byte> bytes, std::shared_ptr<const void> owner, const Index3& shift,
                const Index3& points);

  [[nodiscard]] const Index3& points() const noexcept { return points_; }
  [[nodiscard]] const Index3& shift() const noexcept { return shift_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }  ///< points
  /// Of all blocks that the tree does not have; it need not occur in the box.
  [[nodiscard]] float background() const noexcept;
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }

  [[nodiscard]] Index3 blocks() const noexcept { return (points_ + shift_ + (kBlockSide - 1)) / kBlockSide; }
  /// @pre b in [0, blocks()). @rt Safe.
  [[nodiscard]] SparseBlock block(const Index3& b) const noexcept;
  /// The points of a block that lie in the box. @pre as block().
  [[nodiscard]] PointBox points_of(const Index3& b) const noexcept {
    const Index3 first = kBlockSide * b - shift_;
    return {glm::max(first, Index3(0)), glm::min(first + kBlockSide, points_)};
  }

  /// The number at a point, x fastest. @pre index < size(). @rt Safe.
  [[nodiscard]] float operator[](std::size_t index) const noexcept;
  /// Writes the numbers of the points of `box`, x fastest. @pre `box` lies in the box of all points.
  void copy(const PointBox& box, float* to) const noexcept;

  /// The same with f(number) in place of each number.
  [[nodiscard]] std::shared_ptr<const SparseNumbers> mapped(const std::function<float(float)>& f) const;

 private:
  std::span<const std::byte> bytes_;
  std::shared_ptr<const void> owner_;
  Index3 shift_, points_;
  std::size_t size_;
  const void* root_;  ///< of the tree
};

/// Reads numbers of points that lie near each other: the block of the last one is at hand. @rt Safe.
class SparseReader {
 public:
  explicit SparseReader(const SparseNumbers& numbers) noexcept : numbers_(&numbers) {}

  /// @pre p lies in the box.
  [[nodiscard]] float at(const Index3& p) noexcept {
    constexpr int kBits = 3;  // of kBlockSide
    const Index3 v = p + numbers_->shift(), b(v.x >> kBits, v.y >> kBits, v.z >> kBits);
    if (b != at_) {
      at_ = b;
      block_ = numbers_->block(b);
    }
    return block_.at(v);
  }

 private:
  const SparseNumbers* numbers_;
  Index3 at_{-1};
  SparseBlock block_;
};

}  // namespace palpate
