/// Anisotropy drag (Ikits 2006, sec. 8.4): a linear constraint in the eigenframe of a diffusion tensor whose
/// drag thresholds follow the anisotropy. Either of two constructions, with tau(x) rising:
///
///   free in isotropic places (eqs. 8.6 to 8.8)      tau_1 = 0                tau_2 = tau(c_l)      tau_3 =
///   tau(c_l + c_p) held to a point there (eqs. 8.9 to 8.11)        tau_1 = tau(1 - c_l - c_p)   tau_2 =
///   tau(1 - c_p)  tau_3 = tau(1)
///
/// so a line along e_1 where diffusion is linear, a plane where it is planar. Where eigenvalues are equal
/// their axes may be turned freely; with both constructions these axes then have the same threshold (in the
/// first one as tau(0) = 0, which anisotropy_drag() asks for), and as drag acts jointly along them
/// (motion_rule.h) the hold does not depend on how they are turned. With the axis-by-axis rule of the
/// reference it would, by up to 41 %.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "common/field/tensor/tensor_field.h"
#include "common/haptics/constraint/linear.h"
#include "common/haptics/constraint/linear_settings.h"
#include "common/haptics/measure.h"
#include "common/haptics/reference_frame.h"
#include "common/haptics/workspace.h"

namespace palpate {

/// e_1 to e_3 of the tensor, by falling eigenvalues, their signs as those of the step before. Always certain:
/// thresholds make up for axes that are not.
class TensorFrame final : public ReferenceFrame {
 public:
  TensorFrame(std::shared_ptr<const TensorField> field, const Workspace& workspace)
      : field_(std::move(field)), workspace_(workspace) {}
  [[nodiscard]] FrameSample at(const Vec3& x, const Mat3& last) noexcept override;

 private:
  std::shared_ptr<const TensorField> field_;
  Workspace workspace_;
  CellHint hint_;
};

/// A sum of the barycentric measures of the tensor (diffusion_measures.h), in [0, 1].
class AnisotropyMeasure final : public SampledMeasure {
 public:
  enum class Sum : unsigned char {
    kLinear,        ///< c_l
    kLinearPlanar,  ///< c_l + c_p
    kNotPlanar,     ///< 1 - c_p = c_l + c_s
    kSpherical      ///< 1 - c_l - c_p = c_s
  };
  AnisotropyMeasure(std::shared_ptr<const TensorField> field, const Workspace& workspace, Sum sum)
      : field_(std::move(field)), workspace_(workspace), sum_(sum) {}
  [[nodiscard]] ScalarSample at(const Vec3& x) noexcept override;

 private:
  std::shared_ptr<const TensorField> field_;
  Workspace workspace_;
  Sum sum_;
  CellHint hint_;
};

/// What an isotropic place does to the hand.
enum class IsotropicPlaces : unsigned char { kFree, kPoint };

/// The constraint; its axes and thresholds are those of anisotropy_settings().
[[nodiscard]] std::unique_ptr<LinearConstraint> anisotropy_drag(
    const std::shared_ptr<const TensorField>& field, const Workspace& workspace, IsotropicPlaces isotropic);

/// Rules and thresholds for it. @param tau [m] over [0, 1].
/// @throws Error (usage) where tau falls below zero or, for kFree, is not 0 at 0.
[[nodiscard]] LinearSettings anisotropy_settings(const HapticTransferFunction& tau,
                                                 IsotropicPlaces isotropic);

}  // namespace palpate
