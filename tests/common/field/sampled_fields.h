/// A linear field, and fields sampled on each kind of grid, for the tests of VectorField.
#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "common/field/analytic/examples.h"
#include "common/field/vector_field.h"
#include "tests/support/sampled.h"

namespace palpate::test {

/// The array that the sampled grids carry.
inline const VectorChoice kVelocity{
    VectorChoice::Kind::kArray, Association::kPoint, {"velocity"}, "velocity"};

/// Uniform in [0, 1).
[[nodiscard]] inline double unit(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-53;
}
[[nodiscard]] inline Vec3 random_in(const Box& box, std::mt19937_64& random) {
  return box.lower + box.size() * Vec3{unit(random), unit(random), unit(random)};
}

/// v = A x + b, with entries that are exact in binary.
class Linear final : public AnalyticField {
 public:
  static Mat3 matrix() { return {Vec3{0.5, -1.0, 2.0}, Vec3{0.25, 0.75, -0.5}, Vec3{-1.5, 1.0, 0.125}}; }
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override {
    return matrix() * x + Vec3{1.0, -0.5, 2.0};
  }
  [[nodiscard]] Mat3 jacobian(const Vec3&) const noexcept override { return matrix(); }
  [[nodiscard]] Box bounds() const noexcept override { return {{-1.0, 0.0, 1.0}, {1.0, 2.0, 2.0}}; }
  [[nodiscard]] std::string name() const override { return "linear"; }
  [[nodiscard]] std::string description() const override { return "linear"; }
};

[[nodiscard]] inline Vec3 linear(const Vec3& x) { return Linear().velocity(x); }

/// The field `formula` on each kind of grid, double values.
[[nodiscard]] inline std::vector<DataSet> on_all_grids(const AnalyticField& formula, int n) {
  const Index3 points{n, n + 1, n - 1};
  return {sample_uniform(formula, points, SampledType::kFloat64),
          sample_rectilinear(formula, points, 4.0, SampledType::kFloat64),
          sample_curvilinear(formula, points, 0.25, SampledType::kFloat64),
          sample_tetrahedra(formula, points, 0.2, 1, SampledType::kFloat64)};
}

/// The field of one block, which holds a velocity at its points.
[[nodiscard]] inline std::shared_ptr<const VectorField> field_of(const DataSet& block) {
  return make_vector_field({block}, kVelocity, "test");
}

}  // namespace palpate::test
