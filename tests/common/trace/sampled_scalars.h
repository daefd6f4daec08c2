/// Scalar formulas on grids, for tests.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/field/analytic/analytic_field.h"
#include "common/field/scalar_field.h"
#include "tests/support/sampled.h"

namespace palpate::test {

/// Lets what samples vector formulas sample a scalar: as the first component.
class AsVectors final : public AnalyticField {
 public:
  explicit AsVectors(std::shared_ptr<const AnalyticScalar> scalar) : scalar_(std::move(scalar)) {}
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override { return {scalar_->value(x), 1.0, 0.0}; }
  [[nodiscard]] Mat3 jacobian(const Vec3&) const noexcept override { return Mat3{0.0}; }
  [[nodiscard]] Box bounds() const noexcept override { return scalar_->bounds(); }
  [[nodiscard]] std::string name() const override { return scalar_->name(); }
  [[nodiscard]] std::string description() const override { return scalar_->description(); }

 private:
  std::shared_ptr<const AnalyticScalar> scalar_;
};

inline std::shared_ptr<const ScalarField> first_component(const DataSet& block) {
  return make_scalar_field({block}, {kSampledName, Association::kPoint, 0}, "test");
}
inline std::shared_ptr<const ScalarField> on_uniform(const std::shared_ptr<const AnalyticScalar>& scalar,
                                                     const Index3& points) {
  return first_component(sample_uniform(AsVectors(scalar), points, SampledType::kFloat64));
}
inline std::shared_ptr<const ScalarField> on_rectilinear(const std::shared_ptr<const AnalyticScalar>& scalar,
                                                         const Index3& points) {
  return first_component(sample_rectilinear(AsVectors(scalar), points, 4.0, SampledType::kFloat64));
}
/// On a lattice of any axes about the middle of the formula's bounds; `axes` hold the steps.
inline std::shared_ptr<const ScalarField> on_lattice(const std::shared_ptr<const AnalyticScalar>& scalar,
                                                     const Index3& points, const Mat3& axes) {
  DataSet block;
  const Vec3 origin = scalar->bounds().center() - axes * (0.5 * Vec3(points - 1));
  block.topology = UniformTopology{points, origin, axes};
  std::vector<double> values;
  for (int k = 0; k < points.z; ++k) {
    for (int j = 0; j < points.y; ++j) {
      for (int i = 0; i < points.x; ++i) values.push_back(scalar->value(origin + axes * Vec3(i, j, k)));
    }
  }
  block.arrays.push_back(make_array("s", Association::kPoint, 1, std::span<const double>(values)));
  return make_scalar_field({block}, {"s"}, "test");
}
/// The steps of a lattice over a cube: turned, sheared by some 20 degrees, and left-handed.
inline Mat3 sheared_steps(double step) {
  return step * Mat3{Vec3{-0.8, 0.6, 0.0}, Vec3{0.35, 0.9, 0.2}, Vec3{-0.1, 0.3, 1.1}};
}
inline std::shared_ptr<const ScalarField> on_tets(const std::shared_ptr<const AnalyticScalar>& scalar,
                                                  const Index3& points, double jitter = 0.2) {
  return first_component(sample_tetrahedra(AsVectors(scalar), points, jitter, 1, SampledType::kFloat64));
}

}  // namespace palpate::test
