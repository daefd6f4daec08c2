/// Isosurfaces that are felt (Ikits 2006, sec. 6.6): walls that stop the probe from one side or either, and
/// layers that hold on to it; penetrable to a stated depth.
///
/// Free and held are two states. A free probe is its own proxy; its path is walked through every cell
/// (trace/isosurface.h), so that neither a fast hand nor a thin shell is a way through. Where it crosses an
/// isosurface of the set, that catches it, and the proxy is from then on the closest point of the surface,
/// followed locally.
///
///   wall   While the probe is beyond the surface, the proxy stays on it. Back on the side that the probe
///   came
///          from it is free again, without a jump: the stretch falls to zero there.
///   layer  Holds from both sides. What lies within the snap distance along the gradient is caught, too, and
///   a
///          probe that crosses a neighbouring isosurface of the set goes over to it (sec. 8.2).
///
/// Stretched by more than the depth, either lets go: the probe pops through and is free, or is caught by the
/// next isosurface on the way from the proxy to the probe.
///
/// Falls back, which keeps the proxy where it is on the surface: budget spent, gradient vanishing, data that
/// is not finite. At the border of the data it stays on the surface's rim. Free outside the data: `outside`.
#pragma once

#include <memory>

#include "common/haptics/constraint.h"
#include "common/haptics/constraint/touched_surface.h"
#include "common/haptics/workspace.h"
#include "common/trace/isosurface/isosurface.h"

namespace palpate {

class IsosurfaceConstraint final : public Constraint, public TouchedSurface {
 public:
  /// @param workspace over the frame of `field`.  @param otherwise isovalues where the settings have none.
  IsosurfaceConstraint(std::shared_ptr<const ScalarField> field, const Workspace& workspace,
                       const Isovalues& otherwise = {});

  void apply(const ChainSettings& settings) noexcept override;
  void reset() noexcept override;
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

  [[nodiscard]] SurfaceContact contact() const noexcept override { return contact_; }
  /// @name For constraints that follow in the chain, and for pictures
  /// @{
  [[nodiscard]] const ScalarField& field() const noexcept { return *field_; }
  [[nodiscard]] const Workspace& workspace() const noexcept { return workspace_; }
  /// Which isovalue of the settings holds the probe; -1: none.
  [[nodiscard]] int held_by() const noexcept { return held_ ? index_ : -1; }
  /// Where the proxy is on the surface that holds it, frame L and local values; no meaning while none does.
  [[nodiscard]] const SurfacePoint& point() const noexcept { return point_; }
  /// The gradient of the scalar at the proxy, frame L and local values; zero while nothing holds it.
  [[nodiscard]] const Vec3& gradient() const noexcept { return fit_.gradient; }
  /// @}

 private:
  [[nodiscard]] bool roam(const Vec3& x, SearchWork& work, LinkUpdate& link) noexcept;
  [[nodiscard]] bool snap(const Vec3& x, SearchWork& work, LinkUpdate& link) noexcept;
  [[nodiscard]] bool follow(const Vec3& x, SearchWork& work, LinkUpdate& link) noexcept;
  void change_layers(const Vec3& x, SearchWork& work, LinkUpdate& link) noexcept;
  void move_to_edited(SearchWork& work, LinkUpdate& link) noexcept;
  void let_go(std::int8_t side) noexcept;
  void hold(int index, std::int8_t free_side, const SurfacePath& crossing) noexcept;
  void describe(const Vec3& x, LinkUpdate& link) const noexcept;
  [[nodiscard]] bool stops(std::int8_t from) const noexcept;

  std::shared_ptr<const ScalarField> field_;
  std::unique_ptr<const IsosurfaceSearch> search_;
  Workspace workspace_;
  Isovalues otherwise_;
  SurfaceLevels levels_;
  IsosurfaceHold hold_ = IsosurfaceHold::kWall;
  double depth_ = 0.0, snap_ = 0.0;  ///< frame L
  SurfacePath path_;                 ///< of the probe, as far as it has been walked
  bool begun_ = false;               ///< whether `path_` means anything
  bool held_ = false;
  bool edited_ = false;        ///< the isovalue that holds the probe has been changed
  int index_ = 0;              ///< of the isovalue that holds the probe
  std::int8_t free_side_ = 0;  ///< of a wall
  SurfacePoint point_;
  SurfaceFit fit_;
  SurfaceContact contact_;
};

}  // namespace palpate
