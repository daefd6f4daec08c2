#include "common/field/derived.h"

#include "common/math/symmetric3.h"

namespace palpate {

double divergence(const Mat3& m) noexcept { return m[0][0] + m[1][1] + m[2][2]; }

Vec3 vorticity(const Mat3& m) noexcept { return {m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]}; }

double q_criterion(const Mat3& m) noexcept {
  // |W|^2 - |S|^2 = -tr J^2.
  return -0.5 * (m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2]) - m[0][1] * m[1][0] -
         m[0][2] * m[2][0] - m[1][2] * m[2][1];
}

double lambda2(const Mat3& m) noexcept {
  const Mat3 square = m * m;
  return symmetric_eigenvalues(0.5 * (square + glm::transpose(square))).y;
}

ScalarSample sample_measure(const VectorField& field, Measure measure, const Vec3& x_data,
                            CellHint& hint) noexcept {
  if (measure == Measure::kSpeed) {
    const VectorSample sample = field.sample(x_data, hint);
    return {sample.status == SampleStatus::kOk ? glm::length(sample.value) : 0.0, sample.status};
  }
  Mat3 m;
  const SampleStatus status = field.jacobian(x_data, hint, m);
  if (status != SampleStatus::kOk) return {0.0, status};
  switch (measure) {
    case Measure::kDivergence:
      return {divergence(m), status};
    case Measure::kVorticityMagnitude:
      return {glm::length(vorticity(m)), status};
    case Measure::kQ:
      return {q_criterion(m), status};
    case Measure::kLambda2:
      return {lambda2(m), status};
    case Measure::kSpeed:
      break;
  }
  return {0.0, SampleStatus::kBadData};
}

}  // namespace palpate
