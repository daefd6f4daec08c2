/// Complete vector polynomials of three variables.
///
///   f(p) = sum_j c_j x^{s_j} y^{t_j} z^{u_j},   0 <= s_j + t_j + u_j <= r (1) R = (r+1)(r+2)(r+3) / 6 terms
///   (2)
/// Ikits 2006, eqs. 4.7 and 4.8. The variables are (p - center) / scale, so that powers stay near 1 and the
/// fit is as well conditioned as the measurements allow; the printed form takes p itself.
#pragma once

#include <span>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

inline constexpr int kMaxDegree = 8;  ///< 165 terms; real data carries no more
inline constexpr int kMaxTerms = (kMaxDegree + 1) * (kMaxDegree + 2) * (kMaxDegree + 3) / 6;

/// (2). @pre degree >= 0.
[[nodiscard]] constexpr int term_count(int degree) noexcept {
  return (degree + 1) * (degree + 2) * (degree + 3) / 6;
}

/// The monomials of (1) at `u`, x's power slowest. @pre values.size() == term_count(degree), degree in
/// [0, kMaxDegree]. @rt Safe.
void monomials(const Vec3& u, int degree, std::span<double> values) noexcept;

struct VectorPolynomial {
  int degree = -1;  ///< -1: zero everywhere
  Vec3 center{0.0};
  double scale = 1.0;
  std::vector<Vec3> coefficients;  ///< term_count(degree) of them, in the order of monomials()

  /// @rt Safe.
  [[nodiscard]] Vec3 at(const Vec3& p) const noexcept;
};

}  // namespace palpate
