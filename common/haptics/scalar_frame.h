/// Reference directions of a scalar field: its gradient, and the principal curvatures of its isosurfaces
/// (Ikits 2006, sec. 6.2).
///
/// With g the gradient, H the Hessian, n = g / |g| and P = 1 - n n^T, the isosurface through a point has the
/// shape operator (Kindlmann, Whitaker, Tasdizen and Möller 2003)
///
///   G = -P H P / |g|                                                                                  (1)
///
/// on its tangent plane: eigenvectors the principal directions, eigenvalues the curvatures k_1 >= k_2,
/// positive where the surface curves towards n. Derivatives are differences over a fixed spacing (measure.h),
/// which do not leap from cell to cell.
///
/// e_1 fades where |g| vanishes. e_2 and e_3 fade into each other where k_1 = k_2, on planes and spheres;
/// they have no sign, and keep that of the step before.
#pragma once

#include <memory>

#include "common/field/scalar_field.h"
#include "common/haptics/reference_frame.h"
#include "common/haptics/workspace.h"

namespace palpate {

/// Which side e_1 points to: that is the free one of a unilateral axis.
enum class Outward : std::uint8_t { kRising, kFalling };
/// What e_2 and e_3 are.
enum class Tangents : std::uint8_t {
  kOpen,      ///< any two across e_1
  kPrincipal  ///< the directions of the larger and of the smaller curvature
};

class ScalarFrame final : public ReferenceFrame {
 public:
  /// Steepness from which on the gradient counts as certain, by default: part of the mean one of a ramp over
  /// all values along the diagonal.
  static constexpr double kCertainPart = 0.25;
  /// Difference of curvatures from which on the principal directions count as certain [1/m]: those of a
  /// cylinder of 10 cm radius, which a hand can tell from a plane.
  static constexpr double kCertainCurvature = 10.0;

  /// @param certain_part of the steepness (highest - lowest) / diagonal, > 0.
  ScalarFrame(std::shared_ptr<const ScalarField> field, const Workspace& workspace, Outward outward,
              Tangents tangents = Tangents::kOpen, double certain_part = kCertainPart);
  [[nodiscard]] FrameSample at(const Vec3& x, const Mat3& last) noexcept override;

 private:
  std::shared_ptr<const ScalarField> field_;
  Workspace workspace_;
  Outward outward_;
  Tangents tangents_;
  double certain_steepness_;  ///< data units
  double spacing_;            ///< data units
  CellHint hint_;
};

}  // namespace palpate
