#include "common/field/tensor/gradient_table.h"

#include <algorithm>

namespace palpate {

double GradientTable::largest_weighting() const noexcept {
  return weightings.empty() ? 0.0 : *std::max_element(weightings.begin(), weightings.end());
}

bool GradientTable::unweighted(std::size_t i) const noexcept {
  constexpr double kSmall = 0.05;
  return !(weightings[i] > kSmall * largest_weighting()) || directions[i] == Vec3{0.0};
}

std::size_t GradientTable::unweighted_count() const noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < weightings.size(); ++i) count += unweighted(i) ? 1 : 0;
  return count;
}

}  // namespace palpate
