/// Angles of fibres and sheets in a heart's wall, under conventions that have names.
///
/// All of them measure against a circumferential, a longitudinal and a transmural direction e_c, e_l, e_t,
/// made of the long axis a (apex to base) and the wall's normal t = grad s, e_c = e_l x e_t running
/// counter-clockwise as seen from the base. They differ in which of the two is kept as it is, and in what is
/// turned about what:
///
///   convention  e_t, e_l                             helix            transverse         sheet
///   streeter    t, a made orthogonal to t            f on (e_c, e_l)  f on (e_c, e_t)    n_s on (e_t, e_l)
///   piersanti   t, a made orthogonal to t            alpha            -                  beta about f
///   bayer       t made orthogonal to a, a            alpha            -                  beta about f
///   doste       t made orthogonal to a, a            alpha            beta about e_l'    -
///
/// "f on (e_c, e_l)" is the angle, from the first, of the projection on that plane (Streeter et al., Circ Res
/// 24 (1969) 339). The others build the fibre by rotations:
///
///   e_c' = cos(alpha) e_c + sin(alpha) e_l,   e_l' = -sin(alpha) e_c + cos(alpha) e_l                  (1)
///   sheet, about f = e_c'         n_s = cos(beta) e_t + sin(beta) e_l'                                 (2)
///   transverse, about e_l'        f = cos(beta) e_c' - sin(beta) e_t                                   (3)
///
/// (2) is the matrix printed by Bayer et al., Ann Biomed Eng 40 (2012) 2243, which Piersanti et al., Comput
/// Methods Appl Mech Eng 374 (2021) 113559 take over; (3) is the right-handed rotation of Doste et al., Int J
/// Numer Meth Biomed Eng 35 (2019) e3185, as an open implementation restates it: e_t made orthogonal to e_l,
/// e_c = e_l x e_t, alpha about e_t, then beta about e_l' (SV-fibergen, "Cardiac Fiber Generation
/// Documentation", sections 3.2 and 5.1, whose first column of Q R_alpha R_beta is (3)). Those methods take
/// the apicobasal direction from Laplace's equation between apex and base; here it is the straight long axis
/// for all.
///
/// Directions have no sign: f is taken with f . e_c >= 0 and n_s with n_s . e_t >= 0, so that all angles lie
/// in [-90, 90] degrees. A helix angle above zero is a right-handed screw.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/index.h"
#include "common/field/heart/heart.h"
#include "common/field/heart/wall_frame.h"

namespace palpate {

enum class AngleConvention : std::uint8_t { kStreeter, kBayer, kPiersanti, kDoste };
inline constexpr int kAngleConventionCount = 4;
[[nodiscard]] constexpr std::string_view name_of(AngleConvention convention) noexcept {  ///< "streeter"
  constexpr std::array<std::string_view, kAngleConventionCount> kNames{"streeter", "bayer", "piersanti",
                                                                       "doste"};
  return kNames[as_size(convention)];
}

enum class WallAngle : std::uint8_t { kHelix, kTransverse, kSheet };
inline constexpr int kWallAngleCount = 3;
[[nodiscard]] constexpr std::string_view name_of(WallAngle angle) noexcept {  ///< "helix"
  constexpr std::array<std::string_view, kWallAngleCount> kNames{"helix", "transverse", "sheet"};
  return kNames[as_size(angle)];
}

/// Whether the convention knows the angle: see the table above.
[[nodiscard]] bool defines(AngleConvention convention, WallAngle angle) noexcept;

/// What angles are measured from, data axes; lengths and the signs of fibre and sheet have no meaning.
struct WallDirections {
  Vec3 axis{0.0};        ///< a
  Vec3 transmural{0.0};  ///< t
  Vec3 fibre{0.0};       ///< f
  Vec3 sheet{0.0};       ///< n_s; only sheet angles ask for it
};

/// The angle [rad]; nothing where the convention does not define it or a direction is zero or along the
/// other (at the apex; a fibre along e_t has no helix angle).
[[nodiscard]] std::optional<double> wall_angle(WallAngle angle, AngleConvention convention,
                                               const WallDirections& at) noexcept;

/// Below this eigen gap directions count as undefined: their outer products nearly cancel.
inline constexpr double kLeastGap = 0.05;

/// The angle [degrees] at every point of the heart's mesh; NaN where it is not defined, and where directions
/// disagree so that their gap is below kLeastGap.
/// @pre angle != kSheet or heart.sheets; the convention defines it. @param axis as WallDirections.
[[nodiscard]] std::vector<double> map_angle(const Heart& heart, const SmoothNormals& normals,
                                            const Vec3& axis, WallAngle angle, AngleConvention convention);

/// The eigen gap of the fibres' tensor at every point, in [0, 1]: 1 where all agree, 0 where the direction is
/// undefined; NaN where there is none.
[[nodiscard]] std::vector<double> map_gap(const Heart& heart);

}  // namespace palpate
