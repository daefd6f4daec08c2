/// What errors of head tracking do to the world that is seen on a screen (Ikits 2006, sec. 4.5).
///
/// In the plane through both eyes: x runs along the projection line, z is the distance from it [m]; Vec2 is
/// (x, z). The eyes are at A and D; the renderer believes them at B and C. It draws the point E where the
/// rays B-E and C-E meet the line, at G and H:
///   G_x = (E_x - B_x) B_z / (B_z - E_z) + B_x,   H_x = (E_x - C_x) C_z / (C_z - E_z) + C_x               (1)
/// The user sees it at F, where A-G and D-H cross:
///   F_x = (A_z D_x G_x - A_x D_z H_x + (D_z - A_z) G_x H_x) / n
///   F_z = A_z D_z (G_x - H_x) / n,     n = A_z D_x - A_x D_z + D_z G_x - A_z H_x (2)
/// (eqs. 4.16-4.19).
#pragma once

#include <optional>

#include "common/math/vec.h"

namespace palpate {

struct EyePair {
  Vec2 left{0.0};   ///< A, or B as modelled
  Vec2 right{0.0};  ///< D, or C as modelled
};

/// (2): where `point` appears. Nothing where a ray runs along the screen or the two seen rays are parallel,
/// within rounding.
[[nodiscard]] std::optional<Vec2> perceived_point(const EyePair& actual, const EyePair& modelled,
                                                  const Vec2& point) noexcept;

/// Both eyes displaced by `error` (eqs. 4.20 and 4.21).
[[nodiscard]] EyePair displaced(const EyePair& actual, const Vec2& error) noexcept;
/// B_z = A_z - e, C_z = D_z + e (eqs. 4.26-4.29): to first order a turn of the head by 2 e / separation.
[[nodiscard]] EyePair turned(const EyePair& actual, double e) noexcept;

/// |F - E| = |E_z| |error| / |A_z + error_z| (eq. 4.22): exact for eyes at one distance A_z.
[[nodiscard]] double position_error_effect(double eye_z, const Vec2& point, const Vec2& error) noexcept;

/// The bound lambda / kappa on |F - E| / |error| (eqs. 4.23-4.25) for |E_z| <= lambda |A_z| and
/// |A_z| - |error_z| >= kappa |A_z|. (Eq. 4.24 is printed the wrong way round; 4.25 follows from this one.)
[[nodiscard]] constexpr double position_error_bound(double lambda, double kappa) noexcept {
  return lambda / kappa;
}

/// |F_x - E_x| and |F_z - E_z| for eyes displaced as turned() does, with A_z = D_z, I the midpoint of the
/// eyes:
///   N = A_z (A_z-E_z)(A_x-D_x) + 2 (I_x-E_x) E_z e - (A_x-D_x) e^2
///   |F_x-E_x| = 2 |E_z (A_x-E_x)(D_x-E_x) e| / |N|
///   |F_z-E_z| = |E_z e| |2 (A_z-E_z)(I_x-E_x) + (A_x-D_x) e| / |N| (3)
/// Exact. The printed eqs. 4.30 and 4.31 have these two exchanged, and neither has the dimension of a length.
/// @pre actual.left.y == actual.right.y.
[[nodiscard]] Vec2 orientation_error_effect(const EyePair& actual, const Vec2& point, double e) noexcept;

}  // namespace palpate
