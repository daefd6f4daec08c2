#include "common/field/array_type.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

template <typename T>
bool holds(double value) noexcept {
  if constexpr (std::is_integral_v<T>) {
    // The bound above is one more than the largest number, which a double holds for every type.
    const double over = std::ldexp(1.0, std::numeric_limits<T>::digits);
    const double whole = std::round(value);
    return whole >= static_cast<double>(std::numeric_limits<T>::lowest()) && whole < over;
  } else {
    return !std::isfinite(value) || std::abs(value) <= static_cast<double>(std::numeric_limits<T>::max());
  }
}

}  // namespace

bool is_whole(ScalarType type) noexcept {
  return type != ScalarType::kFloat32 && type != ScalarType::kFloat64;
}

bool reaches(ScalarType type, double value) noexcept {
  return with_type(type, [value](auto zero) { return holds<decltype(zero)>(value); });
}

TypedArray in_type(std::span<const double> values, ScalarType type) {
  return with_type(type, [&](auto zero) {
    using T = decltype(zero);
    TypedArray typed;
    auto numbers = std::make_shared<std::vector<T>>();
    numbers->reserve(values.size());
    for (const double value : values) {
      if (!holds<T>(value)) {
        throw work_error("the value " + short_number(value) + " does not fit into " + name_of(type));
      }
      numbers->push_back(static_cast<T>(std::is_integral_v<T> ? std::round(value) : value));
      typed.rounded += std::isnan(value) || static_cast<double>(numbers->back()) == value ? 0 : 1;
    }
    typed.array = {.name = "scalars", .type = type, .tuples = values.size()};
    typed.array.bytes = std::as_bytes(std::span<const T>(*numbers));
    typed.array.owner = std::move(numbers);
    return typed;
  });
}

ClampedArray clamped_to(const DataArray& values, ScalarType type) {
  return with_type(type, [&](auto zero) {
    using T = decltype(zero);
    ClampedArray result;
    auto numbers = std::make_shared<std::vector<T>>(values.tuples);
    for (std::size_t i = 0; i < values.tuples; ++i) {
      const double value = values.at(i);
      T& number = (*numbers)[i];
      if (std::isnan(value) && std::is_integral_v<T>) {
        ++result.missing;
      } else if (!holds<T>(value)) {
        number = value < 0.0 ? std::numeric_limits<T>::lowest() : std::numeric_limits<T>::max();
        ++result.clamped;
      } else {
        number = static_cast<T>(std::is_integral_v<T> ? std::round(value) : value);
        result.rounded += std::isnan(value) || static_cast<double>(number) == value ? 0 : 1;
      }
    }
    result.array = {.name = values.name, .type = type, .tuples = values.tuples};
    result.array.bytes = std::as_bytes(std::span<const T>(*numbers));
    result.array.owner = std::move(numbers);
    return result;
  });
}

bool looks_like_labels(const DataArray& values, const Index3& points) {
  if (!is_whole(values.type) || values.components != 1 || values.tuples == 0) return false;
  constexpr std::size_t kFew = 64;
  constexpr double kAlike = 0.85;
  std::set<double> different;
  double lowest = values.at(0);
  for (std::size_t i = 0; i < values.tuples; ++i) {
    const double value = values.at(i);
    lowest = std::min(lowest, value);
    if (different.size() <= kFew) different.insert(value);
  }
  if (different.size() <= kFew) return true;
  std::size_t alike = 0, pairs = 0;
  const std::size_t row = as_size(points.x);
  for (std::size_t i = 1; i < values.tuples; ++i) {
    if (i % row == 0) continue;
    const double a = values.at(i - 1), b = values.at(i);
    if (a == lowest || b == lowest) continue;
    ++pairs;
    alike += a == b ? 1 : 0;
  }
  return pairs > 0 && static_cast<double>(alike) >= kAlike * static_cast<double>(pairs);
}

}  // namespace palpate
