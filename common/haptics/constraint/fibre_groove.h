/// Fibres of a layer as grooves (Ikits 2006, sec. 8.2, p_c): the proxy runs freely along the fibre and stays
/// on it, until the probe is farther across than the spacing; then it snaps to the next groove, by whole
/// spacings (snap-drag, eq. 6.8 as corrected in motion_rule.h).
///
///   r = x - p in the tangent plane at p,   t the direction of the fibre in the layer,   c = n x t     (1)
///   p <- p + (r . t) t + snap(r . c; tau) c,   repeated until p rests
///
/// x is the proxy of the layer (layer.h), and p lies on that very layer (layer_walk.h). Along the fibre each
/// step goes by the direction half way (the midpoint rule), so that the groove is left by the third order of
/// a tick's way only. The spacing fades to zero, and the proxy goes freely, where the direction of the fibre
/// is undefined or the fibre stands on the layer. Where fibres are not known at all the proxy is that of the
/// layer. Only what is across pulls: kappa is 0 along the fibre and across the layer.
#pragma once

#include <memory>

#include "common/haptics/constraint/layer_walk.h"

namespace palpate {

class FibreGroove final : public Constraint {
 public:
  /// @pre `layer` stands before this in the chain and outlives it.
  FibreGroove(std::shared_ptr<const LayeredHeart> heart, const LayerConstraint& layer)
      : walk_(std::move(heart), layer) {}

  void apply(const ChainSettings& settings) noexcept override { spacing_ = settings.fibre.spacing; }
  void reset() noexcept override { walk_.reset(); }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

  /// Where the proxy is, for constraints that follow; on the layer while that holds its own proxy.
  [[nodiscard]] const LayerWalk& walk() const noexcept { return walk_; }

 private:
  LayerWalk walk_;
  double spacing_ = 0.0;  ///< [m]
};

}  // namespace palpate
