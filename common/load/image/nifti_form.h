/// The two forms by which a NIfTI header places voxels (nifti1.h): the qform, a rotation with steps, and the sform.
#pragma once

#include <array>
#include <optional>

#include "common/field/data_set.h"

namespace palpate {

/// Millimetres in the unit of length of `xyzt_units`; 1 where none is named.
[[nodiscard]] constexpr double nifti_millimetres(int units) noexcept {
  constexpr int kLengths = 7, kMetre = 1, kMicron = 3;
  return (units & kLengths) == kMetre ? 1e3 : (units & kLengths) == kMicron ? 1e-3 : 1.0;
}

/// The fields of a qform as they stand in the header: niftilib takes zeros and ones in place of what is not finite.
struct NiftiQform {
  std::array<double, 3> quaternion{}, offset{};  ///< b, c, d; of the first voxel
  std::array<double, 4> steps{};                 ///< pixdim: the first is qfac
};

/// Whether places are finite and the axes span space, of any unit: it is their directions that count.
[[nodiscard]] bool spans_volume(const UniformTopology& topology) noexcept;

/// Method 2 of nifti1.h, with steps of 1 where none are stated. Nothing where its numbers are no rotation, steps
/// and place. @param unit [mm].
[[nodiscard]] std::optional<UniformTopology> place_by(const NiftiQform& qform, const Index3& points,
                                                      double unit) noexcept;

/// The qform of axes, without its place; nothing where they are not at right angles.
[[nodiscard]] std::optional<NiftiQform> qform_of(const Mat3& axes) noexcept;

}  // namespace palpate
