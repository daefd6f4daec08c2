/// A layer of a heart's wall: the isosurface constraint (isosurface.h) that always holds from both sides and
/// goes over to a neighbouring layer where the probe crosses that (Ikits 2006, sec. 8.2, p_s).
#pragma once

#include <algorithm>
#include <memory>

#include "common/base/index.h"
#include "common/haptics/constraint/isosurface.h"

namespace palpate {

class LayerConstraint final : public Constraint {
 public:
  /// @param layers those that are felt where the settings name none.
  LayerConstraint(std::shared_ptr<const ScalarField> depth, const Workspace& workspace,
                  const Isovalues& layers)
      : surface_(std::move(depth), workspace, layers) {}

  /// A layer catches what comes as near as this, whatever the snap distance [m]: a hand that is put on it by
  /// sight is there to rounding, and on whichever side.
  static constexpr double kTouch = 5e-5;

  /// Takes isovalues, depth and snap distance from `settings.isosurface`, and not how it holds.
  void apply(const ChainSettings& settings) noexcept override {
    ChainSettings as_layer = settings;
    IsosurfaceSettings& surface = as_layer.isosurface;
    surface.hold = IsosurfaceHold::kLayer;
    surface.snap_distance = std::min(std::max(surface.snap_distance, kTouch), surface.depth);
    surface_.apply(as_layer);
  }
  void reset() noexcept override { surface_.reset(); }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override {
    surface_.update(probe, budget, link);
  }

  /// For constraints that follow in the chain.
  [[nodiscard]] const IsosurfaceConstraint& surface() const noexcept { return surface_; }

 private:
  IsosurfaceConstraint surface_;
};

/// Layers that are felt where none are named: evenly spaced through the wall, its surfaces left out.
[[nodiscard]] inline Isovalues default_layers(const ScalarField& depth) noexcept {
  constexpr int kLayers = 7;
  Isovalues layers;
  layers.count = kLayers;
  for (int i = 0; i < kLayers; ++i) {
    const double part = (i + 1.0) / (kLayers + 1);
    layers.value[as_size(i)] = (1.0 - part) * depth.lowest() + part * depth.highest();
  }
  return layers;
}

}  // namespace palpate
