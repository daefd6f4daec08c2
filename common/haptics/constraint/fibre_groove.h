/// Fibres of a layer as grooves (Ikits 2006, sec. 8.2, p_c): the proxy runs freely along the fibre and stays
/// on it, until the probe is farther across than the spacing; then it snaps to the next groove, by whole
/// spacings (snap-drag, eq. 6.8 as corrected in motion_rule.h).
///
///   r = x - p in the tangent plane at p,   t the direction of the fibre in the layer,   c = n x t     (1)
///   p <- p + (r . t) t + snap(r . c; tau) c,   repeated until p rests
///
/// x is the proxy of the layer (layer.h), and p lies on that very layer (fibre_groove.h). Along the fibre each
/// step goes by the direction half way (the midpoint rule), so that the groove is left by the third order of
/// a tick's way only. The spacing fades to zero, and the proxy goes freely, where the direction of the fibre
/// is undefined or the fibre stands on the layer. Where fibres are not known at all the proxy is that of the
/// layer. Only what is across pulls: kappa is 0 along the fibre and across the layer.
#pragma once

#include <memory>

#include "common/haptics/constraint/layer.h"
#include "common/trace/layer_fibre.h"

namespace palpate {

// A proxy that goes about on the layer that another proxy is held by: what grooves and friction share.
//
// Every motion is a step in the tangent plane whose end is brought back to the isosurface by the search for
// its closest point (trace/isosurface.h), so the proxy lies on the layer after any number of steps, whatever
// the hand does. Frame L.

class LayerWalk {
 public:
  /// @param layer stands before this in the chain and outlives it.
  LayerWalk(std::shared_ptr<const LayeredHeart> heart, const LayerConstraint& layer);

  void reset() noexcept { caught_ = false; }
  /// Begins at `place` unless it is on that layer already. False where no layer holds the first proxy.
  [[nodiscard]] bool follow(const SurfacePoint& place, LinkUpdate& link) noexcept;
  /// Moves by `way`. False where the work is spent or the layer has no direction there.
  bool move(const Vec3& way, SearchWork& work) noexcept;
  /// Goes straight to a point of the same layer.
  void jump(const SurfacePoint& place) noexcept { point_ = place; }

  [[nodiscard]] const SurfacePoint& point() const noexcept { return point_; }
  [[nodiscard]] const LayeredHeart& heart() const noexcept { return *heart_; }
  [[nodiscard]] const IsosurfaceConstraint& surface() const noexcept { return layer_.surface(); }
  /// Fibre and normal where the proxy is. @rt Safe.
  [[nodiscard]] FibreSample sample() noexcept;
  /// Proxy and residual, the distance from the layer.
  void describe(LinkUpdate& link) const noexcept;

 private:
  std::shared_ptr<const LayeredHeart> heart_;
  const LayerConstraint& layer_;
  std::unique_ptr<const IsosurfaceSearch> search_;
  SurfacePoint point_;
  SurfaceFit fit_;
  CellHint hint_;
  bool caught_ = false;
};

/// How far fibre directions of that eigen gap count: undefined ones not at all, without a jump.
[[nodiscard]] double fibre_certainty(double gap) noexcept;

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

// Friction along fibres that leave their layer (Ikits 2006, sec. 8.3, p_f): the proxy is dragged over the
// layer after that of the groove, the harder the more the fibre points out of the layer:
//
//   tau_f = (1 - u) tau_min + u tau_max,   u = |n . f| sigma                                            (1)
//
// with n the layer's unit normal and f the fibre. Eq. 8.1 as printed has tau_min and tau_max the other way
// round, against its own text and figure 8.3, which say that dragging is hardest where the fibre is
// perpendicular to the surface; and u is an absolute value, since fibres have no sign. sigma fades to 0
// where the direction of the fibre or the layer is undefined, so that friction is least there.
//
//   r = x - p in the tangent plane at p;   |r| > tau_f:  p <- p + (1 - tau_f / |r|) r
//
// repeated until p rests; p lies on the layer (fibre_groove.h). Pulls along the layer alone.

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
