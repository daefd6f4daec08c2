#include "common/field/tensor/measures_at.h"

#include "common/math/symmetric3.h"

namespace palpate {

TensorMeasures measures_at(const TensorField& field, const Vec3& x, CellHint& hint) noexcept {
  const TensorSample sample = field.sample(x, hint);
  if (sample.status != SampleStatus::kOk) return {};
  const Vec3 eigenvalues = symmetric_eigenvalues(sample.value);
  return {anisotropy(eigenvalues), fractional_anisotropy(eigenvalues)};
}

}  // namespace palpate
