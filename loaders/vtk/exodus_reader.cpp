/// Exodus II through vtkExodusIIReader: nodal and element variables of the element blocks, joined into one
/// mesh since they share their nodes.
#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <vtkCellData.h>
#include <vtkDataSet.h>
#include <vtkExodusIIReader.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "loaders/vtk/netcdf_check.h"
#include "loaders/vtk/solver_readers.h"
#include "loaders/vtk/vtk_convert.h"
#include "loaders/vtk/vtk_errors.h"

namespace palpate {
namespace {

constexpr int kNodal = vtkExodusIIReader::NODAL;
constexpr int kElement = vtkExodusIIReader::ELEM_BLOCK;

/// The array of cells `like` over all blocks. Where a block lacks it, it is NaN: only of real numbers. None
/// where blocks have it in different shapes.
std::optional<DataArray> joined_array(const std::vector<DataSet>& blocks, const DataArray& like) {
  const bool real = like.type == ScalarType::kFloat32 || like.type == ScalarType::kFloat64;
  const std::size_t size = byte_size(like.type);
  const auto bytes = std::make_shared<std::vector<std::byte>>();
  DataArray joined = like;
  joined.tuples = 0;
  for (const DataSet& block : blocks) {
    const DataArray* more = block.find(like.name, Association::kCell);
    if (more == nullptr ? !real : more->type != like.type || more->components != like.components)
      return std::nullopt;
    joined.tuples += block.cell_count();
    if (more != nullptr) {
      bytes->insert(bytes->end(), more->bytes.begin(), more->bytes.end());
      continue;
    }
    const std::size_t from = bytes->size();
    bytes->resize(from + block.cell_count() * as_size(like.components) * size);
    const float single = std::numeric_limits<float>::quiet_NaN();
    const double whole = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t at = from; at < bytes->size(); at += size)
      std::memcpy(bytes->data() + at, size == sizeof(float) ? static_cast<const void*>(&single) : &whole,
                  size);
  }
  joined.bytes = std::as_const(*bytes);
  joined.owner = bytes;
  return joined;
}

/// Joins blocks that share one list of points: cells one after another.
DataSet join(std::vector<DataSet> blocks) {
  std::vector<DataArray> arrays;
  for (const DataSet& block : blocks) {
    for (const DataArray& array : block.arrays) {
      const bool known = std::any_of(arrays.begin(), arrays.end(), [&array](const DataArray& other) {
        return other.name == array.name && other.association == array.association;
      });
      if (known) continue;
      if (array.association == Association::kPoint) {
        arrays.push_back(array);
      } else if (auto joined = joined_array(blocks, array)) {
        arrays.push_back(*std::move(joined));
      }
    }
  }
  DataSet joined = std::move(blocks.front());
  joined.arrays = std::move(arrays);
  auto& mesh = std::get<UnstructuredTopology>(joined.topology);
  for (std::size_t b = 1; b < blocks.size(); ++b) {
    const auto& other = std::get<UnstructuredTopology>(blocks[b].topology);
    const std::int64_t shift = mesh.offsets.back();
    mesh.types.insert(mesh.types.end(), other.types.begin(), other.types.end());
    for (std::size_t i = 1; i < other.offsets.size(); ++i) mesh.offsets.push_back(other.offsets[i] + shift);
    mesh.connectivity.insert(mesh.connectivity.end(), other.connectivity.begin(), other.connectivity.end());
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

    // Which blocks have a variable is known once it is read.
    std::set<std::string> of_cells;
    for (int i = 0; i < reader_->GetNumberOfObjectArrays(kElement); ++i)
      of_cells.insert(reader_->GetObjectArrayName(kElement, i));
    select(of_cells);
    const DataSet mesh = load(of_cells, 0, &info.notes);
    BlockInfo block = describe_block(blocks_.front().data, "");
    block.arrays.clear();
    block.cell_count = std::get<UnstructuredTopology>(mesh.topology).types.size();
    block.bounds = bounds_;
    for (int i = 0; i < reader_->GetNumberOfObjectArrays(kNodal); ++i) {
      block.arrays.push_back({reader_->GetObjectArrayName(kNodal, i), Association::kPoint,
                              reader_->GetNumberOfObjectArrayComponents(kNodal, i), ScalarType::kFloat64,
                              block.point_count});
    }
    for (const std::string& name : of_cells) {
      const DataArray* const array = mesh.find(name, Association::kCell);
      note_blocks_of(name, array != nullptr, info.notes);
      if (array != nullptr)
        block.arrays.push_back({name, Association::kCell, array->components, array->type, array->tuples});
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

  /// Says which element blocks have the array of cells, unless all have it.
  void note_blocks_of(const std::string& name, bool taken, std::vector<std::string>& notes) const {
    std::string with;
    std::size_t count = 0;
    for (const VtkBlock& block : blocks_) {
      if (block.data->GetCellData()->GetArray(name.c_str()) == nullptr) continue;
      with += (count++ == 0 ? "'" : ", '") + block.name + "'";
    }
    if (count == blocks_.size() && taken) return;
    std::string note = "array '" + name + "' is in ";
    note += count == 0 ? "no element block that is read" : "element block " + with;
    note += taken ? " of " + std::to_string(blocks_.size()) + " alone: bad data elsewhere" : ": left out";
    notes.push_back(note);
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
