/// A proxy that goes about on the layer that another proxy is held by: what grooves and friction share.
///
/// Every motion is a step in the tangent plane whose end is brought back to the isosurface by the search for
/// its closest point (trace/isosurface.h), so the proxy lies on the layer after any number of steps, whatever
/// the hand does. Frame L.
#pragma once

#include <memory>

#include "common/haptics/constraint/layer.h"
#include "common/trace/layer_fibre.h"

namespace palpate {

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

}  // namespace palpate
