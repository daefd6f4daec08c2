#include "loaders/vtk/legacy_file.h"

#include <cmath>
#include <limits>

#include <vtkAOSDataArrayTemplate.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkGenericDataObjectReader.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/index.h"
#include "loaders/vtk/legacy_check.h"

namespace palpate {
namespace {

/// Puts back what stand-ins stand for.
template <typename T>
bool restore(vtkDataArray* array) {
  auto* const values = vtkAOSDataArrayTemplate<T>::FastDownCast(array);
  if (values == nullptr) return false;
  constexpr T kInfinity = std::numeric_limits<T>::infinity();
  for (vtkIdType i = 0; i < values->GetNumberOfValues(); ++i) {
    const T value = values->GetValue(i);
    if (value == static_cast<T>(kStandIns[0].number))
      values->SetValue(i, std::numeric_limits<T>::quiet_NaN());
    if (value == static_cast<T>(kStandIns[1].number)) values->SetValue(i, kInfinity);
    if (value == static_cast<T>(kStandIns[2].number)) values->SetValue(i, -kInfinity);
  }
  return true;
}

void restore(vtkDataArray* array) {
  if (array != nullptr && !restore<float>(array)) restore<double>(array);
}

void restore(vtkFieldData* arrays) {
  for (int i = 0; arrays != nullptr && i < arrays->GetNumberOfArrays(); ++i) restore(arrays->GetArray(i));
}

void restore(vtkDataObject* data) {
  restore(data->GetFieldData());
  auto* const set = vtkDataSet::SafeDownCast(data);
  if (set == nullptr) return;
  restore(static_cast<vtkFieldData*>(set->GetPointData()));
  restore(static_cast<vtkFieldData*>(set->GetCellData()));
  if (auto* points = vtkPointSet::SafeDownCast(data); points != nullptr && points->GetPoints() != nullptr) {
    restore(points->GetPoints()->GetData());
    points->GetPoints()->Modified();
  }
  if (auto* box = vtkRectilinearGrid::SafeDownCast(data)) {
    for (vtkDataArray* axis : {box->GetXCoordinates(), box->GetYCoordinates(), box->GetZCoordinates()})
      restore(axis);
  }
}

}  // namespace

vtkSmartPointer<vtkDataObject> read_legacy(const std::string& file, VtkErrors& errors) {
  const auto reader = vtkSmartPointer<vtkGenericDataObjectReader>::New();
  bool stand_ins = false;
  {
    const MappedFile mapped(file);
    const LegacyScan scan = scan_legacy(mapped.text());
    if (!scan.problem.empty()) throw input_error({file, "", scan.problem, "", "the file may be damaged"});
    stand_ins = !scan.not_finite.empty();
    if (stand_ins) {
      const std::string text = with_stand_ins(mapped.text(), scan.not_finite);
      if (text.size() > as_size(std::numeric_limits<int>::max()))
        throw input_error(
            {file, "", "holds NaN or infinity in more than 2 GB of text", "", "store it in binary"});
      reader->ReadFromInputStringOn();
      reader->SetInputString(text.data(), static_cast<int>(text.size()));
    } else {
      reader->SetFileName(file.c_str());
    }
  }
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
  if (stand_ins) restore(data.Get());
  return data;
}

}  // namespace palpate
