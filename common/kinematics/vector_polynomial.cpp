#include "common/kinematics/vector_polynomial.h"

#include <array>

#include "common/base/index.h"

namespace palpate {

void monomials(const Vec3& u, int degree, std::span<double> values) noexcept {
  std::size_t term = 0;
  double x = 1.0;
  for (int s = 0; s <= degree; ++s, x *= u.x) {
    double xy = x;
    for (int t = 0; t <= degree - s; ++t, xy *= u.y) {
      double xyz = xy;
      for (int w = 0; w <= degree - s - t; ++w, xyz *= u.z) values[term++] = xyz;
    }
  }
}

Vec3 VectorPolynomial::at(const Vec3& p) const noexcept {
  if (degree < 0) return Vec3{0.0};
  std::array<double, kMaxTerms> values{};
  const auto terms = as_size(term_count(degree));
  monomials((p - center) / scale, degree, std::span(values).first(terms));
  Vec3 sum{0.0};
  for (std::size_t j = 0; j < terms; ++j) sum += values[j] * coefficients[j];
  return sum;
}

}  // namespace palpate
