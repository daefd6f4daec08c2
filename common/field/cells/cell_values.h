/// Values of cells brought to the points of a grid, and by how much what comes of it differs from them.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "common/field/data_set.h"
#include "common/field/field_grid.h"

namespace palpate {

using PutValue = std::function<void(std::size_t point, const double* value)>;
using PointComponent = std::function<double(std::size_t point, int component)>;

/// Values at all points, by cell_fit.h from the cells that touch a point; at borders, where these lie on one side,
/// from the cells next to those, too, and so on where all lie in one layer. A cell's value is that of its centre
/// of mass. Or by the mean over the cells that touch each. Values that are not finite stay with the points that their cells touch. Points without cells get none.
/// @param put is called from several threads, for different points. @param value_at reads what was put.
CellDifference bring_to_points(const FieldGrid& grid, std::span<const DataSet> blocks, int components,
                               const TupleReader& read, const PutValue& put, const PointComponent& value_at,
                               CellRule rule, int threads);

/// What was done to cell values, and what it costs.
[[nodiscard]] std::string cell_values_note(const CellDifference& difference);

}  // namespace palpate
