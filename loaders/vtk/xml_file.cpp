#include "loaders/vtk/xml_file.h"

#include <vtkDataArraySelection.h>
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPImageDataReader.h>
#include <vtkXMLPRectilinearGridReader.h>
#include <vtkXMLPStructuredGridReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLStructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "common/base/error.h"
#include "common/base/mapped_file.h"
#include "common/load/find_format.h"
#include "loaders/vtk/parallel_index.h"

namespace palpate {
namespace {

XmlScan checked_scan(const std::string& file) {
  if (find_format(file) == Format::kVtkParallel) return check_parallel(file, read_parallel_index(file));
  const MappedFile mapped(file);
  XmlScan scan = scan_xml(mapped.text());
  if (!scan.problem.empty()) throw input_error({file, "", scan.problem, "", "the file may be damaged"});
  return scan;
}

vtkSmartPointer<vtkXMLReader> make_reader(const std::string& type) {
  if (type == "ImageData") return vtkSmartPointer<vtkXMLImageDataReader>::New();
  if (type == "RectilinearGrid") return vtkSmartPointer<vtkXMLRectilinearGridReader>::New();
  if (type == "StructuredGrid") return vtkSmartPointer<vtkXMLStructuredGridReader>::New();
  if (type == "UnstructuredGrid") return vtkSmartPointer<vtkXMLUnstructuredGridReader>::New();
  if (type == "PolyData") return vtkSmartPointer<vtkXMLPolyDataReader>::New();
  if (type == "PImageData") return vtkSmartPointer<vtkXMLPImageDataReader>::New();
  if (type == "PRectilinearGrid") return vtkSmartPointer<vtkXMLPRectilinearGridReader>::New();
  if (type == "PStructuredGrid") return vtkSmartPointer<vtkXMLPStructuredGridReader>::New();
  return nullptr;
}

void select(vtkDataArraySelection* selection, const std::set<std::string>& arrays) {
  for (int i = 0; i < selection->GetNumberOfArrays(); ++i) {
    const std::string name = selection->GetArrayName(i);
    // Ghost marks are part of the topology.
    const bool wanted = arrays.count(name) > 0 || name == "vtkGhostType";
    selection->SetArraySetting(name.c_str(), wanted ? 1 : 0);
  }
}

}  // namespace

struct XmlFile::Reader {
  vtkSmartPointer<vtkXMLReader> vtk;
};

XmlFile::XmlFile(const std::string& file, VtkErrors& errors)
    : file_(file), errors_(errors), scan_(checked_scan(file)), reader_(std::make_unique<Reader>()) {
  reader_->vtk = make_reader(scan_.data_type);
  if (reader_->vtk == nullptr)
    throw input_error({file_, "", "is of type '" + scan_.data_type.substr(0, 40) + "', which is not read"});
  if (scan_.empty_pieces.empty()) {
    reader_->vtk->SetFileName(file_.c_str());
  } else {
    const MappedFile mapped(file_);
    std::string rest;
    std::size_t from = 0;
    for (const auto& [first, last] : scan_.empty_pieces) {
      rest += mapped.text().substr(from, first - from);
      from = last;
    }
    rest += mapped.text().substr(from);
    reader_->vtk->ReadFromInputStringOn();
    reader_->vtk->SetInputString(rest);
  }
  reader_->vtk->UpdateInformation();
  errors_.check(file_);
}

XmlFile::~XmlFile() = default;

vtkDataSet* XmlFile::read(const std::set<std::string>& arrays) {
  select(reader_->vtk->GetPointDataArraySelection(), arrays);
  select(reader_->vtk->GetCellDataArraySelection(), arrays);
  reader_->vtk->Update();
  errors_.check(file_);
  vtkDataSet* data = reader_->vtk->GetOutputAsDataSet();
  if (data == nullptr)
    throw input_error({file_, "", "VTK's reader returned nothing", "", "the file may be damaged"});
  return data;
}

}  // namespace palpate
