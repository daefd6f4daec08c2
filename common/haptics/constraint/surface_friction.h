/// Friction of a surface: sticking, sliding, grain. A secondary constraint, after the surface in the chain.
///
///   x probe of the surface, p its proxy, which is the probe of this; d = |x - p|, n the normal at p
///   q_k = what lies nearest to q_(k-1) in the plane through p across n, while it sticks
///
///   sticks    while |q - p| <= mu_s d + g
///   slides    q at the distance mu_d d from p, after it; until p comes nearer than nine tenths of that
///
/// Both springs have the same k, so that k |q - p| <= mu k d is Coulomb's law (the way of Salisbury et al. 1995, and
/// Hayward and Armstrong 2000, whose adhesion map this is; 6.11 of Ikits 2006 says why friction grows with
/// the force across). With a grain g > 0 a proxy that slides sticks again at once: it goes by steps of g as over
/// sandpaper, noise_texture.h's rule with a grain that is the same everywhere. What sticks holds by a spring and throws
/// away what that held as it slips: it only takes energy from the hand.
#pragma once

#include "common/haptics/constraint.h"
#include "common/haptics/constraint/touched_surface.h"

namespace palpate {

class SurfaceFriction final : public Constraint {
 public:
  /// @pre `surface` stands just before this in the chain and outlives it.
  explicit SurfaceFriction(const TouchedSurface& surface) : surface_(surface) {}

  void apply(const ChainSettings& settings) noexcept override { settings_ = settings.contact; }
  void reset() noexcept override { rubs_ = false; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

 private:
  const TouchedSurface& surface_;
  ContactSettings settings_;
  bool rubs_ = false;  ///< the proxy means something
  bool slides_ = false;
  Vec3 proxy_{0.0};  ///< q [m]
};

}  // namespace palpate
