#include "common/field/tensor/tensor_mean.h"

#include <algorithm>
#include <cmath>

#include "common/math/symmetric3.h"

namespace palpate {
namespace {

template <typename Function>
Mat3 with_values(const SymmetricEigen& eigen, const Function& function) noexcept {
  Mat3 result{0.0};
  for (int i = 0; i < 3; ++i) {
    result += function(eigen.values[i]) * glm::outerProduct(eigen.vectors[i], eigen.vectors[i]);
  }
  return result;
}

}  // namespace

Mat3 symmetric_log(const Mat3& tensor, double floor) noexcept {
  const SymmetricEigen eigen = symmetric_eigen(tensor);
  const double least = floor * eigen.values[0];
  return with_values(eigen, [&](double value) { return std::log(std::max(value, least)); });
}

Mat3 symmetric_exp(const Mat3& tensor) noexcept {
  return with_values(symmetric_eigen(tensor), [](double value) { return std::exp(value); });
}

Mat3 tensor_mean(std::span<const Mat3> tensors, std::span<const double> weights,
                 TensorInterpolation how) noexcept {
  bool has_logs = how == TensorInterpolation::kLogEuclidean;
  Mat3 mean{0.0};
  for (std::size_t i = 0; i < tensors.size(); ++i) {
    mean += weights[i] * tensors[i];
    has_logs = has_logs && (weights[i] == 0.0 || symmetric_eigenvalues(tensors[i])[0] > 0.0);
  }
  if (!has_logs) return mean;
  Mat3 log_mean{0.0};
  for (std::size_t i = 0; i < tensors.size(); ++i) {
    if (weights[i] != 0.0) log_mean += weights[i] * symmetric_log(tensors[i]);
  }
  return symmetric_exp(log_mean);
}

}  // namespace palpate
