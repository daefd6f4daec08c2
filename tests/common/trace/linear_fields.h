/// Linear vector fields v = A (x - c) on random tetrahedral meshes, and their exact lines.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/field/analytic/analytic_field.h"
#include "common/field/vector_field.h"
#include "tests/support/sampled.h"

namespace palpate::test {

class LinearField final : public AnalyticField {
 public:
  LinearField(const Mat3& a, const Vec3& c) : a_(a), c_(c) {}
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override { return a_ * (x - c_); }
  [[nodiscard]] Mat3 jacobian(const Vec3&) const noexcept override { return a_; }
  [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-1.0}, Vec3{1.0}}; }
  [[nodiscard]] std::string name() const override { return "linear"; }
  [[nodiscard]] std::string description() const override { return "linear"; }

 private:
  Mat3 a_;
  Vec3 c_;
};

/// Rows of A.
[[nodiscard]] inline Mat3 rows(double a, double b, double c, double d, double e, double f, double g, double h,
                               double i) {
  return Mat3{a, d, g, b, e, h, c, f, i};
}

/// The field sampled in doubles at the points of a tetrahedral mesh of [-1, 1]^3. The points lie on a dyadic
/// lattice (jittered by whole multiples of 2^-12), so that small whole matrices give exact values: the
/// interpolant is then the linear field itself. `flatten` squeezes the inner points of the mesh along z, down
/// to slivers of aspect 1 : 1 / flatten.
[[nodiscard]] std::shared_ptr<const VectorField> on_tetrahedra(const Mat3& a, const Vec3& c, int points,
                                                               double jitter, std::uint64_t seed,
                                                               double flatten = 1.0, int length_exponent = 0,
                                                               int speed_exponent = 0);

/// exp(t A) (x - c) + c, by the matrix exponential of Eigen in long double.
[[nodiscard]] Vec3 exact_line(const Mat3& a, const Vec3& c, const Vec3& seed, double t);

/// Uniform seeds in [-size, size]^3, fixed by `seed`.
[[nodiscard]] std::vector<Vec3> random_seeds(int count, double size, unsigned seed);

}  // namespace palpate::test
