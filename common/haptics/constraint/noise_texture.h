/// Noise of the data as the grain of what is felt (Ikits 2006, ch. 9: noise as a secondary effect, such as
/// surface texture). A secondary constraint, after the one that holds the probe.
///
/// Its proxy sticks where it is and slips to its probe as soon as that is farther away than the grain tau,
/// which a haptic transfer function takes from the noise there:
///
///   p_k = p_(k-1) while |x_k - p_(k-1)| <= tau(noise(x_k)),   else x_k                            (1)
///
/// A clean region is smooth, a noisy one rough, the coarser and the harder to rub along the noisier. Each
/// place of the proxy is one where its probe has been: after a surface, on that surface. It sticks by a
/// spring and throws away what that held as it slips, so that it only takes energy from the hand.
#pragma once

#include <memory>

#include "common/field/scalar_field.h"
#include "common/haptics/constraint.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/workspace.h"

namespace palpate {

class NoiseTexture final : public Constraint {
 public:
  /// @param noise of make_noise_field().  @param workspace of the data.
  /// @param surface has a texture while it holds the probe; null: everything has.
  /// @pre `surface` stands before this in the chain and outlives it.
  NoiseTexture(std::shared_ptr<const ScalarField> noise, const Workspace& workspace,
               const IsosurfaceConstraint* surface = nullptr);

  void apply(const ChainSettings& settings) noexcept override { grain_ = settings.texture.grain; }
  void reset() noexcept override { sticks_ = false; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

 private:
  [[nodiscard]] double grain_at(const Vec3& probe) noexcept;

  std::shared_ptr<const ScalarField> noise_;
  Workspace workspace_;
  const IsosurfaceConstraint* surface_;
  HapticTransferFunction grain_;
  CellHint hint_;
  bool sticks_ = false;
  Vec3 proxy_{0.0};  ///< [m] while it sticks
};

}  // namespace palpate
