/// Measures of a diffusion tensor, as functions of its eigenvalues, which are given falling.
///
/// Fitted tensors often have eigenvalues a little below zero, where the measures would leave their ranges:
/// these are taken as zero, and has_negative() says that it was so. All but the mean diffusivity have no unit
/// and are the same for D and a D, a > 0; where nothing diffuses (all eigenvalues zero) a tensor counts as
/// isotropic. NaN in gives NaN out. @rt Safe, all of them.
#pragma once

#include <cstdint>
#include <string_view>

#include "common/math/vec.h"

namespace palpate {

/// Barycentric measures (Ikits 2006, eqs. 8.3 to 8.5): each in [0, 1], and their sum is 1.
struct Anisotropy {
  double linear = 0.0;     ///< c_l = (lambda_1 - lambda_2) / (lambda_1 + lambda_2 + lambda_3)
  double planar = 0.0;     ///< c_p = 2 (lambda_2 - lambda_3) / (lambda_1 + lambda_2 + lambda_3)
  double spherical = 1.0;  ///< c_s = 3 lambda_3 / (lambda_1 + lambda_2 + lambda_3)
};
[[nodiscard]] Anisotropy anisotropy(const Vec3& eigenvalues) noexcept;

/// What linear, planar and spherical parts are given in.
enum class WestinScale : std::uint8_t {
  kTrace,   ///< as above (Westin et al. 1997)
  kLargest  ///< lambda_1: c_l = (lambda_1 - lambda_2) / lambda_1, c_p = (lambda_2 - lambda_3) / lambda_1,
            ///< c_s = lambda_3 / lambda_1 (Westin et al. 2002); their sum is 1, too
};
/// "trace", "largest".
[[nodiscard]] std::string_view name_of(WestinScale scale) noexcept;
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] WestinScale westin_from_name(std::string_view name);
[[nodiscard]] Anisotropy anisotropy(const Vec3& eigenvalues, WestinScale scale) noexcept;

/// FA (Basser and Pierpaoli 1996), in [0, 1].
[[nodiscard]] double fractional_anisotropy(const Vec3& eigenvalues) noexcept;

/// MD = (lambda_1 + lambda_2 + lambda_3) / 3, in the unit of the tensor.
[[nodiscard]] double mean_diffusivity(const Vec3& eigenvalues) noexcept;

/// Mode of anisotropy (Ennis and Kindlmann 2006, eq. 13): 3 sqrt(6) det(A / |A|) with A the deviator of D; -1
/// where it is planar, 1 where it is linear, and 0, though undefined, where it is isotropic.
[[nodiscard]] double mode_of_anisotropy(const Vec3& eigenvalues) noexcept;

/// Whether an eigenvalue lies below zero.
[[nodiscard]] constexpr bool has_negative(const Vec3& eigenvalues) noexcept { return eigenvalues.z < 0.0; }

}  // namespace palpate
