/// Anisotropy drag (Ikits 2006, sec. 8.4): a linear constraint in the eigenframe of a diffusion tensor whose
/// drag thresholds follow the anisotropy. Either of two constructions, with tau(x) rising from tau(0) = 0:
///
///                                                  tau_1                  tau_2           tau_3
///   free in isotropic places (eqs. 8.6 to 8.8)     0                      tau(c_l)        tau(c_l + c_p)
///   held to a point there (eqs. 8.9 to 8.11)       tau(1 - c_l - c_p)     tau(1 - c_p)    tau(1)
///
/// so a line along e_1 where diffusion is linear, a plane where it is planar. Where eigenvalues are equal
/// their axes may be turned freely; with both constructions these axes then have the same threshold, and as
/// drag acts jointly along them (motion_rule.h) the hold does not depend on how they are turned. With the
/// axis-by-axis rule of the reference it would, by up to 41 %. A threshold that falls by more than the proxy
/// moves (with the second construction, at the border of a bundle that is sharper than tau(1) is long) lets
/// the proxy catch up at once: no rule without a speed could do else, and the slew limit smooths the force.
#pragma once

#include <memory>

#include "common/field/tensor/tensor_field.h"
#include "common/haptics/constraint/linear.h"
#include "common/haptics/tensor_frame.h"
#include "common/haptics/workspace.h"

namespace palpate {

/// What an isotropic place does to the hand.
enum class IsotropicPlaces : unsigned char { kFree, kPoint };

class AnisotropyDrag final : public Constraint {
 public:
  AnisotropyDrag(std::shared_ptr<const TensorField> field, const Workspace& workspace,
                 IsotropicPlaces isotropic);

  /// Takes the drag thresholds from `settings.anisotropy`, and the fade distance of linear constraints.
  void apply(const ChainSettings& settings) noexcept override;
  void reset() noexcept override { linear_.reset(); }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    linear_.update(probe, budget, link);
  }

 private:
  AnisotropyDrag(const std::shared_ptr<TensorReader>& tensors, IsotropicPlaces isotropic);

  IsotropicPlaces isotropic_;
  LinearConstraint linear_;
};

}  // namespace palpate
