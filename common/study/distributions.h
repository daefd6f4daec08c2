/// Distributions that tests of hypotheses need, from Boost.Math.
#pragma once

namespace palpate {

[[nodiscard]] double normal_below(double z) noexcept;           ///< P(Z <= z)
[[nodiscard]] double normal_quantile(double share);             ///< @pre 0 < share < 1
[[nodiscard]] double t_above(double t, double freedom);         ///< P(|T| >= |t|), two-sided
[[nodiscard]] double t_quantile(double share, double freedom);  ///< @pre 0 < share < 1
/// P(T' > t) of the noncentral t distribution with the noncentrality `shift`.
[[nodiscard]] double noncentral_t_above(double t, double freedom, double shift);

}  // namespace palpate
