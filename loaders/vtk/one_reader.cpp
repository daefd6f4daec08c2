#include "loaders/vtk/one_reader.h"

#include <vtkAlgorithm.h>
#include <vtkDataArraySelection.h>
#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkInformation.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include "common/base/error.h"
#include "common/load/step_times.h"

namespace palpate {

FileInfo OneReader::open(const LoadRequest& request, Format format) {
  if (request.files.size() > 1) {
    throw input_error({request.files[1].string(), "",
                       "is a second " + std::string(row_of(format).name) + " file", "one file"});
  }
  file_ = request.files.front().string();
  FileInfo info;
  reader_ = make_reader(file_, info.notes);
  info.units = units();
  reader_->UpdateInformation();
  errors_.check(file_);
  look(file_, info.notes);
  errors_.check(file_);
  vtkInformation* const about = reader_->GetOutputInformation(0);
  auto* const steps = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  if (about->Has(steps) != 0) times_.assign(about->Get(steps), about->Get(steps) + about->Length(steps));
  check_rising(file_, times_);
  if (times_.size() > 1) info.times = times_;
  select(nullptr);
  update(0);
  for (const VtkBlock& block : usable(&info.notes))
    info.blocks.push_back(describe_block(block.data, block.name));
  return info;
}

std::vector<DataSet> OneReader::read(const std::vector<std::string>& names, std::size_t step) {
  if (reader_ == nullptr) throw work_error("nothing was opened");
  const std::set<std::string> wanted(names.begin(), names.end());
  select(&wanted);
  update(step);
  std::vector<DataSet> blocks;
  for (const VtkBlock& block : usable(nullptr))
    finish(blocks.emplace_back(convert_block(block.data, block.name, wanted, file_)));
  return blocks;
}

void OneReader::finish(DataSet&) {}

void OneReader::look(const std::string&, std::vector<std::string>&) {}

void OneReader::select_in(vtkDataArraySelection* selection, const std::set<std::string>* wanted) {
  for (int i = 0; i < selection->GetNumberOfArrays(); ++i) {
    const std::string name = selection->GetArrayName(i);
    selection->SetArraySetting(name.c_str(), wanted == nullptr || wanted->count(name) > 0 ? 1 : 0);
  }
}

/// VTK's readers make empty cells of kinds that they do not know.
std::vector<VtkBlock> OneReader::usable(std::vector<std::string>* notes) {
  const std::vector<VtkBlock> leaves = leaves_of(reader_->GetOutputDataObject(0));
  for (const VtkBlock& leaf : leaves) {
    auto* const mesh = vtkUnstructuredGrid::SafeDownCast(leaf.data);
    for (vtkIdType c = 0; mesh != nullptr && c < mesh->GetNumberOfCells(); ++c) {
      if (mesh->GetCellType(c) != VTK_EMPTY_CELL) continue;
      throw input_error({file_,
                         "cell " + std::to_string(c) + (leaf.name.empty() ? "" : " of '" + leaf.name + "'"),
                         "is of a kind that VTK's reader does not know"});
    }
  }
  return usable_blocks(leaves, "block", file_, notes);
}

void OneReader::update(std::size_t step) {
  if (times_.empty()) {
    reader_->Update();
  } else {
    reader_->UpdateTimeStep(times_[step]);
  }
  errors_.check(file_);
  if (reader_->GetOutputDataObject(0) == nullptr)
    throw input_error({file_, "", "VTK's reader returned nothing", "", "the file may be damaged"});
}

}  // namespace palpate
