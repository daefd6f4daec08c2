/// Cases of several files, EnSight and OpenFOAM, through VTK's readers: both offer their arrays by name and
/// their time steps one by one.
#include <filesystem>
#include <map>

#include <vtkGenericEnSightReader.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkOpenFOAMReader.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "common/base/error.h"
#include "loaders/vtk/ensight_check.h"
#include "loaders/vtk/solver_readers.h"
#include "loaders/vtk/vtk_convert.h"
#include "loaders/vtk/vtk_errors.h"

namespace palpate {
namespace {

void set_up(vtkGenericEnSightReader& reader, const std::string& file) {
  reader.SetCaseFileName(file.c_str());
  reader.ReadAllVariablesOff();
}

void set_up(vtkOpenFOAMReader& reader, const std::string& file) {
  // The reader wants a file in the case's folder; it need not be there.
  const bool folder = std::filesystem::is_directory(file);
  reader.SetFileName(folder ? (std::filesystem::path(file) / "case.foam").c_str() : file.c_str());
  // Cell values stay cell values and polyhedra polyhedra: how they become tetrahedra is the field's matter.
  reader.CreateCellToPointOff();
  reader.DecomposePolyhedraOff();
  reader.SkipZeroTimeOff();
}

/// EnSight lists patches as parts; OpenFOAM's boundary patches are switched off, the mesh inside is not.
void choose_parts(vtkGenericEnSightReader&) {}
void choose_parts(vtkOpenFOAMReader& reader) {
  reader.DisableAllPatchArrays();
  reader.SetPatchArrayStatus("internalMesh", 1);
  reader.DisableAllLagrangianArrays();
}

/// VTK's EnSight readers take what is there of a truncated file: its size has to account for the values.
void check_values(const vtkGenericEnSightReader&, const std::string& file, const DataArray& total,
                  std::size_t step, std::size_t steps) {
  check_ensight_values(file, total.name, total.association,
                       total.tuples * static_cast<std::size_t>(total.components), step, steps);
}
void check_values(const vtkOpenFOAMReader&, const std::string&, const DataArray&, std::size_t, std::size_t) {}

template <class Reader>
class CaseReader : public Loader {
 public:
  explicit CaseReader(Format format) : format_(format) {}

  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1) {
      throw input_error({request.files[1].string(), "", "is a second case",
                         "one " + std::string(row_of(format_).name) + " case"});
    }
    file_ = request.files.front().string();
    reader_ = vtkSmartPointer<Reader>::New();
    set_up(*reader_, file_);
    reader_->UpdateInformation();
    errors_.check(file_);
    choose_parts(*reader_);

    FileInfo info;
    vtkInformation* about = reader_->GetOutputInformation(0);
    auto* const steps = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
    if (about->Has(steps) != 0) times_.assign(about->Get(steps), about->Get(steps) + about->Length(steps));
    if (times_.size() > 1) info.times = times_;

    // VTK knows the arrays' shapes only once they are read: the last step has them all (at the first one an
    // OpenFOAM case often has no mesh values yet), and only that one is read here.
    select(nullptr);
    update(times_.empty() ? 0 : times_.size() - 1);
    for (const VtkBlock& block : usable(&info.notes))
      info.blocks.push_back(describe_block(block.data, block.name));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    const std::set<std::string> wanted(names.begin(), names.end());
    select(&wanted);
    update(step);
    std::vector<DataSet> blocks;
    for (const VtkBlock& block : usable(nullptr))
      blocks.push_back(convert_block(block.data, block.name, wanted, file_));
    // The values of an array in all blocks together.
    std::map<std::pair<std::string, Association>, DataArray> totals;
    for (const DataSet& block : blocks) {
      for (const DataArray& array : block.arrays) {
        DataArray& total = totals[{array.name, array.association}];
        const std::size_t before = total.tuples;
        total = array;
        total.tuples += before;
      }
    }
    for (const auto& [key, total] : totals) {
      check_values(*reader_, file_, total, step, std::max<std::size_t>(1, times_.size()));
    }
    return blocks;
  }

 private:
  /// Null: every array.
  void select(const std::set<std::string>* wanted) {
    const auto status = [wanted](const char* name) {
      return wanted == nullptr || wanted->count(name) > 0 ? 1 : 0;
    };
    for (int i = 0; i < reader_->GetNumberOfPointArrays(); ++i) {
      reader_->SetPointArrayStatus(reader_->GetPointArrayName(i), status(reader_->GetPointArrayName(i)));
    }
    for (int i = 0; i < reader_->GetNumberOfCellArrays(); ++i) {
      reader_->SetCellArrayStatus(reader_->GetCellArrayName(i), status(reader_->GetCellArrayName(i)));
    }
  }

  void update(std::size_t step) {
    if (times_.empty()) {
      reader_->Update();
    } else {
      reader_->UpdateTimeStep(times_[step]);
    }
    errors_.check(file_);
  }

  std::vector<VtkBlock> usable(std::vector<std::string>* notes) {
    return usable_blocks(leaves_of(reader_->GetOutput()), "part", file_, notes);
  }

  Format format_;
  VtkErrors errors_;
  vtkSmartPointer<Reader> reader_;
  std::string file_;
  std::vector<double> times_;
};

}  // namespace

std::unique_ptr<Loader> make_ensight_reader() {
  return std::make_unique<CaseReader<vtkGenericEnSightReader>>(Format::kEnsight);
}
std::unique_ptr<Loader> make_openfoam_reader() {
  return std::make_unique<CaseReader<vtkOpenFOAMReader>>(Format::kOpenFoam);
}

}  // namespace palpate
