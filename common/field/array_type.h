/// Numbers of one type in another.
#pragma once

#include <cstddef>
#include <span>

#include "common/field/data_set.h"

namespace palpate {

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

/// Whether whole numbers name parts of an image, between which nothing can be interpolated: few different
/// ones, or most neighbours above the lowest one alike. @param points along the axes. @pre not sparse.
[[nodiscard]] bool looks_like_labels(const DataArray& values, const Index3& points);

}  // namespace palpate
