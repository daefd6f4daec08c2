/// A surface of triangles that is touched from either side: the proxy stays where the probe would have had to pass
/// through.
///
/// Free and held are two states. The way of a free probe is met with the triangles (a tree of boxes: neither a fast
/// hand nor a thin sheet is a way through). From then on the proxy is the place of the surface that is nearest to the
/// probe of all next to it (geometry/surface_mesh.h: walk), over as many triangles as lie between, as long as
///
///   (x - p) . n  is on the other side than the probe came from,                                        (1)
///
/// n the normal of the place, of a face, an edge or a corner. So the proxy lags behind by no more than the distance to
/// the nearest place that it can be pushed to, on the sheet that it met: the other sheet of a thin plate, though
/// nearer, does not take it. Where (1) ends the probe is free without a jump; what lies between is met
/// again, so that it goes from wall to wall in a corner. At a rim the proxy slips around it.
///
///   face    J = 1 - n n^T        edge    J = t t^T        corner    J = 0
///
/// Falls back where the budget is spent: the proxy is on the surface, and goes on in the next update. Two surfaces
/// that cross without a common edge hold one at a time: on the one, the other is not met.
#pragma once

#include <cstdint>
#include <memory>

#include "common/geometry/surface_mesh.h"
#include "common/haptics/constraint.h"
#include "common/haptics/constraint/touched_surface.h"
#include "common/haptics/workspace.h"

namespace palpate {

class MeshConstraint final : public Constraint, public TouchedSurface {
 public:
  /// @param mesh data coordinates, not null.  @param workspace over these.
  MeshConstraint(std::shared_ptr<const SurfaceMesh> mesh, const Workspace& workspace);

  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override;
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;
  [[nodiscard]] SurfaceContact contact() const noexcept override { return contact_; }

 private:
  /// What an update may still do.
  struct Work {
    int triangles;   ///< that may be walked over
    int looked = 0;  ///< of them
    int visits;      ///< of the tree
  };
  /// Whether the way from `from_` to `x` meets the surface, which holds the probe then.
  [[nodiscard]] bool meet(const Vec3& x, Work& work, LinkUpdate& link) noexcept;
  enum class Hold : std::uint8_t {
    kHeld,
    kRests,   ///< free, and as near as the gap
    kLeft,    ///< free
    kSlipped  ///< free, around a rim
  };
  /// Moves the proxy after `x`.
  [[nodiscard]] Hold follow(const Vec3& x, Work& work, LinkUpdate& link) noexcept;
  void describe(const Vec3& x, LinkUpdate& link) noexcept;

  std::shared_ptr<const SurfaceMesh> mesh_;
  Workspace workspace_;
  double gap_;  ///< by which a free probe begins its way off the surface that it left [data units]
  SurfaceContact contact_;
  SurfacePlace place_;
  Vec3 from_{0.0};      ///< where the way of a free probe has come to [data units]
  double side_ = 1.0;   ///< of the free side, against the normals
  bool begun_ = false;  ///< from_ means something
  bool held_ = false;
};

}  // namespace palpate
