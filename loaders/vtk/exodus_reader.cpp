/// Exodus II through vtkExodusIIReader: nodal and element variables of the element blocks, joined into one
/// mesh since they share their nodes.
#include <cstring>
#include <vector>

#include <vtkExodusIIReader.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "common/base/error.h"
#include "loaders/vtk/netcdf_check.h"
#include "loaders/vtk/solver_readers.h"
#include "loaders/vtk/vtk_convert.h"
#include "loaders/vtk/vtk_errors.h"

namespace palpate {
namespace {

constexpr int kNodal = vtkExodusIIReader::NODAL;
constexpr int kElement = vtkExodusIIReader::ELEM_BLOCK;

/// Joins blocks that share one list of points: cells one after another. An array of cells stays where every
/// block has it with the same type.
DataSet join(std::vector<DataSet> blocks) {
  DataSet joined = std::move(blocks.front());
  auto& mesh = std::get<UnstructuredTopology>(joined.topology);
  for (std::size_t b = 1; b < blocks.size(); ++b) {
    const auto& other = std::get<UnstructuredTopology>(blocks[b].topology);
    const std::int64_t shift = mesh.offsets.back();
    mesh.types.insert(mesh.types.end(), other.types.begin(), other.types.end());
    for (std::size_t i = 1; i < other.offsets.size(); ++i) mesh.offsets.push_back(other.offsets[i] + shift);
    mesh.connectivity.insert(mesh.connectivity.end(), other.connectivity.begin(), other.connectivity.end());
    std::erase_if(joined.arrays, [&](DataArray& array) {
      if (array.association == Association::kPoint) return false;
      const DataArray* more = blocks[b].find(array.name, Association::kCell);
      if (more == nullptr || more->type != array.type || more->components != array.components) return true;
      const auto bytes = std::make_shared<std::vector<std::byte>>(array.bytes.begin(), array.bytes.end());
      bytes->insert(bytes->end(), more->bytes.begin(), more->bytes.end());
      array.tuples += more->tuples;
      array.bytes = *bytes;
      array.owner = bytes;
      return false;
    });
  }
  joined.name.clear();
  return joined;
}

class ExodusReader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1) {
      throw input_error({request.files[1].string(), "", "is a second Exodus II file", "one file"});
    }
    file_ = request.files.front().string();
    check_netcdf(file_);
    reader_ = vtkSmartPointer<vtkExodusIIReader>::New();
    reader_->SetFileName(file_.c_str());
    reader_->UpdateInformation();
    errors_.check(file_);
    // Points as they are in the file; nothing generated; every block with all nodes, so that they join.
    reader_->SetApplyDisplacements(0);
    reader_->SetGenerateObjectIdCellArray(0);
    reader_->SetGenerateGlobalElementIdArray(0);
    reader_->SetGenerateGlobalNodeIdArray(0);
    reader_->SetSqueezePoints(false);
    for (int i = 0; i < reader_->GetNumberOfObjects(kElement); ++i) reader_->SetObjectStatus(kElement, i, 1);
    for (const int sets :
         {vtkExodusIIReader::NODE_SET, vtkExodusIIReader::SIDE_SET, vtkExodusIIReader::EDGE_SET,
          vtkExodusIIReader::FACE_SET, vtkExodusIIReader::ELEM_SET, vtkExodusIIReader::EDGE_BLOCK,
          vtkExodusIIReader::FACE_BLOCK}) {
      for (int i = 0; i < reader_->GetNumberOfObjects(sets); ++i) reader_->SetObjectStatus(sets, i, 0);
    }
    select({});

    FileInfo info;
    vtkInformation* about = reader_->GetOutputInformation(0);
    auto* const steps = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
    if (about->Has(steps) != 0) times_.assign(about->Get(steps), about->Get(steps) + about->Length(steps));
    if (times_.size() > 1) info.times = times_;

    const DataSet mesh = load({}, 0, &info.notes);
    BlockInfo block = describe_block(blocks_.front().data, "");
    block.arrays.clear();
    block.cell_count = std::get<UnstructuredTopology>(mesh.topology).types.size();
    block.bounds = bounds_;
    for (const auto& [type, association, tuples] :
         {std::tuple{kNodal, Association::kPoint, block.point_count},
          std::tuple{kElement, Association::kCell, block.cell_count}}) {
      for (int i = 0; i < reader_->GetNumberOfObjectArrays(type); ++i) {
        block.arrays.push_back({reader_->GetObjectArrayName(type, i), association,
                                reader_->GetNumberOfObjectArrayComponents(type, i), ScalarType::kFloat64,
                                tuples});
      }
    }
    if (blocks_.size() > 1) info.notes.push_back(std::to_string(blocks_.size()) + " element blocks joined");
    info.blocks.push_back(std::move(block));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    select({names.begin(), names.end()});
    std::vector<DataSet> blocks;
    blocks.push_back(load({names.begin(), names.end()}, step, nullptr));
    return blocks;
  }

 private:
  void select(const std::set<std::string>& wanted) {
    for (const int type : {kNodal, kElement}) {
      for (int i = 0; i < reader_->GetNumberOfObjectArrays(type); ++i) {
        reader_->SetObjectArrayStatus(type, i,
                                      static_cast<int>(wanted.count(reader_->GetObjectArrayName(type, i))));
      }
    }
  }

  DataSet load(const std::set<std::string>& wanted, std::size_t step, std::vector<std::string>* notes) {
    if (times_.empty()) {
      reader_->Update();
    } else {
      reader_->UpdateTimeStep(times_[step]);
    }
    errors_.check(file_);
    blocks_ = usable_blocks(leaves_of(reader_->GetOutput()), "element block", file_, notes);
    std::vector<DataSet> blocks;
    bounds_ = {};
    for (const VtkBlock& block : blocks_) {
      blocks.push_back(convert_block(block.data, block.name, wanted, file_));
      const BlockInfo about = describe_block(block.data, block.name);
      bounds_.include(about.bounds.lower);
      bounds_.include(about.bounds.upper);
    }
    return join(std::move(blocks));
  }

  VtkErrors errors_;
  vtkSmartPointer<vtkExodusIIReader> reader_;
  std::string file_;
  std::vector<double> times_;
  std::vector<VtkBlock> blocks_;
  Box bounds_;
};

}  // namespace

std::unique_ptr<Loader> make_exodus_reader() { return std::make_unique<ExodusReader>(); }

}  // namespace palpate
