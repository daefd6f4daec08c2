/// Legacy .vtk files through VTK's reader. The format has no array selection that VTK offers before a whole
/// pass over the file, so such a file is read once, entirely.
#pragma once

#include <string>

#include "loaders/vtk/vtk_errors.h"

class vtkDataObject;
template <class T>
class vtkSmartPointer;

namespace palpate {

/// All of the file. @throws Error (bad input).
[[nodiscard]] vtkSmartPointer<vtkDataObject> read_legacy(const std::string& file, VtkErrors& errors);

}  // namespace palpate
