/// Numbers of one type in another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/field/data_set.h"

namespace palpate {

/// Calls `f` with a zero of the type; what it returns is of one type for all.
template <typename F>
auto with_type(ScalarType type, const F& f) {
  switch (type) {
    case ScalarType::kInt8:
      return f(std::int8_t{});
    case ScalarType::kUint8:
      return f(std::uint8_t{});
    case ScalarType::kInt16:
      return f(std::int16_t{});
    case ScalarType::kUint16:
      return f(std::uint16_t{});
    case ScalarType::kInt32:
      return f(std::int32_t{});
    case ScalarType::kUint32:
      return f(std::uint32_t{});
    case ScalarType::kInt64:
      return f(std::int64_t{});
    case ScalarType::kUint64:
      return f(std::uint64_t{});
    case ScalarType::kFloat32:
      return f(float{});
    case ScalarType::kFloat64:
      break;
  }
  return f(double{});
}

/// Whether its numbers are whole.
[[nodiscard]] bool is_whole(ScalarType type) noexcept;
/// Whether it holds `value` as it is, but for what is lost behind the point.
[[nodiscard]] bool reaches(ScalarType type, double value) noexcept;

struct TypedArray {
  DataArray array;          ///< one component
  std::size_t rounded = 0;  ///< numbers that are not exactly what they were
};
/// `values` in `type`: whole ones are the nearest, halves away from zero.
/// @throws Error (work failed) that names the first number that the type does not reach: NaN, where it has whole ones.
[[nodiscard]] TypedArray in_type(std::span<const double> values, ScalarType type);

struct ClampedArray {
  DataArray array;          ///< one component, named as the values
  std::size_t rounded = 0;  ///< numbers that are not exactly what they were, but for the following
  std::size_t clamped = 0;  ///< beyond what the type holds: its nearest number
  std::size_t missing = 0;  ///< NaN, which whole numbers have none for: 0
};
/// `values` in `type`, which may hold less. Infinite ones are clamped in whole types. @pre one component.
[[nodiscard]] ClampedArray clamped_to(const DataArray& values, ScalarType type);

/// Whether whole numbers name parts of an image, between which nothing can be interpolated: few different
/// ones, or most neighbours above the lowest one alike. @param points along the axes. @pre not sparse.
[[nodiscard]] bool looks_like_labels(const DataArray& values, const Index3& points);

}  // namespace palpate
