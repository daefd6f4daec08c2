#include "loaders/vtk/xml_file.h"

#include <algorithm>
#include <cmath>

#include <vtkCellData.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
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
#include "common/base/files/mapped_file.h"
#include "common/base/files/memory_text.h"
#include "common/base/text.h"
#include "common/field/grid/curved_cell.h"
#include "common/load/find_format.h"
#include "loaders/vtk/parallel_index.h"

namespace palpate {
namespace {

XmlScan checked_scan(const std::string& file) {
  if (find_format(file) == Format::kVtkParallel) return check_parallel(file, read_parallel_index(file));
  const MappedFile mapped(file);
  XmlScan scan = scan_xml(mapped.text());
  if (scan.new_polyhedra) {
    throw input_error({file, "", "has polyhedra in arrays of VTK 9.4 (polyhedron_to_faces)",
                       "the arrays faces and faceoffsets of the versions before",
                       "write it with VTK 9.3 or ParaView 5.12, or as EnSight"});
  }
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
    selection->SetArraySetting(name.c_str(), arrays.count(name) > 0 ? 1 : 0);
  }
}

/// The names of the arrays that polynomials of cells need, as the first piece marks them, else VTK's own.
struct ArraysOfCells {
  std::string weights = kRationalWeights, degrees = kHigherOrderDegrees;
};
ArraysOfCells arrays_of_cells(const std::string& file) {
  ArraysOfCells out;
  const MappedFile mapped(file);
  XmlTags tags(mapped.text());
  XmlTag tag;
  while (tags.next(tag) && (tag.name != "Piece" || tag.opens)) {
    if (tag.name == "AppendedData") break;
    if (tag.name == "PointData" && !tag.at(kRationalWeights).empty()) out.weights = tag.at(kRationalWeights);
    if (tag.name == "CellData" && !tag.at(kHigherOrderDegrees).empty())
      out.degrees = tag.at(kHigherOrderDegrees);
  }
  return out;
}

/// The file's text with a blank in the place of what VTK's reader stumbles over.
std::string readable_text(const std::string& file, const XmlScan& scan) {
  std::vector<std::pair<std::size_t, std::size_t>> cuts = scan.empty_pieces;
  for (const std::size_t at : scan.ends_in_letter) cuts.emplace_back(at, at);
  std::sort(cuts.begin(), cuts.end());
  const MappedFile mapped(file);
  std::string rest;
  std::size_t from = 0;
  for (const auto& [first, last] : cuts) {
    if (first < from) continue;
    rest.append(mapped.text().substr(from, first - from)).append(" ");
    from = last;
  }
  return rest.append(mapped.text().substr(from));
}

}  // namespace

struct XmlFile::Reader {
  vtkSmartPointer<vtkXMLReader> vtk;
  std::vector<MemoryText> pieces;  ///< that stand for files

  /// The index with names of `pieces` in the place of those of files whose text is not readable as it is.
  std::string index_of_readable(const std::string& file, const std::vector<std::size_t>& unreadable) {
    const ParallelIndex index = read_parallel_index(file);
    const MappedFile mapped(file);
    std::string text;
    std::size_t from = 0, piece = 0;
    XmlTags tags(mapped.text());
    XmlTag tag;
    while (tags.next(tag)) {
      if (tag.name != "Piece" || !tag.opens) continue;
      const std::size_t number = piece++;
      if (!std::binary_search(unreadable.begin(), unreadable.end(), number)) continue;
      const std::string name = index.pieces[number].file.string();
      const std::size_t end = tags.position();
      text += mapped.text().substr(from, mapped.text().rfind('<', end - 1) - from);
      text += "<Piece Extent=\"" + index.pieces[number].extent + "\" Source=\"" +
              pieces.emplace_back().write(readable_text(name, scan_xml(MappedFile(name).text()))) +
              (tag.closes ? "\"/>" : "\">");
      from = end;
    }
    return text.append(mapped.text().substr(from));
  }
};

XmlFile::XmlFile(const std::string& file, VtkErrors& errors)
    : file_(file), errors_(errors), scan_(checked_scan(file)), reader_(std::make_unique<Reader>()) {
  reader_->vtk = make_reader(scan_.data_type);
  if (reader_->vtk == nullptr)
    throw input_error({file_, "", "is of type '" + scan_.data_type.substr(0, 40) + "', which is not read"});
  reader_->vtk->SetFileName(file_.c_str());
  const bool pieces = !scan_.pieces_with_letters.empty();
  if (pieces || !scan_.empty_pieces.empty() || !scan_.ends_in_letter.empty()) {
    reader_->vtk->ReadFromInputStringOn();
    reader_->vtk->SetInputString(pieces ? reader_->index_of_readable(file_, scan_.pieces_with_letters)
                                        : readable_text(file_, scan_));
  }
  reader_->vtk->UpdateInformation();
  errors_.check(file_);
}

XmlFile::~XmlFile() = default;

vtkDataSet* XmlFile::read(const std::set<std::string>& wanted) {
  const ArraysOfCells of_cells = arrays_of_cells(file_);
  std::set<std::string> arrays = wanted;
  arrays.insert({"vtkGhostType", of_cells.weights, of_cells.degrees});  // parts of the topology
  select(reader_->vtk->GetPointDataArraySelection(), arrays);
  select(reader_->vtk->GetCellDataArraySelection(), arrays);
  reader_->vtk->Update();
  errors_.check(file_);
  vtkDataSet* data = reader_->vtk->GetOutputAsDataSet();
  if (data == nullptr)
    throw input_error({file_, "", "VTK's reader returned nothing", "", "the file may be damaged"});
  // VTK's reader keeps the first mark and not the second.
  data->GetPointData()->SetActiveAttribute(of_cells.weights.c_str(), vtkDataSetAttributes::RATIONALWEIGHTS);
  data->GetCellData()->SetActiveAttribute(of_cells.degrees.c_str(), vtkDataSetAttributes::HIGHERORDERDEGREES);
  return data;
}

std::optional<double> XmlFile::time() const {
  vtkInformation* const about = reader_->vtk->GetOutputInformation(0);
  auto* const steps = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  if (about->Has(steps) == 0 || about->Length(steps) != 1) return std::nullopt;
  const double time = about->Get(steps, 0);
  return std::isfinite(time) ? std::optional(time) : std::nullopt;
}

std::optional<double> xml_time(const std::string& file, VtkErrors& errors) {
  constexpr std::size_t kLook = std::size_t{4} << 20U;
  const MappedFile mapped(file);
  const std::string_view text = mapped.text().substr(0, kLook);
  XmlTags tags(text);
  XmlTag tag;
  std::string type;
  while (tags.next(tag) && tag.name != "AppendedData") {
    if (tag.name == "VTKFile" && tag.opens) type = tag.at("type");
    if (tag.name != "DataArray" || !tag.opens || tag.at("Name") != "TimeValue") continue;
    if (tag.at("format") == "ascii") {
      const std::string_view behind = text.substr(tags.position());
      const auto time = number(behind.substr(0, behind.find('<')));
      return time && std::isfinite(*time) ? time : std::nullopt;
    }
    if (make_reader(type) == nullptr) return std::nullopt;
    try {
      return XmlFile(file, errors).time();
    } catch (const Error&) {
      return std::nullopt;  // what is wrong shows when it is read
    }
  }
  return std::nullopt;
}

}  // namespace palpate
