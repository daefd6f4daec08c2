/// Fluent, GAMBIT and STAR-CD through VTK's readers.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <vtkCellType.h>
#include <vtkFLUENTReader.h>
#include <vtkGAMBITReader.h>
#include <vtkProStarReader.h>
#include <vtkSmartPointer.h>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/files/memory_text.h"
#include "common/base/index.h"
#include "common/load/helper/chosen_loader.h"
#include "loaders/cfd/cfd_check.h"
#include "loaders/cfd/fluent_faces.h"
#include "loaders/vtk/one_reader.h"

namespace palpate {
namespace {

void refuse(const std::string& file, const std::string& problem) {
  if (!problem.empty()) throw input_error({file, "", problem, "", "the file may be damaged"});
}

/// Values of cells, from the .dat beside.
class FluentReader : public OneReader {
 protected:
  vtkSmartPointer<vtkAlgorithm> make_reader(const std::string& file, std::vector<std::string>&) override {
    refuse(file, fluent_problem(MappedFile(file).text()));
    const std::string values = std::filesystem::path(file).replace_extension(".dat").string();
    std::error_code error;
    if (!std::filesystem::exists(values, error))
      throw input_error({file, "", "has no values beside it", "its data in " + values});
    refuse(values, fluent_problem(MappedFile(values).text()));
    file_ = file;
    reader_ = vtkSmartPointer<vtkFLUENTReader>::New();
    reader_->SetFileName(file.c_str());
    return reader_;
  }
  void select(const std::set<std::string>* wanted) override {
    for (int i = 0; i < reader_->GetNumberOfCellArrays(); ++i) {
      const std::string name = reader_->GetCellArrayName(i);
      reader_->SetCellArrayStatus(name.c_str(), wanted == nullptr || wanted->count(name) > 0 ? 1 : 0);
    }
  }
  /// VTK leaves polyhedra as sets of points.
  void finish(DataSet& block) override {
    auto& mesh = std::get<UnstructuredTopology>(block.topology);
    if (std::ranges::find(mesh.types, VTK_CONVEX_POINT_SET) == mesh.types.end()) return;
    if (!faces_) faces_ = read_fluent_faces(MappedFile(file_).text());
    refuse(file_, restore_polyhedra(mesh, *faces_));
  }

 private:
  std::string file_;
  std::optional<FluentFaces> faces_;  ///< read where there are polyhedra
  vtkSmartPointer<vtkFLUENTReader> reader_;
};

constexpr const char* kMeshAlone = "the mesh alone: no values are read of this format";

/// A mesh alone.
class GambitReader : public OneReader {
 protected:
  vtkSmartPointer<vtkAlgorithm> make_reader(const std::string& file,
                                            std::vector<std::string>& notes) override {
    const MappedFile mapped(file);
    refuse(file, gambit_problem(mapped.text()));
    notes.emplace_back(kMeshAlone);
    const auto reader = vtkSmartPointer<vtkGAMBITReader>::New();
    if (mapped.text().find('\r') == std::string_view::npos) {
      reader->SetFileName(file.c_str());
    } else {
      std::string text(mapped.text());
      std::erase(text, '\r');
      reader->SetFileName(memory_.write(text).c_str());
    }
    return reader;
  }
  void select(const std::set<std::string>*) override {}
  /// VTK leaves the corners in GAMBIT's order, which goes along rows, not around.
  void finish(DataSet& block) override {
    constexpr std::uint8_t kHexahedron = 12, kPyramid = 14;
    auto& mesh = std::get<UnstructuredTopology>(block.topology);
    for (std::size_t c = 0; c < mesh.types.size(); ++c) {
      if (mesh.types[c] != kHexahedron && mesh.types[c] != kPyramid) continue;
      const std::size_t first = as_size(mesh.offsets[c]);
      std::swap(mesh.connectivity[first + 2], mesh.connectivity[first + 3]);
      if (mesh.types[c] == kHexahedron) std::swap(mesh.connectivity[first + 6], mesh.connectivity[first + 7]);
    }
  }

 private:
  MemoryText memory_;
};

/// A mesh alone: .vrt and .cel.
class StarCdReader : public OneReader {
 protected:
  vtkSmartPointer<vtkAlgorithm> make_reader(const std::string& file,
                                            std::vector<std::string>& notes) override {
    for (const char* const ending : {".vrt", ".cel"}) {
      const std::string part = std::filesystem::path(file).replace_extension(ending).string();
      std::error_code error;
      if (!std::filesystem::exists(part, error)) throw input_error({file, "", "lacks its other half", part});
    }
    notes.emplace_back(kMeshAlone);
    const auto reader = vtkSmartPointer<vtkProStarReader>::New();
    reader->SetFileName(file.c_str());
    return reader;
  }
  void select(const std::set<std::string>*) override {}
};

class CfdLoader : public ChosenLoader {
 protected:
  std::unique_ptr<Loader> choose(const LoadRequest& request, Format format) override {
    if (format == Format::kFluent) return std::make_unique<FluentReader>();
    if (format == Format::kGambit) return std::make_unique<GambitReader>();
    if (format == Format::kStarCd) return std::make_unique<StarCdReader>();
    throw input_error(
        {request.files.front().string(), "", "is of another format", "Fluent, GAMBIT or STAR-CD"});
  }
};

}  // namespace

[[nodiscard]] std::unique_ptr<Loader> make_cfd_loader() { return std::make_unique<CfdLoader>(); }

}  // namespace palpate
