/// Data sets made for the stability table: formulas on small grids, and altered copies of data at hand.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/vector_field.h"
#include "common/math/vec.h"

namespace palpate {

using FieldPtr = std::shared_ptr<const VectorField>;
using VectorFormula = std::function<Vec3(const Vec3&)>;

/// n x n x n points over `bounds` with the point array "velocity" in doubles. @pre n >= 2.
[[nodiscard]] DataSet uniform_data(int n, const Box& bounds, const VectorFormula& velocity);

/// Points between the given coordinates, with "velocity" in doubles.
[[nodiscard]] DataSet rectilinear_data(const std::vector<double>& x, const std::vector<double>& y,
                                       const std::vector<double>& z, const VectorFormula& velocity);

/// Six tetrahedra a box (Kuhn 1960) between the given coordinates, with "velocity" in doubles.
[[nodiscard]] DataSet tetrahedral_data(const std::vector<double>& x, const std::vector<double>& y,
                                       const std::vector<double>& z, const VectorFormula& velocity);

/// The field of one such data set.
[[nodiscard]] FieldPtr made_field(DataSet data);

/// n coordinates from -1 to 1.
[[nodiscard]] std::vector<double> even_coordinates(int n);

/// A copy in doubles with positions multiplied by `length` and all arrays by `value`.
[[nodiscard]] DataSet scaled_data(const DataSet& data, double length, double value);

/// A copy in doubles whose point arrays are NaN within `radius` of `center`.
[[nodiscard]] DataSet holed_data(const DataSet& data, const Vec3& center, double radius);

/// Position of a point of any topology. @pre point < data.point_count().
[[nodiscard]] Vec3 point_position(const DataSet& data, std::size_t point);

}  // namespace palpate
