#include "common/field/tensor/tensor_function.h"

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
  return with_values(symmetric_eigen(tensor), [&](double value) { return std::log(std::max(value, floor)); });
}

Mat3 symmetric_exp(const Mat3& tensor) noexcept {
  return with_values(symmetric_eigen(tensor), [](double value) { return std::exp(value); });
}

Mat3 without_negative(const Mat3& tensor) noexcept {
  return with_values(symmetric_eigen(tensor), [](double value) { return std::max(value, 0.0); });
}

}  // namespace palpate
