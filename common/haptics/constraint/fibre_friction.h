/// Friction along fibres that leave their layer (Ikits 2006, sec. 8.3, p_f): the proxy is dragged over the
/// layer after that of the groove, the harder the more the fibre points out of the layer:
///
///   tau_f = (1 - u) tau_min + u tau_max,   u = |n . f| sigma                                            (1)
///
/// with n the layer's unit normal and f the fibre. Eq. 8.1 as printed has tau_min and tau_max the other way
/// round, against its own text and figure 8.3, which say that dragging is hardest where the fibre is
/// perpendicular to the surface; and u is an absolute value, since fibres have no sign. sigma fades to 0
/// where the direction of the fibre or the layer is undefined, so that friction is least there.
///
///   r = x - p in the tangent plane at p;   |r| > tau_f:  p <- p + (1 - tau_f / |r|) r
///
/// repeated until p rests; p lies on the layer (layer_walk.h). Pulls along the layer alone.
#pragma once

#include <memory>

#include "common/haptics/constraint/fibre_groove.h"

namespace palpate {

class FibreFriction final : public Constraint {
 public:
  /// @pre `groove` stands before this in the chain, after `layer`; both outlive it.
  FibreFriction(std::shared_ptr<const LayeredHeart> heart, const LayerConstraint& layer,
                const FibreGroove& groove)
      : walk_(std::move(heart), layer), groove_(groove) {}

  void apply(const ChainSettings& settings) noexcept override { settings_ = settings.fibre; }
  void reset() noexcept override { walk_.reset(); }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

  /// (1) [m]. @rt Safe.
  [[nodiscard]] static double threshold(const FibreSample& at, const FibreSettings& settings) noexcept;
  /// tau_f where the proxy is [m].
  [[nodiscard]] double threshold() const noexcept { return threshold_; }

 private:
  LayerWalk walk_;
  const FibreGroove& groove_;
  FibreSettings settings_;
  double threshold_ = 0.0;
};

}  // namespace palpate
