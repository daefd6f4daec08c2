/// A digest of a mesh: of its cells and the places of its points, to the last bit.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "common/field/data_set.h"

namespace palpate {

/// SHA-256 in hexadecimal of topology, positions, what is visible, the arrays named by `with`, and `words`.
/// Empty for images, which have no cells.
/// @param with arrays of `mesh`; null ones are left out. @param threads as parallel_for(); they change
/// nothing.
[[nodiscard]] std::string mesh_digest(const DataSet& mesh, std::span<const DataArray* const> with,
                                      std::string_view words, int threads);

}  // namespace palpate
