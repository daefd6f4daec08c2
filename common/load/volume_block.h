/// What loaders say of the one block that an image or a mesh is.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/load/load.h"

namespace palpate {

/// The array that holds red, green, blue and perhaps opacity, 0 to 255 each.
inline constexpr const char* kColorArray = "colors";

/// Whether cells of this VTK type are points, lines or surfaces, straight or curved.
[[nodiscard]] bool is_flat_cell(std::uint8_t type) noexcept;
/// BlockInfo::not_volume of a mesh that has no other cells.
inline constexpr const char* kOnlyFlatCells = "holds points, lines or surfaces only, not a volume";

/// The smallest box around all samples.
[[nodiscard]] Box sample_bounds(const UniformTopology& topology) noexcept;

/// The block of an image with one array; it is no volume where it has one sample only along an axis.
[[nodiscard]] BlockInfo describe_image(const UniformTopology& topology, const ArrayInfo& array);

/// The block of an unstructured mesh; it is no volume where all cells are flat. @pre mesh.topology is one.
[[nodiscard]] BlockInfo describe_mesh(const DataSet& mesh);

/// What a reader of one image gives for the arrays that are asked for: the block, with `values()` where `array` is
/// one of `names`.
[[nodiscard]] std::vector<DataSet> read_image(const UniformTopology& topology, const std::string& array,
                                              const std::vector<std::string>& names,
                                              const std::function<DataArray()>& values);

}  // namespace palpate
