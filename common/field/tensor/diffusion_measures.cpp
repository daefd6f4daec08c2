#include "common/field/tensor/diffusion_measures.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/base/error.h"

namespace palpate {
namespace {

/// Eigenvalues without negative ones, in units of the largest: squares neither overflow nor vanish. Zeros
/// where there is nothing else. NaN stays NaN.
Vec3 shares(const Vec3& eigenvalues) noexcept {
  const auto positive = [](double value) { return value < 0.0 ? 0.0 : value; };
  const Vec3 values{positive(eigenvalues.x), positive(eigenvalues.y), positive(eigenvalues.z)};
  return values.x == 0.0 ? values : values / values.x;
}

}  // namespace

Anisotropy anisotropy(const Vec3& eigenvalues) noexcept {
  const Vec3 part = shares(eigenvalues);
  if (part.x == 0.0) return {};
  const double sum = part.x + part.y + part.z;
  return {.linear = (part.x - part.y) / sum,
          .planar = 2.0 * (part.y - part.z) / sum,
          .spherical = 3.0 * part.z / sum};
}

std::string_view name_of(WestinScale scale) noexcept {
  return scale == WestinScale::kTrace ? "trace" : "largest";
}

WestinScale westin_from_name(std::string_view name) {
  for (const WestinScale scale : {WestinScale::kTrace, WestinScale::kLargest}) {
    if (name == name_of(scale)) return scale;
  }
  throw usage_error("--westin " + std::string(name) + ": trace, largest are known");
}

Anisotropy anisotropy(const Vec3& eigenvalues, WestinScale scale) noexcept {
  if (scale == WestinScale::kTrace) return anisotropy(eigenvalues);
  const Vec3 part = shares(eigenvalues);
  if (part.x == 0.0) return {};
  return {.linear = (part.x - part.y) / part.x,
          .planar = (part.y - part.z) / part.x,
          .spherical = part.z / part.x};
}

double fractional_anisotropy(const Vec3& eigenvalues) noexcept {
  const Vec3 part = shares(eigenvalues);
  if (part.x == 0.0) return 0.0;
  // Differences of pairs, not from the mean: exactly zero where all are equal.
  const Vec3 apart{part.x - part.y, part.y - part.z, part.z - part.x};
  return std::sqrt(0.5 * glm::dot(apart, apart) / glm::dot(part, part));
}

double mean_diffusivity(const Vec3& eigenvalues) noexcept {
  // Divided first: the sum of three may overflow.
  const auto third = [](double value) { return value < 0.0 ? 0.0 : value / 3.0; };
  return third(eigenvalues.x) + third(eigenvalues.y) + third(eigenvalues.z);
}

double mode_of_anisotropy(const Vec3& eigenvalues) noexcept {
  const Vec3 part = shares(eigenvalues);
  // Thrice the deviator, by differences of pairs.
  const Vec3 deviator{(part.x - part.y) + (part.x - part.z), (part.y - part.x) + (part.y - part.z),
                      (part.z - part.x) + (part.z - part.y)};
  const double largest = std::max({std::abs(deviator.x), std::abs(deviator.y), std::abs(deviator.z)});
  if (largest == 0.0) return 0.0;
  const Vec3 a = deviator / largest;
  const double square = glm::dot(a, a);
  const double mode = 3.0 * std::sqrt(6.0) * a.x * a.y * a.z / (square * std::sqrt(square));
  return mode > 1.0 ? 1.0 : mode < -1.0 ? -1.0 : mode;  // NaN stays NaN
}

}  // namespace palpate
