#include "loaders/vtk/legacy_file.h"

#include <vtkDataObject.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkSmartPointer.h>

#include "common/base/error.h"
#include "loaders/vtk/legacy_check.h"

namespace palpate {

vtkSmartPointer<vtkDataObject> read_legacy(const std::string& file, VtkErrors& errors) {
  check_legacy(file);
  const auto reader = vtkSmartPointer<vtkGenericDataObjectReader>::New();
  reader->SetFileName(file.c_str());
  // By default only the first array of each kind would be read.
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllColorScalarsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllFieldsOn();
  reader->Update();
  errors.check(file);
  vtkSmartPointer<vtkDataObject> data = reader->GetOutput();
  if (data == nullptr || reader->GetErrorCode() != 0) {
    throw input_error({file, "", "cannot be read as a legacy VTK file", "", "the file may be damaged"});
  }
  return data;
}

}  // namespace palpate
