/// Waves of excitation in muscle: the small solver behind a built-in heart, and no simulator.
///
/// The potential u (0 at rest, 1 excited) and the recovery v of every point of a tetrahedral mesh follow
///
///   du/dt = div(D grad u) + (k u (1 - u)(u - a) - u v) / T,     n . D grad u = 0 on the border           (1)
///   dv/dt = (eps + mu_1 v / (mu_2 + u)) (-v - k u (u - a - 1)) / T                                       (2)
///   D = d_across I + (d_along - d_across) f f^T                                                          (3)
///
/// (Aliev and Panfilov, Chaos Solitons Fractals 7 (1996) 293) with the fibre f of each tetrahedron, whose
/// sign does not count. Where v = 0, (1) has a travelling front that is known: with d the diffusivity along
/// x,
///
///   u = 1 / (1 + exp((x - c t) / w)),   w = sqrt(2 d T / k),   c = sqrt(k d / (2 T)) (1 - 2 a)           (4)
///
/// so that fronts run sqrt(d_along / d_across) times as fast along fibres as across them.
///
/// Method: linear finite elements with a lumped mass matrix; in time the backward differentiation formula of
/// second order, implicit in the diffusion and extrapolating the rest (SBDF2: Ascher, Ruuth and Wetton, SIAM
/// J Numer Anal 32 (1995) 797), the first step by its formula of first order. Second order in both.
/// Everything runs in one fixed order on one thread: the same input gives the same bits.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "common/field/grid/tet_mesh.h"
#include "common/math/vec.h"

namespace palpate {

/// The constants of (1) to (3); lengths in the mesh's unit.
struct ExcitableTissue {
  double d_along = 2.4, d_across = 0.6;             ///< [mm^2/ms]
  double time_unit = 12.9;                          ///< T [ms]
  double rate = 8.0, threshold = 0.15;              ///< k, a
  double recovery = 0.002, mu_1 = 0.2, mu_2 = 0.3;  ///< eps, mu_1, mu_2
  bool recovers = true;                             ///< false: v stays 0, fronts are those of (4)
};

class ExcitationWave {
 public:
  /// At time 0, with v = 0.
  /// @param fibres one a tetrahedron, of any length; zero or NaN: as across fibres in every direction.
  /// @param u one a point. @param step [ms], above zero.
  /// @throws Error (work failed) where no matrix can be made of the mesh.
  ExcitationWave(std::span<const Vec3> points, std::span<const TetMesh::Tet> tets,
                 std::span<const Vec3> fibres, const ExcitableTissue& tissue, std::vector<double> u,
                 double step);
  ~ExcitationWave();
  ExcitationWave(ExcitationWave&&) noexcept;

  /// Goes on by a step. @throws Error (work failed) where the potentials are not found.
  void advance();

  [[nodiscard]] double time() const noexcept { return time_; }                     ///< [ms]
  [[nodiscard]] std::span<const double> potential() const noexcept { return u_; }  ///< u
  /// When u first rose past one half, between steps linearly [ms]; NaN where it has not.
  [[nodiscard]] std::span<const double> activation() const noexcept { return activation_; }

 private:
  struct Diffusion;
  std::unique_ptr<Diffusion> diffusion_;
  ExcitableTissue tissue_;
  double step_, time_ = 0.0;
  std::size_t steps_ = 0;
  std::vector<double> u_, v_, before_u_, before_v_;  ///< now and a step before
  std::vector<double> before_du_, before_dv_;        ///< what the reactions were
  std::vector<double> activation_;
};

}  // namespace palpate
