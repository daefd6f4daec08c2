/// VTK data sets as the project's DataSet. Arrays are not copied: they keep the VTK object alive.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/load/load.h"

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;

namespace palpate {

/// One block found in a VTK data object.
struct VtkBlock {
  vtkDataSet* data = nullptr;  ///< lives as long as the object it was found in
  std::string name;
};

/// The leaves of a composite object, or the object itself, in file order. Unnamed leaves are numbered
/// where there are several.
[[nodiscard]] std::vector<VtkBlock> leaves_of(vtkDataObject* object);

/// Why `data` cannot be used at all ("holds no points"), or empty.
[[nodiscard]] std::string why_not_readable(vtkDataSet* data);

/// Why readable `data` holds no volume to explore ("holds points, lines or surfaces …"), or empty.
[[nodiscard]] std::string why_not_volume(vtkDataSet* data);

/// The volumes among `leaves`; where there is none, all that is readable. What is left out goes to `notes`
/// (unless null) with its reason.
/// @param kind how the format calls a block ("part").
/// @throws Error (bad input) with `file` where nothing is left.
[[nodiscard]] std::vector<VtkBlock> usable_blocks(const std::vector<VtkBlock>& leaves,
                                                  const std::string& kind, const std::string& file,
                                                  std::vector<std::string>* notes);

/// The field data kLongAxisArray of a block: a finite direction; nothing where there is none.
[[nodiscard]] std::optional<Vec3> long_axis_of(vtkDataSet* data);

/// What the block holds, its arrays included.
[[nodiscard]] BlockInfo describe_block(vtkDataSet* data, const std::string& name);

/// The block with the arrays whose names are in `wanted`.
/// @throws Error (bad input) with `file`: degenerate axes, or coordinates that do not increase.
[[nodiscard]] DataSet convert_block(vtkDataSet* data, const std::string& name,
                                    const std::set<std::string>& wanted, const std::string& file);

/// The project's type for one of VTK's ("float" is 10), or false for bits and others.
[[nodiscard]] bool scalar_type_of(int vtk_type, ScalarType& type);

}  // namespace palpate
