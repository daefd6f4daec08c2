/// Several directions of fibres in each voxel of an image, none of them with a sign: what lines follow through
/// crossings.
///
/// Whoever comes along a direction follows in each voxel the peak that is nearest to it in angle. Of the eight voxels
/// around a place only these are interpolated, so that bundles that cross are never mixed, in whatever order the peaks
/// of a voxel stand. Voxels without a peak within kWidest are left out as voxels without any are, and the rule of
/// TensorField holds: those that are left must have more than half of the weight.
#pragma once

#include <cstddef>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/tensor/tensor_field.h"

namespace palpate {

/// The tensor of a fibre alone: alike across it, with that anisotropy and the mean diffusivity of white and grey
/// matter. @pre `unit` is of length 1, 0 <= fa <= 1.
[[nodiscard]] Mat3 fibre_tensor(const Vec3& unit, double fa) noexcept;

class PeakField {
 public:
  static constexpr double kWidest = 45.0;  ///< [degrees] between the way and the peak that is followed

  /// @param peaks x y z of one after the other, as long as fibre_tensor() is to be anisotropic; zero and NaN
  /// are none. @pre a tuple for each voxel, of 3 n numbers.
  PeakField(const UniformTopology& voxels, const DataArray& peaks);

  struct Sample : TensorSample {
    bool turned_away = false;  ///< kBadData though there are peaks: all of them lie across the way
  };
  /// The mean of fibre_tensor() of the peaks nearest to `toward`. @param x data coordinates. @param toward of
  /// unit length. @rt Safe.
  [[nodiscard]] Sample sample(const Vec3& x, const Vec3& toward) const noexcept;

  [[nodiscard]] std::size_t most() const noexcept { return most_; }  ///< peaks of a voxel
  /// Peak number `n` of the voxel nearest to `x`; zero where there is none. @pre n < most(). @rt Safe.
  [[nodiscard]] Vec3 peak(const Vec3& x, std::size_t n) const noexcept;
  /// The longest of these, of equals the first; zero where there is none. @rt Safe.
  [[nodiscard]] Vec3 longest(const Vec3& x) const noexcept;
  /// That of these which is nearest to `toward`; zero where there is none. @rt Safe.
  [[nodiscard]] Vec3 nearest(const Vec3& x, const Vec3& toward) const noexcept;

 private:
  [[nodiscard]] Vec3 at(std::size_t voxel, std::size_t n) const noexcept;
  [[nodiscard]] Vec3 nearest_of(std::size_t voxel, const Vec3& toward) const noexcept;
  /// Number of the voxel nearest to `x`; kNone outside.
  [[nodiscard]] std::size_t voxel_at(const Vec3& x) const noexcept;

  static constexpr std::size_t kNone = ~std::size_t{0};

  UniformTopology voxels_;
  Mat3 index_from_data_;
  std::size_t most_;
  std::vector<float> peaks_;
};

}  // namespace palpate
