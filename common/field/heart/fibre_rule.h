/// Directions of fibres and sheets by a rule, for walls that have none, from solutions of Laplace's equation: Bayer et
/// al., Ann Biomed Eng 40 (2012) 2243, or Doste et al., Int J Numer Meth Biomed Eng 35 (2019) e3185.
///
///   psi      0 at the apex, 1 at the base (layer/wall_coordinates.h)
///   phi_e    1 on the epicardium, 0 on the endocardia (and the septum's sides)
///   phi_l    1 on the left endocardium, 0 on the others;   phi_r likewise
///   r = phi_r / (phi_l + phi_r),   d = phi_e
///
///   axis(u, v) = [e_c, e_l, e_t],   e_l = u / |u|,   e_t = v made orthogonal to e_l,   e_c = e_l x e_t       (1)
///   Q_l = axis(grad psi, -grad phi_l),  Q_r = axis(grad psi, grad phi_r),  Q_e = axis(grad psi, grad phi_e)  (2)
///   alpha_s = alpha_endo (1 - 2 r),     alpha_w = alpha_endo (1 - d) + alpha_epi d;  beta likewise            (3)
///   orient(Q, alpha, beta) = Q R_z(alpha) R_x(-beta)                                                          (4)
///
/// The fibre is the first column of (4), the sheet the third: "T" there, "sheet" in openCARP's files and in
/// fibre_angles.h, whose angles (bayer) these are.
///
///   kBayerPrinted  bislerp(bislerp(orient(Q_l, alpha_s), orient(Q_r, alpha_s), r), orient(Q_e, alpha_w), d), as the
///                  supplement's algorithm has it. In a free wall the helix angle is then alpha_endo + (alpha_epi -
///                  alpha_endo) d^2, and where both differ by more than 90 degrees the nearer of two axes is the wrong
///                  one for some d: the angle jumps within the wall.
///   kBayer         the same frames are mixed before they are turned, and turned once, by alpha_w in free walls and
///                  alpha_s in the septum: linear in d, as in the adaptation of S. Schuler (KIT-IBT/LDRB_Fibers, 2021).
///
///   kDoste         the fibre is turned out of the layer, too, by beta about e_l', the way along the layer across it; each
///                  ventricle has angles of its own, and two thirds of a septum are the left one's:
///
///   phi_t  -2 on the left endocardium, 0 on the epicardium, 1 on the right one, the septum's side with it
///   s = |phi_t| / 2 on the left of its zero, |phi_t| on the right;   b likewise from -1 to 1, but no epicardium given
///   w = (1 + b) / 2,   alpha = alpha_endo s + (alpha_epi_left (1 - w) + alpha_epi_right w) d,   beta likewise       (5)
///   e_t outwards from the cavity of b's sign, mixed with grad phi_e by d;   f = cos(beta) e_c' - sin(beta) e_t      (6)
///
///                  alpha_endo is that of b's side, too. In a free wall s = 1 - d, so that both angles are linear; in the
///                  middle of a septum they go to zero from both sides. These are the rule's angles as an open
///                  implementation restates them (SV-fibergen, "Cardiac Fiber Generation Documentation", Doste Method),
///                  turned once as by kBayer. The valves are not told apart: the base is one opening, and the angles of
///                  outflow tracts are left out.
///
/// Gradients are taken at the points, as the mean of their directions in the cells around, and a cell has the mean of
/// its points'. All frames share e_l, so that mixing unturned ones turns e_t about it, the shorter way round as an
/// axis has no sign.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/index.h"
#include "common/field/field_grid.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {

enum class FibreRule : std::uint8_t { kBayer, kBayerPrinted, kDoste };
inline constexpr int kFibreRuleCount = 3;
[[nodiscard]] constexpr std::string_view name_of(FibreRule rule) noexcept {
  constexpr std::array<std::string_view, kFibreRuleCount> kNames{"bayer", "bayer-printed", "doste"};
  return kNames[as_size(rule)];
}

/// [rad], each within a right angle.
struct RuleAngles {
  double endo = 0.0, epi = 0.0;  ///< alpha: of the fibre, from e_c towards the base
  double sheet_endo = 0.0,
         sheet_epi = 0.0;  ///< beta of (4), not of kDoste: of the sheet about the fibre, from e_t
  /// @name Of kDoste alone
  /// @{
  double right_endo = 0.0, right_epi = 0.0;  ///< alpha of the right ventricle; `endo`, `epi` are the left's
  double transverse_endo = 0.0, transverse_epi = 0.0;  ///< beta of (6), of both ventricles
  /// @}
};

/// Of the cells of grid.tets, in their order there.
struct RuleFibres {
  std::vector<Vec3> fibres;  ///< unit; zero where nothing is known
  std::vector<Vec3> sheets;  ///< unit, across the fibre
  std::size_t undefined =
      0;  ///< cells where (1) is not defined, as about the apex: they have the mean of their
          ///< neighbours' outer products
  std::size_t without = 0;  ///< cells of which no neighbour knows one either: zero
  double farthest = 0.0;    ///< of an undefined cell from the apex, data units
  /// By how much alpha of (3) or (5) differs between the points of a cell, half of the cells and 95 % of them by less [rad]:
  /// a cell has one fibre, so that coarse walls show the rule in steps of this size.
  double median_turn = 0.0, most_turn = 0.0;
};

/// @throws Error as find_wall_axis() and solve_laplace(). @pre grid.tets.
[[nodiscard]] RuleFibres make_rule_fibres(const FieldGrid& grid, const WallSurfaces& surfaces, FibreRule rule,
                                          const RuleAngles& angles, const std::string& file, int threads = 0);

}  // namespace palpate
